"""Checks of recorded tracks: times, speeds, appearance in the field, and overlaps."""

from collections.abc import Iterator
from math import inf, isfinite

import numpy as np
from numpy.typing import NDArray

from hsr8.mistakes import Mistake
from hsr8.scenario.path import Paths
from hsr8.scenario.schema import Scenario
from hsr8.scenario.section import Point
from hsr8.scenario.track import Recording, Track, recordings
from hsr8.scenario.world import TrackMover

Array = NDArray[np.float64]

MAX_MOVERS = 128  # of a recording
MAX_SPEED_RATIO = 3.0  # relative to robot.speed.vx, as `world.speed_ratio` allows
STEP = 0.05  # between checks of overlaps, in a world with the time scale 1 [s]
CHUNK = 2000  # of these checks, evaluated together


def track_problems(scenario: Scenario) -> Iterator[Mistake]:
    """Yield the mistakes of every recording, one of each kind."""
    crowds: list[tuple[_Crowd, tuple[Track, ...]]] = []
    for i, recording in recordings(scenario):
        crowd = _Crowd(scenario, i, recording)
        problems = [*crowd.start_problems()]
        if not problems:
            tracks = recording.tracks()
            problems = [*crowd.count_problems(tracks)] or [*crowd.problems(tracks)]
            crowds.append((crowd, tracks))
        yield from problems
        if problems:
            return
    yield from _meetings(scenario, crowds)


class _Crowd:
    """Recording at an index of `world.mover`, for its messages."""

    def __init__(self, scenario: Scenario, index: int, recording: Recording) -> None:
        mover = scenario.world.mover[index]
        assert isinstance(mover, TrackMover)
        self.mover, self.recording = mover, recording
        self._scenario, self._index = scenario, index

    def problem(self, key: str, text: str) -> Mistake:
        """Return a problem with the name of the file."""
        return Mistake(("world", "mover", self._index, key), f"{self.mover.file}, {text}")

    def sample(self, track: Track, moment: float) -> str:
        """Return id and time in the file of a time of the recording [s]."""
        return f"id {track.id}, t = {moment / self.recording.time_scale:.3f} s"

    def start_problems(self) -> Iterator[Mistake]:
        """Yield a start that is not in the recording."""
        recording = self.recording
        low = recording.first
        for key in ("start", "latest_start"):
            time = getattr(recording, key)
            if not low <= time < recording.last:
                yield self.problem(
                    key,
                    f"{key} is outside the recording, got {time:g} s; "
                    f"expected {low:g} s to less than {recording.last:g} s",
                )
                return
            low = time

    def count_problems(self, tracks: tuple[Track, ...]) -> Iterator[Mistake]:
        """Yield too many movers, or none."""
        if not tracks:
            (x, y), (to_x, to_y) = (corner.tolist() for corner in self.recording.extent())
            width, depth = self._scenario.world.size
            yield self.problem(
                "file",
                f"no track enters the field of {width:g} m x {depth:g} m during the run, got "
                f"positions from [{x:.4g}, {y:.4g}] to [{to_x:.4g}, {to_y:.4g}] in W; expected "
                "another scale, offset or start",
            )
        if len(tracks) > MAX_MOVERS:
            yield self.problem(
                "file",
                f"too many tracks enter the field during the run, got {len(tracks)}; expected at "
                f"most {MAX_MOVERS}: a shorter duration, a smaller field or a part of the file",
            )

    def problems(self, tracks: tuple[Track, ...]) -> Iterator[Mistake]:
        """Yield the first mover that is too fast, appears in the field or overlaps an object."""
        for check in (self._speed, self._appearance, self._static, self._robot):
            problem = next((p for track in tracks for p in check(track)), None)
            if problem is not None:
                yield problem

    def _speed(self, track: Track) -> Iterator[Mistake]:
        limit = MAX_SPEED_RATIO * self._scenario.robot.speed.vx
        if track.speed > limit * (1.0 + 1e-9):
            speeds = np.hypot(*np.diff(track.points, axis=0).T) / np.diff(track.times)
            at = self.sample(track, track.times[int(speeds.argmax())])
            yield self.problem(
                "file",
                f"{at}: too fast for the world, got {track.speed:.3g} m/s; expected at most "
                f"{MAX_SPEED_RATIO:g} robot.speed.vx = {limit:.3g} m/s: a smaller scale or a "
                "larger time_scale",
            )

    def _appearance(self, track: Track) -> Iterator[Mistake]:
        if track.stays:
            return
        low, high = self.recording.window
        for event, k, bound in (("appears", 0, "start"), ("leaves", -1, "the end of the run")):
            moment, point = track.times[k], track.points[k]
            if low < moment < high and self.recording.inside(np.array(point)):
                expected = "outside the field" + (
                    "" if self.mover.end == "repeat" else f" or {('before', 'after')[k]} {bound}"
                )
                which = "first" if k == 0 else "last"
                yield self.problem(
                    "file",
                    f"{self.sample(track, moment)}: {event} in the field, got {_shown(point)}; "
                    f"expected the {which} sample {expected}, a smaller world.size, "
                    'or end = "stay"',
                )

    def _static(self, track: Track) -> Iterator[Mistake]:
        world = self._scenario.world
        cylinders = [
            (f"world.obstacle[{k}]", o.radius, o.position) for k, o in enumerate(world.obstacle)
        ]
        for k, wall in enumerate(world.wall):
            positions = wall.positions(self._scenario.robot.radius)
            cylinders += [(f"world.wall[{k}]", wall.radius, position) for position in positions]
        moments, points = self.recording.sampled(track)
        for name, radius, position in cylinders:
            gaps = np.hypot(*(points - position).T)
            if len(gaps) and gaps.min() < radius + self.mover.radius:
                at = self.sample(track, moments[int(gaps.argmin())])
                yield self.problem(
                    "file",
                    f"{at}: overlaps {name} at {_shown(position)}, got {gaps.min():.3f} m between "
                    f"the axes; expected at least {radius + self.mover.radius:.3f} m",
                )

    def _robot(self, track: Track) -> Iterator[Mistake]:
        start = self._scenario.robot.start.position
        if start is None or self.mover.latest_start is not None or not track.present(0.0):
            return  # a drawn start is checked when it is drawn
        room = self.mover.radius + self._scenario.robot.radius
        gap = float(np.hypot(*np.subtract(track.position(0.0), start)))
        if gap < room:
            at = self.sample(track, track.recorded_time(0.0))
            yield self.problem(
                "start",
                f"{at}: begins at the start of the robot, "
                f"got {gap:.3f} m between the axes; expected at least {room:.3f} m, another start "
                "or robot.start.position",
            )


def _meetings(
    scenario: Scenario, crowds: list[tuple[_Crowd, tuple[Track, ...]]]
) -> Iterator[Mistake]:
    """Yield the closest overlap of two movers in the field for each recording.

    Recordings whose start is drawn are checked in themselves only.
    """
    if not crowds:
        return
    tracks = [track for _, tracks in crowds for track in tracks]
    owner = np.repeat(np.arange(len(crowds)), [len(tracks) for _, tracks in crowds])
    radii = np.array([crowds[k][0].mover.radius for k in owner])
    drawn = np.array([crowds[k][0].mover.latest_start is not None for k in owner])
    half = 0.5 * np.asarray(scenario.world.size) + radii[:, None]
    table, step = Paths([track.path for track in tracks]), STEP * scenario.time_scale
    closest: dict[int, tuple[float, float, int, int]] = {}  # missing room, time, both tracks
    times = np.arange(0.0, _horizon(scenario, crowds), step)
    for begin in range(0, len(times), CHUNK):
        chunk = times[begin : begin + CHUNK]
        positions = table.positions(chunk[:, None])
        inside = (np.abs(positions) < half).all(axis=-1)
        for i in range(len(tracks) - 1):
            other = slice(i + 1, None)
            offsets = positions[:, other] - positions[:, i : i + 1]
            room = np.hypot(offsets[..., 0], offsets[..., 1]) - radii[other] - radii[i]
            related = (owner[other] == owner[i]) | ~(drawn[other] | drawn[i])
            counts = (inside[:, other] | inside[:, i : i + 1]) & related
            room = np.where(counts, room, inf)
            row, column = np.unravel_index(int(room.argmin()), room.shape)
            missing, k = float(room[row, column]), i + 1 + int(column)
            if missing < min(0.0, closest.get(int(owner[k]), (0.0,))[0]):
                closest[int(owner[k])] = missing, float(chunk[row]), i, k
    for k, (missing, time, i, j) in closest.items():
        crowd, gap = crowds[k][0], missing + radii[i] + radii[j]
        at = crowd.sample(tracks[j], tracks[j].recorded_time(time))
        yield crowd.problem(
            "radius",
            f"{at}: overlaps id {tracks[i].id} in the field, got {gap:.3f} m between the axes; "
            f"expected at least {radii[i] + radii[j]:.3f} m: a radius of at most {0.5 * gap:.3f} "
            "or a larger scale",
        )


def _horizon(scenario: Scenario, crowds: list[tuple[_Crowd, tuple[Track, ...]]]) -> float:
    """Return the time after which no new situation occurs [s]."""
    recordings = [crowd.recording for crowd, _ in crowds]
    drawn = max(r.time_scale * (r.latest_start - r.start) for r in recordings)
    ends = [
        track.period if isfinite(track.period) else track.times[-1] - track.begin
        for _, tracks in crowds
        for track in tracks
    ]
    return min(scenario.duration + drawn, max(ends)) + STEP * scenario.time_scale


def _shown(point: Point) -> str:
    return f"[{point[0]:.3f}, {point[1]:.3f}]"
