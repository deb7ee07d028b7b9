"""Results of a run: a listener that compares what happened with what was believed."""

import time as clock
from collections.abc import Sequence
from math import degrees, hypot, inf, isfinite, sqrt

import numpy as np
from numpy.typing import NDArray

from hsr8.evaluation.track_metrics import TrackMetrics
from hsr8.evaluation.walk_metrics import WalkMetrics
from hsr8.recorder.frame_record import FrameRecord
from hsr8.recorder.record import Listener, TickRecord
from hsr8.recorder.record_buffer import RecordBuffer
from hsr8.world.field.layout import Layout
from hsr8.world.truth.collision_counter import CollisionCounter
from hsr8.world.truth.falls import Falls
from hsr8.world.truth.truth import Truth
from navigation.angles import wrap

Array = NDArray[np.float64]
Seen = tuple[FrameRecord, Truth]  # a camera frame, and what was true then

TOLERANCE = 0.10  # the true position may be so much farther from a point than the believed [m]
HEADING_TOLERANCE = 15.0  # of the true heading at the goal [deg]
MATCHED = 0.4  # a track farther from every true obstacle is of none [m]
SACCADE = 0.17  # a change of the wanted gaze as large as this is a saccade [rad]
STILL = 0.02  # the robot stands below this speed [m/s]
STILL_WINDOW = 1.0  # its speed is measured over this time, longer than a step [s]


class Metrics(Listener):
    """Listener that computes the results of a run.

    Args:
        layout: of the run's world.
        r_via: distance at which a via point counts as passed [m].
        r_goal: distance at which the goal counts as reached [m].
    """

    def __init__(self, layout: Layout, r_via: float, r_goal: float) -> None:
        self._layout = layout
        self._points = np.asarray(layout.waypoints, float).reshape(-1, 2)
        self._has_goal = len(self._points) > 0 and not layout.endless
        self._r_via = r_via
        self._r_goal = r_goal
        self._started = clock.perf_counter()
        self._wall: float | None = None
        self._buffer = RecordBuffer()
        self._collisions = CollisionCounter()
        self._via = 0
        self._via_missed = 0
        self._done_at: float | None = None
        self._goal_near = False
        self._goal_turned = False
        self._last: Truth | None = None
        self._tilt = 0.0
        self._path = 0.0
        self._paused = 0.0
        self._anchor: tuple[float, float, float] | None = None
        self._clearance = inf
        self._falls = Falls()
        self._frames = 0
        self._place_squares = 0.0
        self._heading_squares = 0.0
        self._nees = 0.0
        self._speed_squares = 0.0
        self._speeds = 0
        self._lost = 0
        self._faults = 0
        self._gaze: tuple[float, float] | None = None
        self._saccades = 0
        self._head: tuple[float, float] | None = None
        self._head_travel = 0.0
        self._walk = WalkMetrics()
        self._tracks = TrackMetrics(layout.obstacles)

    def on_record(self, record: TickRecord) -> None:
        """Take one record."""
        if self._buffer.add(record):
            self._count_pending()

    def close(self, exit_reason: str) -> None:
        """Stop the clock."""
        self._wall = clock.perf_counter() - self._started

    def result(self, exit_reason: str, state_hash: str) -> dict[str, object]:
        """All results by name, in the units their names end with.

        What was not measured, for example the localization of a robot without a camera
        frame, is None.
        """
        self._count_pending()
        time = self._last.time if self._last is not None else 0.0
        wall = self._wall if self._wall is not None else clock.perf_counter() - self._started
        collisions = self._collisions.collisions
        moving = sum(c.moving for c in collisions)
        error = self._arrival_error()
        goal_reached = self._done_at is not None and self._goal_near and self._goal_turned
        n = self._frames
        return {
            "success": self._success(exit_reason, goal_reached),
            "collisions": len(collisions),
            "falls": self._falls.count,
            "via_points_total": self._via_total(),
            "via_points_passed": self._via - self._via_missed,
            "goal_reached": goal_reached,
            "arrival_error_deg": error,
            "time_to_goal_s": self._done_at,
            "path_length_m": self._path,
            "min_clearance_m": _measured(self._clearance),
            "localization_rmse_m": sqrt(self._place_squares / n) if n else None,
            "heading_rmse_deg": degrees(sqrt(self._heading_squares / n)) if n else None,
            "nees_mean": self._nees / n if n else None,
            "obstacle_speed_rmse_mps": (
                sqrt(self._speed_squares / self._speeds) if self._speeds else None
            ),
            "sim_time_s": time,
            "wall_time_s": wall,
            "real_time_factor": time / wall if wall > 0.0 else None,
            "state_hash": state_hash,
            "exit_reason": exit_reason,
            "collisions_moving": moving,
            "collisions_static": len(collisions) - moving,
            "collisions_at_fault": sum(c.closing for c in collisions),
            "collisions_per_m": len(collisions) / self._path if self._path > 0.0 else None,
            "via_points_missed": self._via_missed,
            "max_tilt_deg": degrees(self._tilt),
            "time_standing_s": self._paused,
            "saccades_per_s": self._saccades / time if time > 0.0 else None,
            "head_travel_radps": self._head_travel / time if time > 0.0 else None,
            "lost_fraction": self._lost / n if n else None,
            "filter_faults": self._faults,
            "camera_frames": n,
            **self._tracks.result(),
            **self._walk.result(),
        }

    def _count_pending(self) -> None:
        """Count the records that wait."""
        records = self._buffer.take()
        for record in records:
            self._add(record)
        seen = [(record.frame, record.truth) for record in records if record.frame is not None]
        if seen:
            self._locate(seen)
            self._match(seen)
        for frame, truth in seen:
            self._look(frame, truth)

    def _add(self, record: TickRecord) -> None:
        truth = record.truth
        self._move(truth)
        self._walk.add(record)
        self._collisions.add(truth.time, truth.contacts)
        self._clearance = min(self._clearance, truth.clearance)
        self._falls.add(truth.time, fallen=truth.fallen)
        if not self._falls.lasting(truth.time):
            self._tilt = max(self._tilt, hypot(record.walking.roll, record.walking.pitch))
        self._last = truth

    def _via_total(self) -> int:
        """Via points of the mission; of a tour, those of one round."""
        return len(self._points) - (1 if self._has_goal else 0)

    def _success(self, exit_reason: str, goal_reached: bool) -> bool:
        if self._falls.count or self._collisions.collisions or self._via_missed:
            return False
        if self._has_goal:
            return goal_reached and exit_reason == "goal"
        return exit_reason in ("completed", "goal")

    def _arrival_error(self) -> float | None:
        """Error of the true heading at the end of the run [deg].

        None if the mission was not finished.
        """
        if self._done_at is None or self._layout.goal_heading is None or self._last is None:
            return None
        return degrees(abs(wrap(float(self._last.robot[2]) - self._layout.goal_heading)))

    def _move(self, truth: Truth) -> None:
        """Path length and pauses, measured over more than a step so that sway is no way."""
        x, y, _ = truth.robot.tolist()
        if self._anchor is None:
            self._anchor = (truth.time, x, y)
            return
        then, x0, y0 = self._anchor
        if truth.time - then < STILL_WINDOW - 1e-9:
            return
        moved = hypot(x - x0, y - y0)
        self._path += moved
        if moved < STILL * (truth.time - then):
            self._paused += truth.time - then
        self._anchor = (truth.time, x, y)

    def _locate(self, seen: Sequence[Seen]) -> None:
        """Compare the believed poses with the true ones."""
        errors = np.array([frame.belief.pose - truth.robot for frame, truth in seen])
        errors[:, 2] = [wrap(turn) for turn in errors[:, 2].tolist()]
        covariances = np.array([frame.belief.pose_covariance for frame, _ in seen])
        whitened = np.linalg.solve(covariances, errors[..., None])[..., 0]
        for error, white in zip(errors, whitened, strict=True):
            dx, dy, turn = error.tolist()
            self._place_squares += dx * dx + dy * dy
            self._heading_squares += turn**2
            self._nees += float(error @ white) / 3.0

    def _look(self, frame: FrameRecord, truth: Truth) -> None:
        belief = frame.belief
        self._frames += 1
        self._lost += belief.lost
        self._faults = belief.filter_faults
        self._tracks.add(frame, truth)
        gaze = (frame.gaze.pan, frame.gaze.tilt)
        if self._gaze is not None:
            pan, tilt = self._gaze
            self._saccades += hypot(gaze[0] - pan, gaze[1] - tilt) > SACCADE
        self._gaze = gaze
        head = (frame.measured.view.pan, frame.measured.view.tilt)
        if self._head is not None:
            self._head_travel += hypot(head[0] - self._head[0], head[1] - self._head[1])
        self._head = head
        self._follow_mission(frame, truth)

    def _match(self, seen: Sequence[Seen]) -> None:
        """Compare the velocity of every track with that of the obstacle next to it."""
        tracks = [track for frame, _ in seen for track in frame.belief.tracks]
        if not tracks or not self._layout.obstacles:
            return
        moments = np.repeat(np.arange(len(seen)), [len(frame.belief.tracks) for frame, _ in seen])
        obstacles = np.array([truth.obstacle_positions for _, truth in seen])
        away = obstacles[moments] - np.array([track.position for track in tracks])[:, None]
        distance = np.hypot(away[..., 0], away[..., 1])
        nearest = distance.argmin(axis=1)
        found = distance.min(axis=1) <= MATCHED
        true = np.array([truth.obstacle_velocities for _, truth in seen])[moments, nearest]
        wrong = (np.array([track.velocity for track in tracks]) - true)[found]
        ends = np.bincount(moments[found], minlength=len(seen)).cumsum()
        for squares in np.split(wrong * wrong, ends[:-1]):
            self._speed_squares += float(np.sum(squares))
        self._speeds += len(wrong)

    def _follow_mission(self, frame: FrameRecord, truth: Truth) -> None:
        """Check what the mission believes it has passed or reached against the truth."""
        task = frame.task
        x, y, heading = truth.robot.tolist()
        while self._via < task.index and len(self._points):
            px, py = self._points[self._via % len(self._points)].tolist()
            if hypot(px - x, py - y) > self._r_via + TOLERANCE:
                self._via_missed += 1
            self._via += 1
        if self._has_goal and task.done and self._done_at is None:
            self._done_at = frame.time
            px, py = self._points[-1].tolist()
            self._goal_near = hypot(px - x, py - y) <= self._r_goal + TOLERANCE
            wanted = self._layout.goal_heading
            error = 0.0 if wanted is None else degrees(abs(wrap(heading - wanted)))
            self._goal_turned = error <= HEADING_TOLERANCE


def _measured(value: float) -> float | None:
    return value if isfinite(value) else None
