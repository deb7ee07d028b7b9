"""Metrics of a run: the true motion compared with the belief, computed from the tables of the run.

``success`` means: no collision, no fall, no via point missed and, with a goal, the goal reached,
in a run that ended by ``goal`` or ``completed``. The criteria of a scenario are evaluated
separately, see `hsr8.recording.verdict`.
"""

from copy import copy
from dataclasses import dataclass
from math import degrees, hypot, inf, isfinite, sqrt

import numpy as np
from numpy.typing import NDArray

from hsr8.measure.registry import METRICS
from hsr8.measure.social import SPEED_WINDOW, STANDING_SPEED, social_metrics
from hsr8.measure.statistics import mean, root_mean, spl, total
from hsr8.measure.tracks import track_metrics
from hsr8.measure.walking import walk_metrics
from hsr8.recording.derived import truth_at
from hsr8.recording.run import Run
from hsr8.recording.table import Table
from hsr8.world.field.certificate import Certificate
from hsr8.world.field.generator import draw_world
from hsr8.world.field.layout import Layout
from hsr8.world.truth.truth import RECOVERY_TIME, CollisionCounter, Contact, Falls
from navigation.angles import wrap
from navigation.parameters.navigation import MissionParameters

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Truth = dict[str, Array]

ENDED = ("completed", "goal")  # exit reasons of a success without a goal
# Lengths and speeds are those in a world of scale 1.
TOLERANCE = 0.10  # added to the radii of via points and goal for the true position [m]
HEADING_TOLERANCE = 15.0  # of the true heading at the goal [deg]
MAX_MATCH_DISTANCE = 0.4  # from a track to its obstacle [m]
SACCADE = 0.17  # minimum change of the commanded gaze [rad]


def measure(
    run: Run, layout: Layout | None = None, certificate: Certificate | None = None
) -> dict[str, object]:
    """Return all results of a run by name, with units at the end of the names.

    Unmeasured results are None, for example the localization of a run without a camera frame.

    Args:
        run: run that has ended.
        layout: layout of its world, which is drawn again by default.
        certificate: certificate of its world.

    Raises:
        UsageError: a table is damaged, or the scenario cannot be read.
    """
    scenario, manifest = run.scenario(), run.manifest
    if layout is None:
        world = draw_world(scenario, run.seed)
        layout, certificate = world.layout, world.certificate
    walking = walk_metrics(copy(run))  # whose large table of ticks is freed at once
    records, frames, exit_reason = run.records, run.frames, run.exit_reason
    truth = truth_at(frames, records)
    time = float(records["time"][-1]) if len(records) else 0.0
    wall_time = float(manifest["wall_time_s"])
    undisturbed = _undisturbed(records, frames, truth)
    arrival = _arrival(frames, truth, layout, scenario.navigation.mission)
    collisions, first = _collisions(records)
    moving = sum(c.moving for c in collisions)
    path, standing = _path(records, layout.scale)
    falls, tilt = _falls(records)
    clearance = float(np.min(records["clearance"], initial=inf))
    has_goal = _has_goal(layout)
    ended = arrival.goal_reached and exit_reason == "goal" if has_goal else exit_reason in ENDED
    success = ended and not (falls or collisions or arrival.missed)
    certified = _certified(certificate, layout)
    return {
        "success": success,
        "collisions": len(collisions),
        "falls": falls,
        "via_points_total": len(layout.waypoints) - has_goal,
        "via_points_passed": arrival.passed - arrival.missed,
        "goal_reached": arrival.goal_reached,
        "arrival_error_deg": _arrival_error(records, layout, arrival),
        "time_to_goal_s": arrival.time,
        "path_length_m": path,
        **certified,
        "spl": _weighted(success, certified["certified_length_m"], path),
        "stl": _weighted(success, certified["certified_time_s"], arrival.time),
        "min_clearance_m": clearance if isfinite(clearance) else None,
        **_localization(frames, truth, undisturbed),
        "obstacle_speed_rmse_mps": _obstacle_speed(frames, truth, layout),
        "sim_time_s": time,
        "wall_time_s": wall_time,
        "real_time_factor": time / wall_time if wall_time > 0.0 else None,
        "state_hash": manifest["state_hash"],
        "exit_reason": exit_reason,
        "collisions_moving": moving,
        "collisions_static": len(collisions) - moving,
        "collisions_at_fault": sum(c.closing for c in collisions),
        "first_collision_s": first,
        "collisions_per_m": len(collisions) / path if path > 0.0 else None,
        "via_points_missed": arrival.missed,
        "max_tilt_deg": degrees(tilt),
        "time_standing_s": standing,
        **_gaze(frames, time),
        **{m.name: m.of(run) for m in METRICS.values() if m.of is not None},
        **social_metrics(records, frames, layout, scenario, collisions),
        **track_metrics(frames, truth, layout, undisturbed),
        **walking,
    }


@dataclass(slots=True)
class _Arrival:
    """Via points and goal that the robot believes reached, checked against the truth.

    Attributes:
        passed: via points passed according to the robot.
        missed: passed via points that the robot did not come near.
        time: time at which the robot believes that it is at the goal [s]; None if never.
        goal_reached: whether this is true.
    """

    passed: int = 0
    missed: int = 0
    time: float | None = None
    goal_reached: bool = False


def _has_goal(layout: Layout) -> bool:
    return len(layout.waypoints) > 0 and not layout.endless


def _arrival(frames: Table, truth: Truth, layout: Layout, mission: MissionParameters) -> _Arrival:
    arrival = _Arrival()
    points = np.reshape(layout.waypoints, (-1, 2)).tolist()
    if not points:
        return arrival
    tolerance = TOLERANCE * layout.scale
    columns = (frames["via_points"], frames["done"], frames["time"], truth["robot"])
    for via_points, done, time, (x, y, heading) in zip(
        *map(np.ndarray.tolist, columns), strict=True
    ):
        while arrival.passed < via_points:
            px, py = points[arrival.passed % len(points)]
            arrival.missed += hypot(px - x, py - y) > mission.r_via + tolerance
            arrival.passed += 1
        if done and arrival.time is None and _has_goal(layout):
            px, py = points[-1]
            wanted = heading if layout.goal_heading is None else layout.goal_heading
            arrival.time = time
            arrival.goal_reached = (
                hypot(px - x, py - y) <= mission.r_goal + tolerance
                and degrees(abs(wrap(heading - wanted))) <= HEADING_TOLERANCE
            )
    return arrival


def _certified(certificate: Certificate | None, layout: Layout) -> dict[str, float | None]:
    """Return time and length of the certified path; None unless it leads to the goal."""
    if (
        certificate is None
        or not (certificate.solvable and _has_goal(layout))
        or certificate.points < len(layout.waypoints)
    ):
        return {"certified_time_s": None, "certified_length_m": None}
    return {"certified_time_s": certificate.time, "certified_length_m": certificate.length}


def _weighted(success: bool, shortest: float | None, actual: float | None) -> float | None:
    """Return success weighted by path length or time; None without a certified path."""
    if shortest is None:
        return None
    return spl(success, shortest, shortest if actual is None else actual)


def _arrival_error(records: Table, layout: Layout, arrival: _Arrival) -> float | None:
    """Return the true heading error at the end [deg]; None if the mission was not finished."""
    if arrival.time is None or layout.goal_heading is None:
        return None
    return degrees(abs(wrap(float(records["robot"][-1, 2]) - layout.goal_heading)))


def _collisions(records: Table) -> tuple[list[Contact], float | None]:
    """Return the first contact of each collision, and the time of the first collision [s]."""
    counter, table = CollisionCounter(), records["contacts"]
    columns = (table[name].tolist() for name in Contact.__dataclass_fields__)
    contacts = [Contact(*values) for values in zip(*columns, strict=True)]
    ends, rows = np.cumsum(table.counts), np.flatnonzero(table.counts)
    for row in rows.tolist():
        touching = contacts[ends[row] - table.counts[row] : ends[row]]
        counter.add(float(records["time"][row]), tuple(touching))
    return counter.collisions, float(records["time"][rows[0]]) if len(rows) else None


def _falls(records: Table) -> tuple[int, float]:
    """Return the number of falls and the maximum tilt between them [rad]."""
    falls, time, fallen = Falls(), records["time"], records["fallen"]
    for begin in time[fallen].tolist():
        falls.add(begin, fallen=True)
    since = time - np.maximum.accumulate(np.where(fallen, time, -inf))
    upright = since >= RECOVERY_TIME
    roll, pitch = records["roll"][upright].tolist(), records["pitch"][upright].tolist()
    return falls.count, max(map(hypot, roll, pitch), default=0.0)


def _path(records: Table, scale: float) -> tuple[float, float]:
    """Return path length [m] and standing time [s], with a window that averages the sway."""
    path = standing = 0.0
    anchor: tuple[float, float, float] | None = None
    rows = zip(records["time"].tolist(), records["robot"].tolist(), strict=True)
    for time, (x, y, _) in rows:
        if anchor is not None:
            elapsed = time - anchor[0]
            if elapsed < SPEED_WINDOW - 1e-9:
                continue
            moved = hypot(x - anchor[1], y - anchor[2])
            path += moved
            standing += elapsed if moved < STANDING_SPEED * scale * elapsed else 0.0
        anchor = (time, x, y)
    return path, standing


def _undisturbed(records: Table, frames: Table, truth: Truth) -> Mask:
    """Return whether no contact has displaced the robot since its start or last relocalization.

    Dead reckoning does not measure the displacement of a foot that an obstacle pushes over the
    floor, so that the error of the pose has no known covariance. Consistency is measured in the
    other frames.
    """
    time, lost = truth["time"], frames["lost"]
    relocalized = np.zeros(len(frames), dtype=bool)
    relocalized[1:] = lost[:-1] & ~lost[1:]
    contact = _latest(records["time"][records["contacts"].counts > 0], time)
    undisturbed: Mask = (contact == -inf) | (contact < _latest(time[relocalized], time))
    return undisturbed


def _latest(events: Array, times: Array) -> Array:
    """Return the time of the latest event at or before each of `times` (n,) [s]; -inf if none."""
    latest: Array = np.append(-inf, events)[np.searchsorted(events, times, side="right")]
    return latest


def _localization(frames: Table, truth: Truth, undisturbed: Mask) -> dict[str, object]:
    """Compare believed and true poses; consistency in the undisturbed frames (n,)."""
    errors = frames["pose"] - truth["robot"]
    errors[:, 2] = [wrap(turn) for turn in errors[:, 2].tolist()]
    consistent = errors[undisturbed]
    covariance = frames["pose_covariance"][undisturbed]
    whitened = np.linalg.solve(covariance, consistent[..., None])[..., 0]
    dx, dy, turns = errors.T
    heading = root_mean([turn**2 for turn in turns.tolist()])
    return {
        "localization_rmse_m": root_mean(dx * dx + dy * dy),
        "heading_rmse_deg": None if heading is None else degrees(heading),
        "nees_mean": mean([float(e @ w) / 3.0 for e, w in zip(consistent, whitened, strict=True)]),
    }


def _obstacle_speed(frames: Table, truth: Truth, layout: Layout) -> float | None:
    """Compare the velocity of every track with that of the nearest obstacle."""
    tracks = frames["tracks"]
    if not len(tracks) or not layout.obstacles:
        return None
    rows = tracks.parents
    offset = truth["obstacle_positions"][rows] - tracks["position"][:, None]
    distance = np.hypot(offset[..., 0], offset[..., 1])
    nearest = distance.argmin(axis=1)
    matched = distance.min(axis=1) <= MAX_MATCH_DISTANCE * layout.scale
    wrong = (tracks["velocity"] - truth["obstacle_velocities"][rows, nearest])[matched]
    ends = np.bincount(rows[matched], minlength=len(frames)).cumsum()
    squares = [float(np.sum(part)) for part in np.split(wrong * wrong, ends[:-1])]
    return sqrt(total(squares) / len(wrong)) if len(wrong) else None


def _gaze(frames: Table, time: float) -> dict[str, object]:
    """Return saccades and the travel of the head, per second."""
    turned = np.hypot(*np.diff(frames["gaze"], axis=0).T)
    travel = total([hypot(*step) for step in np.diff(frames["capture_head"], axis=0).tolist()])
    return {
        "saccades_per_s": int(np.count_nonzero(turned > SACCADE)) / time if time > 0.0 else None,
        "head_travel_radps": travel / time if time > 0.0 else None,
    }
