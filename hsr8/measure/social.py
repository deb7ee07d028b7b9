"""Metrics of navigation among people: distances to the movers, times to collision, smoothness.

Names are those of HuNavSim where it has the metric (Perez-Higueras et al., RA-L 2023,
``hunav_evaluator/config/metrics.yaml``), with units at the end. The body of a walking robot sways,
so its velocity is that over one second.
"""

from math import inf, isfinite

import numpy as np
from numpy.typing import NDArray

from hsr8.measure.statistics import mean
from hsr8.recording.table import Table
from hsr8.scenario.schema import Scenario
from hsr8.world.field.layout import Layout
from hsr8.world.truth.truth import Contact

Array = NDArray[np.float64]

PERSON_HEIGHT = 1.7  # of the person that the spaces are those of [m]
# Outer radii of the spaces of a person: Hall, "The Hidden Dimension", 1966, as in HuNavSim [m].
SPACES = {"intimate": 0.45, "personal": 1.2, "social": 3.6}
COMPLIANCE = 0.5  # distance that space compliance requires: iGibson Social Navigation, 2021 [m]
SPEED_WINDOW = 1.0  # interval of velocities, longer than a footstep [s]
STANDING_SPEED = 0.02  # maximum speed of a standing robot in a world of scale 1 [m/s]


def social_metrics(
    records: Table, frames: Table, layout: Layout, scenario: Scenario, collisions: list[Contact]
) -> dict[str, object]:
    """Return the results by name; None without movers, motion or a mission.

    Args:
        records: table of records.
        frames: camera frames, which have the number of passed via points.
        layout: layout of the run's world.
        scenario: radius of the robot, and scale of the spaces.
        collisions: first contact of each collision.
    """
    return {
        **_distances(records, layout, scenario),
        "min_time_to_collision_s": _min_time_to_collision(records, layout, scenario.robot.radius),
        "robot_on_person_collision": sum(c.moving and c.closing for c in collisions),
        "person_on_robot_collision": sum(c.moving and not c.closing for c in collisions),
        **_smoothness(records, frames, layout),
    }


def _distances(records: Table, layout: Layout, scenario: Scenario) -> dict[str, object]:
    """Return the distances to the nearest mover, and the fractions of the time in its spaces."""
    names = [f"{space}_space_intrusions" for space in SPACES]
    keys = ("minimum_distance_to_people_m", "avg_distance_to_closest_person_m")
    if not (len(records) and layout.movers):
        return dict.fromkeys([*keys, *names, "space_compliance"])
    gaps = _distance(_offsets(records, layout)) - scenario.robot.radius
    surfaces = gaps - np.array([mover.radius for mover in layout.movers])
    factor = scenario.recorder.space_scale
    heights = np.array([mover.height / PERSON_HEIGHT for mover in layout.movers])
    nearest = np.min(gaps / (heights if factor is None else factor), axis=1)
    bounds = (-inf, *SPACES.values())
    inside = [
        float(np.mean((low <= nearest) & (nearest < high)))
        for low, high in zip(bounds, SPACES.values(), strict=False)
    ]
    return {
        keys[0]: float(gaps.min()),
        keys[1]: float(np.mean(surfaces.min(axis=1))),
        **dict(zip(names, inside, strict=True)),
        "space_compliance": float(np.mean(nearest >= COMPLIANCE)),
    }


def _min_time_to_collision(records: Table, layout: Layout, radius: float) -> float | None:
    """Return the minimum time until discs at constant velocity touch [s]; None if none would."""
    if not (len(records) and layout.movers):
        return None
    time, own = records["time"], records["robot"][:, :2]
    begin, end = records.at(time - 0.5 * SPEED_WINDOW), records.at(time + 0.5 * SPEED_WINDOW)
    elapsed = np.maximum(time[end] - time[begin], 1e-9)[:, None]
    own_velocity = (own[end] - own[begin]) / elapsed
    first = len(layout.static)
    offsets = _offsets(records, layout)
    velocities = records["obstacle_velocities"][:, first:] - own_velocity[:, None]
    reach = radius + np.array([mover.radius for mover in layout.movers])
    # |offset + velocity t| = reach, the earlier root
    a, b = np.sum(velocities**2, axis=2), np.sum(offsets * velocities, axis=2)
    c = np.sum(offsets**2, axis=2) - reach**2
    root = np.sqrt(np.maximum(b * b - a * c, 0.0))
    meets = (b < 0.0) & (b * b >= a * c)
    times = np.where(meets, c / np.where(meets, root - b, 1.0), inf)
    shortest = float(np.min(np.where(c <= 0.0, 0.0, times)))
    return shortest if isfinite(shortest) else None


def _smoothness(records: Table, frames: Table, layout: Layout) -> dict[str, object]:
    """Return turns, deviation from the direction of the target, and jerk, once per second."""
    time = records["time"]
    span = float(time[-1] - time[0]) if len(time) else 0.0
    moments = (time[0] if len(time) else 0.0) + np.arange(0.0, span + 1e-9, SPEED_WINDOW)
    if len(moments) < 2:
        return dict.fromkeys(
            ("cumulative_heading_changes_rad", "path_irregularity_rad", "avg_overacceleration_mps3")
        )
    pose = records["robot"][records.at(moments)]
    steps, turns = np.diff(pose[:, :2], axis=0), _wrapped(np.diff(pose[:, 2]))
    jerk = np.diff(steps, n=2, axis=0) / SPEED_WINDOW**3
    irregularity = None
    if len(layout.waypoints) and len(frames):
        passed = frames["via_points"][frames.at(moments[:-1])]
        last = len(layout.waypoints)
        index = passed % last if layout.endless else np.minimum(passed, last - 1)
        wanted = layout.waypoints[index] - pose[:-1, :2]
        moves = _distance(steps) > STANDING_SPEED * layout.scale * SPEED_WINDOW
        angles = _wrapped(_direction(steps) - _direction(wanted))[moves]
        irregularity = mean(np.abs(angles).tolist())
    return {
        "cumulative_heading_changes_rad": float(np.sum(np.abs(turns))),
        "path_irregularity_rad": irregularity,
        "avg_overacceleration_mps3": mean(_distance(jerk).tolist()),
    }


def _offsets(records: Table, layout: Layout) -> Array:
    """Return the positions of the movers relative to the robot (n, m, 2) [m]."""
    movers = records["obstacle_positions"][:, len(layout.static) :]
    offsets: Array = movers - records["robot"][:, None, :2]
    return offsets


def _distance(vectors: Array) -> Array:
    distance: Array = np.hypot(vectors[..., 0], vectors[..., 1])
    return distance


def _direction(vectors: Array) -> Array:
    direction: Array = np.arctan2(vectors[..., 1], vectors[..., 0])
    return direction


def _wrapped(angles: Array) -> Array:
    wrapped: Array = np.angle(np.exp(1j * angles))
    return wrapped
