"""Metrics of a run: a listener that compares the true motion with the belief.

``success`` means: no collision, no fall, every via point passed and, with a goal, the goal reached,
in a run that ended by ``goal`` or ``completed``. The criteria of a scenario are evaluated
separately, see `hsr8.evaluation.verdict`.
"""

import time as clock
from collections.abc import Sequence
from math import degrees, hypot, inf, isfinite, sqrt

import numpy as np
from numpy.typing import NDArray

from hsr8.evaluation.track_metrics import TrackMetrics
from hsr8.evaluation.walk_metrics import WalkMetrics
from hsr8.frame_record import FrameRecord
from hsr8.record import Listener, TickRecord
from hsr8.recorder.record_buffer import RecordBuffer
from hsr8.world.field.layout import Layout
from hsr8.world.truth.collision_counter import CollisionCounter
from hsr8.world.truth.falls import Falls
from hsr8.world.truth.truth import Truth
from navigation.angles import wrap

Array = NDArray[np.float64]
Sample = tuple[FrameRecord, Truth]  # a camera frame with the truth of that time

# Lengths and speeds are those in a world of scale 1.
TOLERANCE = 0.10  # added to the radii of via points and goal for the true position [m]
HEADING_TOLERANCE = 15.0  # of the true heading at the goal [deg]
MAX_MATCH_DISTANCE = 0.4  # from a track to its obstacle [m]
SACCADE = 0.17  # minimum change of the commanded gaze [rad]
STANDING_SPEED = 0.02  # maximum speed of a standing robot [m/s]
SPEED_WINDOW = 1.0  # interval over which speed is measured, longer than a step [s]


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
        self._finish_time: float | None = None
        self._goal_near = False
        self._goal_turned = False
        self._last: Truth | None = None
        self._tilt = 0.0
        self._path = 0.0
        self._standing = 0.0
        self._anchor: tuple[float, float, float] | None = None
        self._clearance = inf
        self._falls = Falls()
        self._frames = 0
        self._position_squares = 0.0
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
        self._tracks = TrackMetrics(layout.obstacles, layout.scale)

    def on_record(self, record: TickRecord) -> None:
        """Take one record."""
        if self._buffer.add(record):
            self._evaluate_buffer()

    def close(self, exit_reason: str) -> None:
        """Stop the clock."""
        self._wall = clock.perf_counter() - self._started

    def result(self, exit_reason: str, state_hash: str) -> dict[str, object]:
        """Return all results by name, with units at the end of the names.

        Unmeasured results are None, for example the localization of a run without a camera frame.
        """
        self._evaluate_buffer()
        time = self._last.time if self._last is not None else 0.0
        wall = self._wall if self._wall is not None else clock.perf_counter() - self._started
        collisions = self._collisions.collisions
        moving = sum(c.moving for c in collisions)
        error = self._arrival_error()
        goal_reached = self._finish_time is not None and self._goal_near and self._goal_turned
        n = self._frames
        return {
            "success": self._success(exit_reason, goal_reached),
            "collisions": len(collisions),
            "falls": self._falls.count,
            "via_points_total": self._via_total(),
            "via_points_passed": self._via - self._via_missed,
            "goal_reached": goal_reached,
            "arrival_error_deg": error,
            "time_to_goal_s": self._finish_time,
            "path_length_m": self._path,
            "min_clearance_m": self._clearance if isfinite(self._clearance) else None,
            "localization_rmse_m": sqrt(self._position_squares / n) if n else None,
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
            "time_standing_s": self._standing,
            "saccades_per_s": self._saccades / time if time > 0.0 else None,
            "head_travel_radps": self._head_travel / time if time > 0.0 else None,
            "lost_fraction": self._lost / n if n else None,
            "filter_faults": self._faults,
            "camera_frames": n,
            **self._tracks.result(),
            **self._walk.result(),
        }

    def _evaluate_buffer(self) -> None:
        records = self._buffer.take()
        for record in records:
            self._add(record)
        samples = [(record.frame, record.truth) for record in records if record.frame is not None]
        if samples:
            self._add_poses(samples)
            self._add_speeds(samples)
        for frame, truth in samples:
            self._add_frame(frame, truth)

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
        """Return the number of via points of the mission, or of one round of a tour."""
        return len(self._points) - (1 if self._has_goal else 0)

    def _success(self, exit_reason: str, goal_reached: bool) -> bool:
        if self._falls.count or self._collisions.collisions or self._via_missed:
            return False
        if self._has_goal:
            return goal_reached and exit_reason == "goal"
        return exit_reason in ("completed", "goal")

    def _arrival_error(self) -> float | None:
        """Return the true heading error at the end [deg]; None if the mission was not finished."""
        if self._finish_time is None or self._layout.goal_heading is None or self._last is None:
            return None
        return degrees(abs(wrap(float(self._last.robot[2]) - self._layout.goal_heading)))

    def _move(self, truth: Truth) -> None:
        """Update path length and standing time, with a window that averages the sway."""
        x, y, _ = truth.robot.tolist()
        if self._anchor is None:
            self._anchor = (truth.time, x, y)
            return
        then, x0, y0 = self._anchor
        if truth.time - then < SPEED_WINDOW - 1e-9:
            return
        moved = hypot(x - x0, y - y0)
        self._path += moved
        if moved < STANDING_SPEED * self._layout.scale * (truth.time - then):
            self._standing += truth.time - then
        self._anchor = (truth.time, x, y)

    def _add_poses(self, samples: Sequence[Sample]) -> None:
        """Compare believed and true poses."""
        errors = np.array([frame.belief.pose - truth.robot for frame, truth in samples])
        errors[:, 2] = [wrap(turn) for turn in errors[:, 2].tolist()]
        covariances = np.array([frame.belief.pose_covariance for frame, _ in samples])
        whitened = np.linalg.solve(covariances, errors[..., None])[..., 0]
        for error, white in zip(errors, whitened, strict=True):
            dx, dy, turn = error.tolist()
            self._position_squares += dx * dx + dy * dy
            self._heading_squares += turn**2
            self._nees += float(error @ white) / 3.0

    def _add_frame(self, frame: FrameRecord, truth: Truth) -> None:
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

    def _add_speeds(self, samples: Sequence[Sample]) -> None:
        """Compare the velocity of every track with that of the nearest obstacle."""
        tracks = [track for frame, _ in samples for track in frame.belief.tracks]
        if not tracks or not self._layout.obstacles:
            return
        counts = [len(frame.belief.tracks) for frame, _ in samples]
        rows = np.repeat(np.arange(len(samples)), counts)
        obstacles = np.array([truth.obstacle_positions for _, truth in samples])
        offset = obstacles[rows] - np.array([track.position for track in tracks])[:, None]
        distance = np.hypot(offset[..., 0], offset[..., 1])
        nearest = distance.argmin(axis=1)
        matched = distance.min(axis=1) <= MAX_MATCH_DISTANCE * self._layout.scale
        true = np.array([truth.obstacle_velocities for _, truth in samples])[rows, nearest]
        wrong = (np.array([track.velocity for track in tracks]) - true)[matched]
        ends = np.bincount(rows[matched], minlength=len(samples)).cumsum()
        for squares in np.split(wrong * wrong, ends[:-1]):
            self._speed_squares += float(np.sum(squares))
        self._speeds += len(wrong)

    def _follow_mission(self, frame: FrameRecord, truth: Truth) -> None:
        """Check the points that the mission believes passed or reached against the truth."""
        task = frame.task
        x, y, heading = truth.robot.tolist()
        while self._via < task.index and len(self._points):
            px, py = self._points[self._via % len(self._points)].tolist()
            if hypot(px - x, py - y) > self._r_via + TOLERANCE * self._layout.scale:
                self._via_missed += 1
            self._via += 1
        if self._has_goal and task.done and self._finish_time is None:
            self._finish_time = frame.time
            px, py = self._points[-1].tolist()
            self._goal_near = hypot(px - x, py - y) <= self._r_goal + TOLERANCE * self._layout.scale
            wanted = self._layout.goal_heading
            error = 0.0 if wanted is None else degrees(abs(wrap(heading - wanted)))
            self._goal_turned = error <= HEADING_TOLERANCE
