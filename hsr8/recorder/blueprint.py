"""How the viewer arranges a log."""

import rerun.blueprint as rrb

from hsr8.recorder.channel import TIMELINE

ABOVE = 7.0  # height of the eye over a field of 5 m [m]


def blueprint(field_size: float) -> rrb.Blueprint:
    """Robot, camera and gaze on the left; belief, states and curves on the right.

    Args:
        field_size: longer side of the field [m].
    """
    height = ABOVE * field_size / 5.0
    robot = rrb.Spatial3DView(
        name="HSR-VIII",
        origin="/",
        contents=["+ /world/**", "+ /belief/**", "- /belief/local_map"],
        background=[228, 231, 235],
        line_grid=False,
        eye_controls=rrb.EyeControls3D(
            position=(-1.3, -1.0, 0.9),
            look_target=(0.0, 0.0, 0.25),
            eye_up=(0.0, 0.0, 1.0),
            tracking_entity="/world/robot/ellipsoids",
        ),
    )
    belief = rrb.Spatial3DView(
        name="Belief over truth",
        origin="/",
        contents=[
            "+ /belief/**",
            "+ /world/floor",
            "+ /world/rim/**",
            "+ /world/obstacles/**",
            "+ /world/movers/**",
            "+ /world/beacons/**",
            "+ /world/way_points",
            "+ /world/path",
        ],
        background=[228, 231, 235],
        line_grid=False,
        eye_controls=rrb.EyeControls3D(
            position=(0.0, -0.01, height), look_target=(0.0, 0.0, 0.0), eye_up=(0.0, 1.0, 0.0)
        ),
    )
    camera = rrb.Spatial2DView(name="Head camera", origin="/world/camera")
    gaze = rrb.Spatial2DView(name="Gaze map GM", origin="/gaze")
    states = rrb.StateTimelineView(name="States", origin="/state")
    curves = rrb.Tabs(
        *(
            rrb.TimeSeriesView(name=name, origin=f"/plots/{entity}")
            for name, entity in (
                ("Partial evaluations", "partial"),
                ("Pose error", "pose_error"),
                ("ZMP left [m]", "zmp_left"),
                ("ZMP forward [m]", "zmp_forward"),
                ("Speed", "speed"),
                ("Tilt", "tilt"),
                ("Clearance", "clearance"),
            )
        ),
        active_tab=0,
    )
    events = rrb.TextLogView(name="Events", origin="/events")
    left = rrb.Vertical(robot, rrb.Horizontal(camera, gaze), row_shares=[3, 2])
    right = rrb.Vertical(belief, states, curves, events, row_shares=[5, 2.3, 2.5, 1.5])
    return rrb.Blueprint(
        rrb.Horizontal(left, right, column_shares=[1, 1]),
        rrb.TimePanel(timeline=TIMELINE, state="collapsed"),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
    )
