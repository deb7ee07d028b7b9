"""How good beliefs are against the truth: pose, tracks, movers, ghosts, honesty."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from math import hypot

from hsr8.evaluation.track_metrics import owners
from navigation.angles import wrap
from navigation.belief.belief import Belief, Motion, Track
from navigation.belief.visibility import Viewpoint
from navigation.observation import Frame

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

NEAR = 0.3
"""Distance up to which a track, or a particle, belongs to an obstacle [m]."""
SIGHT_RANGE = 3.5
"""Distance up to which a detection is a sight of a mover [m]."""
CLEAR_RANGE = 2.2
"""Distance up to which an obstacle in clear view has to have a track [m]."""
SETTLING = 0.5
"""Time in clear view within which it gets one [s]."""
TURNING = 1.0
"""Time in view after a reversal that `steady` velocity errors leave out [s]."""


@dataclass(frozen=True, slots=True)
class Thing:
    """An obstacle of the world.

    Attributes:
        label: colour class.
        radius: [m].
        moves: whether it is a mover.
    """

    label: str
    radius: float
    moves: bool


@dataclass(frozen=True, slots=True)
class Moment:
    """One camera frame with the ground truth at its capture.

    Attributes:
        frame: what reached the belief.
        robot: true pose (3,) [m, m, rad].
        positions, velocities: of all obstacles (n, 2) [m], [m/s].
    """

    frame: Frame
    robot: Array
    positions: Array
    velocities: Array


@dataclass
class _Watched:
    """What happened so far to one mover, or to one obstacle in clear view."""

    first_seen: float | None = None
    in_view: float = 0.0
    recognised: bool = False
    heading: Array | None = None
    turned_at: float | None = None
    turn_seen: float | None = None
    turn_in_view: float = 0.0
    clear: float = 0.0


@dataclass
class Score:
    """Sums over all frames of all runs."""

    frames: int = 0
    position: list[float] = field(default_factory=list)
    heading: list[float] = field(default_factory=list)
    nees: list[float] = field(default_factory=list)
    run_nees: list[float] = field(default_factory=list)
    lost: int = 0
    faults: int = 0
    milliseconds: list[float] = field(default_factory=list)
    still_error: list[float] = field(default_factory=list)
    still_nees: list[float] = field(default_factory=list)
    mover_error: list[float] = field(default_factory=list)
    mover_nees: list[float] = field(default_factory=list)
    velocity: list[float] = field(default_factory=list)
    steady_velocity: list[float] = field(default_factory=list)
    velocity_nees: list[float] = field(default_factory=list)
    verdicts: dict[tuple[bool, str], int] = field(default_factory=dict)
    recognition: list[float] = field(default_factory=list)
    recognition_in_view: list[float] = field(default_factory=list)
    unrecognised: int = 0
    reversal: list[float] = field(default_factory=list)
    unnoticed: int = 0
    ghosts: int = 0
    clouds: int = 0
    stray: int = 0
    expected: int = 0
    missed: int = 0

    def add_run(
        self, objects: list[Thing], moments: Iterable[tuple[Moment, Belief]], milliseconds: float
    ) -> None:
        """Score one run.

        Args:
            objects: its obstacles, in the order of the truth.
            moments: its frames with the belief after each.
            milliseconds: CPU time of the belief per frame; 0 if it was not measured.
        """
        watched = [_Watched() for _ in objects]
        before, first, belief = None, len(self.nees), None
        for moment, belief in moments:
            dt = 0.0 if before is None else moment.frame.time - before
            before = moment.frame.time
            self.frames += 1
            self._add_pose(moment, belief)
            self._add_tracks(objects, moment, belief, watched, dt)
        self.run_nees.append(float(np.mean(self.nees[first:])))
        if belief is not None:
            self.faults += belief.filter_faults
        if milliseconds:
            self.milliseconds.append(milliseconds)
        for w in watched:
            # One that was in view for a second and is still not known to move counts as late.
            self.unrecognised += w.first_seen is not None and not w.recognised and w.in_view >= 1.0
            self.unnoticed += w.turn_seen is not None and w.turn_in_view >= 1.0

    def _add_pose(self, moment: Moment, belief: Belief) -> None:
        e = belief.pose - moment.robot
        e[2] = wrap(float(e[2]))
        self.position.append(hypot(float(e[0]), float(e[1])))
        self.heading.append(abs(float(e[2])))
        self.nees.append(float(e @ np.linalg.solve(belief.pose_covariance, e)) / 3.0)
        self.lost += belief.lost

    def _add_tracks(
        self,
        objects: list[Thing],
        moment: Moment,
        belief: Belief,
        watched: list[_Watched],
        dt: float,
    ) -> None:
        labels = [s.label for s in objects]
        tracks = [t for t in belief.tracks if t.particles is None]
        by_owner = {
            i: tracks[k]
            for k, i in zip(
                *owners(
                    np.array([t.label for t in tracks], dtype=object),
                    np.reshape([t.position for t in tracks], (-1, 2)),
                    np.zeros(len(tracks), dtype=np.intp),
                    labels,
                    moment.positions[None],
                    scale=1.0,
                ),
                strict=True,
            )
        }
        owned, taken = {t.id for t in by_owner.values()}, set(by_owner)
        for t in belief.tracks:
            if t.particles is not None:
                self.clouds += 1
                self.stray += not _near_cloud(t, objects, moment, taken)
            elif t.id not in owned:
                away = np.hypot(*(moment.positions - t.position).T)
                self.ghosts += not any(
                    a < NEAR and s.label == t.label for a, s in zip(away, objects, strict=True)
                )
        detected_objects = _detected(objects, moment)
        clear = _in_clear_view(objects, moment)
        for i, (known_object, w) in enumerate(zip(objects, watched, strict=True)):
            track = by_owner.get(i)
            w.clear = w.clear + dt if clear[i] else 0.0
            if w.clear > SETTLING:
                self.expected += 1
                self.missed += track is None
            if track is not None and track.visible:
                key = (known_object.moves, track.motion.value)
                self.verdicts[key] = self.verdicts.get(key, 0) + 1
            if known_object.moves:
                self._add_mover(w, track, moment, i, dt, detected=i in detected_objects)
            elif track is not None and track.motion is Motion.STATIC:
                e = track.position - moment.positions[i]
                self.still_error.append(float(np.hypot(*e)))
                self.still_nees.append(float(e @ np.linalg.solve(track.covariance[:2, :2], e)) / 2)

    def _add_mover(
        self,
        w: _Watched,
        track: Track | None,
        moment: Moment,
        i: int,
        dt: float,
        *,
        detected: bool,
    ) -> None:
        time, v = moment.frame.time, moment.velocities[i]
        if w.heading is not None and float(w.heading @ v) < 0.0:
            if w.turn_seen is not None and w.turn_in_view >= 1.0:
                self.unnoticed += 1
            w.turned_at, w.turn_seen, w.turn_in_view = (
                (time if w.recognised else None),
                None,
                0.0,
            )
        w.heading = v
        if w.first_seen is None and detected:
            w.first_seen = time
        elif w.first_seen is not None and detected:
            w.in_view += dt
        if w.turned_at is not None and detected:
            w.turn_seen = time if w.turn_seen is None else w.turn_seen
            w.turn_in_view += dt
        if track is None:
            return
        moving = track.motion is Motion.MOVING
        if moving and not w.recognised and w.first_seen is not None:
            w.recognised = True
            self.recognition.append(time - w.first_seen)
            self.recognition_in_view.append(w.in_view)
        turning = w.turned_at is not None
        if w.turn_seen is not None and float(track.velocity @ v) > 0.0:
            self.reversal.append(time - w.turn_seen)
            w.turned_at = w.turn_seen = None
        if not (moving and detected and track.visible and w.in_view > TURNING):
            return
        e = np.concatenate([track.position - moment.positions[i], track.velocity - v])
        self.mover_error.append(float(np.hypot(*e[:2])))
        self.velocity.append(float(np.hypot(*e[2:])))
        if not turning:
            self.steady_velocity.append(self.velocity[-1])
        P = track.covariance
        self.mover_nees.append(float(e[:2] @ np.linalg.solve(P[:2, :2], e[:2])) / 2.0)
        self.velocity_nees.append(float(e[2:] @ np.linalg.solve(P[2:, 2:], e[2:])) / 2.0)

    def rows(self) -> list[tuple[str, str]]:
        """Name and value of every result."""
        n = max(1, self.frames)

        def tails(values: list[float]) -> str:
            if not values:
                return "-"
            return f"{np.median(values):.2f} / {np.percentile(values, 90):.2f} ({len(values)})"

        def shares(moves: bool) -> str:
            counts = {m.value: self.verdicts.get((moves, m.value), 0) for m in Motion}
            total = max(1, sum(counts.values()))
            return ", ".join(f"{name} {100 * c / total:.1f} %" for name, c in counts.items())

        return [
            ("position rmse / p95 / max [cm]", _centimetres(self.position)),
            (
                "heading rmse / p95 / max [deg]",
                " / ".join(f"{np.degrees(v):.3f}" for v in _spread(self.heading)),
            ),
            (
                "pose NEES per dof, mean; least and largest run",
                f"{_mean(self.nees):.2f}; {min(self.run_nees):.2f}, {max(self.run_nees):.2f}",
            ),
            ("frames lost, filter faults", f"{self.lost}, {self.faults}"),
            ("static tracks: position rmse / p95 / max [cm]", _centimetres(self.still_error)),
            ("static tracks: NEES per dof", f"{_mean(self.still_nees):.2f}"),
            ("movers in view: position rmse / p95 / max [cm]", _centimetres(self.mover_error)),
            (
                "movers in view: velocity rmse / p95 / max [cm/s]",
                _centimetres(self.velocity),
            ),
            ("  the same velocity, no reversal pending", _centimetres(self.steady_velocity)),
            (
                "  NEES per dof of position, of velocity, reversals and all",
                f"{_mean(self.mover_nees):.2f}, {_mean(self.velocity_nees):.2f}",
            ),
            ("movers in view are", shares(True)),
            ("statics in view are", shares(False)),
            ("mover recognised after first sight p50 / p90 [s]", tails(self.recognition)),
            ("  time in view until then p50 / p90 [s]", tails(self.recognition_in_view)),
            ("  never, though in view for 1 s", str(self.unrecognised)),
            ("reversal noticed after its detection p50 / p90 [s]", tails(self.reversal)),
            ("  never, though in view for 1 s", str(self.unnoticed)),
            ("ghosts per frame", f"{self.ghosts / n:.4f}"),
            (
                "particle clouds, stray ones per frame",
                f"{self.clouds / n:.3f}, {self.stray / n:.4f}",
            ),
            (
                "in clear view without a track",
                f"{100 * self.missed / max(1, self.expected):.3f} % of {self.expected}",
            ),
            ("belief, CPU time per frame [ms]", f"{_mean(self.milliseconds):.2f}"),
        ]


def _near_cloud(t: Track, objects: list[Thing], moment: Moment, taken: set[int]) -> bool:
    assert t.particles is not None
    return any(
        s.label == t.label
        and i not in taken
        and float(np.min(np.hypot(*(t.particles.positions - moment.positions[i]).T))) < NEAR
        for i, s in enumerate(objects)
    )


def _detected(objects: list[Thing], moment: Moment) -> set[int]:
    """Indices of the obstacles that the frame shows."""
    detected = set()
    x, y, heading = moment.robot.tolist()
    for o in moment.frame.observations:
        if o.kind != "obstacle" or o.distance > SIGHT_RANGE:
            continue
        bearing = heading + o.bearing
        position = np.array([x + o.distance * np.cos(bearing), y + o.distance * np.sin(bearing)])
        away = np.hypot(*(moment.positions - position).T)
        away[[s.label != o.label for s in objects]] = np.inf
        if len(away) and away.min() < NEAR:
            detected.add(int(np.argmin(away)))
    return detected


def _in_clear_view(objects: list[Thing], moment: Moment) -> NDArray[np.bool_]:
    viewpoint = Viewpoint.of(moment.frame.view, moment.robot, CLEAR_RANGE)
    radii = np.array([s.radius for s in objects])
    return viewpoint.in_clear_view(
        moment.positions, moment.positions, radii, margin=0.07, occlusion_margin=0.08
    )


def _mean(values: list[float]) -> float:
    return float(np.mean(values)) if values else float("nan")


def _spread(values: list[float]) -> tuple[float, float, float]:
    """Root mean square, 95th percentile, maximum."""
    if not values:
        return (float("nan"),) * 3
    squares = np.square(values)
    return (
        float(np.sqrt(squares.mean())),
        float(np.percentile(values, 95)),
        float(np.max(values)),
    )


def _centimetres(values: list[float]) -> str:
    return " / ".join(f"{100 * v:.2f}" for v in _spread(values))
