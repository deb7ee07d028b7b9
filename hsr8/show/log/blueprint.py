"""Arrangement of a log in the viewer."""

from dataclasses import dataclass

import rerun as rr
import rerun.blueprint as rrb

from hsr8.recording import palette
from hsr8.show.log.stream import TIMELINE

AROUND = rrb.VisibleTimeRange(
    TIMELINE,
    start=rrb.TimeRangeBoundary.cursor_relative(seconds=-2.5),
    end=rrb.TimeRangeBoundary.cursor_relative(seconds=1.5),
)
BACKGROUND = [228, 231, 235]
TRUTH = (  # drawn in outlines below the belief
    "/world/obstacles/boxes",
    "/world/obstacles/capsules",
    "/world/obstacles/cylinders",
    "/world/movers",
)
OUTLINES = rr.Cylinders3D.from_fields(
    fill_mode=rr.components.FillMode.MajorWireframe, colors=[palette.TRUTH], line_radii=[0.006]
)
STATES = "States; gait: blue left foot, orange right foot, sand both"
ABOVE = 6.2  # height of the viewpoint over a field of 5 m [m]


@dataclass(frozen=True, slots=True)
class RobotView:
    """Robot in the views.

    Attributes:
        name: name of the robot.
        entity: entity that views follow.
        size: height relative to that of HSR-VIII [1].
    """

    name: str = "HSR-VIII"
    entity: str = "/world/robot/ellipsoids"
    size: float = 1.0


DEFAULT = RobotView()


def blueprint(field_size: float, *, walking: bool, robot: RobotView = DEFAULT) -> rrb.Blueprint:
    """Return two tabs: the whole robot, and its walking in detail.

    Args:
        field_size: longer side of the field [m].
        walking: show walking first.
        robot: robot in the views.
    """
    return rrb.Blueprint(
        rrb.Tabs(_overview(field_size, robot), _walking(robot), active_tab=1 if walking else 0),
        rrb.TimePanel(timeline=TIMELINE, state="collapsed"),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
    )


def _walking(view: RobotView) -> rrb.Container:
    """Return the robot over its footsteps on the left, curves on the right."""
    scale = view.size
    robot = rrb.Spatial3DView(
        name="Walking",
        origin="/",
        contents=["+ /world/**", "- /world/camera/**", "- /world/path"],
        background=BACKGROUND,
        line_grid=False,
        eye_controls=rrb.EyeControls3D(
            position=(-0.5 * scale, -0.6 * scale, 0.42 * scale),
            look_target=(0.0, 0.0, 0.14 * scale),
            eye_up=(0.0, 0.0, 1.0),
            tracking_entity=view.entity,
        ),
    )
    texts = rrb.Tabs(
        rrb.TextLogView(name="Limited commands", origin="/command_limits"),
        rrb.TextLogView(name="Events", origin="/events"),
    )
    zmp = [
        rrb.TimeSeriesView(
            name=f"ZMP, CoM, DCM and the edges of the soles: {axis} [m]",
            origin=f"/plots/zmp_{axis}",
            time_ranges=AROUND,
        )
        for axis in ("left", "forward")
    ]
    details = rrb.Tabs(
        *(
            rrb.TimeSeriesView(name=name, origin=f"/plots/{entity}", time_ranges=ranges)
            for name, entity, ranges in (
                ("vx", "speed_vx", None),
                ("vy", "speed_vy", None),
                ("wz", "speed_wz", None),
                ("Knee", "torque_knee", AROUND),
                ("Hip", "torque_hip", AROUND),
                ("Ankle", "torque_ankle", AROUND),
                ("Tilt", "tilt", None),
            )
        ),
        active_tab=0,
    )
    lanes = ["+ /state/gait", "+ /state/planner"]
    states = rrb.StateTimelineView(name=STATES, origin="/state", contents=lanes)
    curves = rrb.Vertical(*zmp, details, states, row_shares=[3, 3, 2.5, 2])
    left = rrb.Vertical(robot, texts, row_shares=[4, 1])
    return rrb.Horizontal(left, curves, column_shares=[1, 1], name="Walking")


def _overview(field_size: float, view: RobotView) -> rrb.Container:
    """Return robot and belief above, camera, gaze, states and curves below."""
    height, scale = ABOVE * field_size / 5.0, view.size
    robot = rrb.Spatial3DView(
        name=view.name,
        origin="/",
        contents=[
            "+ /world/**",
            "+ /belief/**",
            "+ /plan/**",
            "- /belief/local_map",
            # The image is in another view; here it would hide the robot.
            "- /world/camera/image",
            "- /world/camera/detections",
            "- /world/camera/gaze_window",
        ],
        background=BACKGROUND,
        line_grid=False,
        eye_controls=rrb.EyeControls3D(
            position=(-1.05 * scale, -0.75 * scale, 0.75 * scale),
            look_target=(0.05 * scale, 0.0, 0.2 * scale),
            eye_up=(0.0, 0.0, 1.0),
            tracking_entity=view.entity,
        ),
    )
    belief = rrb.Spatial3DView(
        name="Belief over truth; white: ground seen lately",
        origin="/",
        contents=[
            "+ /belief/**",
            "+ /plan/**",
            "+ /world/floor",
            "+ /world/rim/**",
            "+ /world/obstacles/**",
            "+ /world/movers/**",
            "+ /world/beacons/**",
            "+ /world/via_points/**",
            "+ /world/path",
        ],
        overrides=dict.fromkeys(TRUTH, OUTLINES),
        background=BACKGROUND,
        line_grid=False,
        eye_controls=rrb.EyeControls3D(
            position=(0.0, -0.01, height), look_target=(0.0, 0.0, 0.0), eye_up=(0.0, 1.0, 0.0)
        ),
    )
    camera = rrb.Spatial2DView(name="Head camera; yellow: chosen view", origin="/world/camera")
    gaze = rrb.Spatial2DView(name="Value of gazes; dot: chosen", origin="/gaze")
    states = rrb.StateTimelineView(name=STATES, origin="/state")
    curves = rrb.Tabs(
        *(
            rrb.TimeSeriesView(name=name, origin=f"/plots/{entity}")
            for name, entity in (
                ("Evaluations", "partial"),
                ("Pose error", "pose_error"),
                ("ZMP", "zmp_left"),
                ("Speed", "speed_vx"),
                ("Tilt", "tilt"),
                ("Clearance", "clearance"),
            )
        ),
        rrb.TextLogView(name="Events", origin="/events"),
        active_tab=0,
    )
    name = "Robot and belief"
    above = rrb.Horizontal(robot, belief, column_shares=[1.15, 1])
    sight = rrb.Vertical(states, curves, row_shares=[1.1, 1])
    below = rrb.Horizontal(camera, gaze, sight, column_shares=[1, 1.1, 2])
    return rrb.Vertical(above, below, row_shares=[1, 1], name=name)
