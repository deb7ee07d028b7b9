"""Obstacle tracks: who is who, where, how fast, and whether it moves at all.

Every obstacle carries a Kalman filter for each way in which it may move; how probable they
are decides between static and moving, and tells a reversal. A track that may move and is out
of sight becomes a cloud of particles. Nothing but colour tells two obstacles apart, so
identity is decided by position alone.
"""

from math import inf, pi

import numpy as np
from numpy.typing import NDArray

from navigation import motion_modes, track_particles
from navigation.association import assign, overlapping
from navigation.belief import Motion, Track
from navigation.belief_parameters import TrackingParameters
from navigation.correlated_noise import variance_inflation
from navigation.motion_modes import Modes
from navigation.observation import Observation
from navigation.sightings import Sightings
from navigation.tracked_object import TrackedObject
from navigation.visibility import Mask, Viewpoint

Array = NDArray[np.float64]


class Tracker:
    """Keeps the tracks of all obstacles.

    Args:
        parameters: filters, association, classification, birth and death.
        rng: source of the particles.
    """

    def __init__(self, parameters: TrackingParameters, rng: np.random.Generator) -> None:
        self._parameters = parameters
        self._rng = rng
        self._objects: list[TrackedObject] = []
        self._stack: tuple[list[int], Modes] | None = None  # whose filters, and these
        self._time: float | None = None
        self._freed: Mask = np.zeros(0, np.bool_)
        self._next_id = 1

    def update(
        self, time: float, seen: Sightings, viewpoint: Viewpoint, freed: Mask
    ) -> tuple[Track, ...]:
        """Take in one frame and return the tracks, by id.

        Args:
            time: of the frame [s].
            seen: its obstacles in W.
            viewpoint: its camera in W, with the range within which detection is sure.
            freed: which of them stand where the floor was seen empty before (m,); what is new
                there has moved.
        """
        self._freed = freed
        dt = 0.0 if self._time is None else time - self._time
        self._time = time
        if self._objects:
            modes = self._predict(dt)
            pairs = assign(self._costs(time, seen, modes))
            self._correct(time, pairs, seen, modes)
        else:
            pairs = []
        taken = {column for _, column in pairs}
        self._begin(time, [j for j in range(len(seen.radii)) if j not in taken], seen)
        self._doubt(time, dt, seen, viewpoint)
        self._merge(time)
        p = self._parameters
        return tuple(o.track(time, p) for o in self._objects if o.hits >= p.birth_hits)

    def clear(self) -> None:
        """Forget all tracks, for instance because the robot was carried away."""
        self._objects.clear()

    def _predict(self, dt: float) -> Modes:
        """Carry everything on by `dt` [s]; the filters of all obstacles, each one's its rows."""
        p = self._parameters
        ids = [o.id for o in self._objects]
        modes = motion_modes.predict(self._stacked(ids), dt, p)
        self._stack = ids, modes
        for o, *parts in zip(self._objects, *modes, strict=True):
            o.modes = Modes(*parts)
            if o.particles is not None:
                o.particles = track_particles.advance(o.particles, dt, p, self._rng)
        return modes

    def _stacked(self, ids: list[int]) -> Modes:
        """The filters of all obstacles, one after the other."""
        if self._stack is not None and self._stack[0] == ids:
            return self._stack[1]
        # For arrays as small as these np.array is several times faster than np.stack.
        parts = zip(*(o.modes for o in self._objects), strict=True)
        return Modes(*(np.array(part) for part in parts))

    def _costs(self, time: float, seen: Sightings, modes: Modes) -> Array:
        """Cost of every track with every sighting against the sighting being new (n, m).

        A lost track is also a cloud of particles, and with a small probability anywhere
        within its reach.
        """
        p = self._parameters
        n, m = len(self._objects), len(seen.radii)
        if m == 0:
            return np.empty((n, 0))
        costs = motion_modes.costs(modes, seen.positions, seen.covariances, p.gate)
        width = 0.5 * (seen.covariances[:, 0, 0] + seen.covariances[:, 1, 1])
        for i, o in enumerate(self._objects):
            if o.particles is not None:
                lost = o.last_seen, o.lost_reach(time, p)
                cloud = track_particles.costs(o.particles, seen.positions, width, lost, p)
                costs[i] = np.minimum(costs[i], cloud)
        density = np.where(self._freed, p.intruder_density, p.birth_density)
        costs += 2.0 * np.log(2.0 * pi * density)
        for i, j in np.argwhere(costs < 0.0).tolist():
            if self._objects[i].label != seen.observations[j].label:
                costs[i, j] = inf
        return costs

    def _correct(
        self, time: float, pairs: list[tuple[int, int]], seen: Sightings, modes: Modes
    ) -> None:
        """Update the filters, verdict and radius of the tracks that were detected."""
        if not pairs:
            return
        p = self._parameters
        rows, columns = np.array(pairs).T.copy()
        objects = [self._objects[row] for row in rows.tolist()]
        z, raw = seen.positions[columns], seen.covariances[columns]
        for i, (o, column) in enumerate(zip(objects, columns.tolist(), strict=True)):
            if o.radius_sigma < seen.radius_sigmas[column]:
                z[i], raw[i] = seen.of_radius(column, o.radius, o.radius_sigma)
        inflation = [variance_inflation(time - o.last_time, p.correlation_time) for o in objects]
        R = raw * np.array(inflation)[:, None, None]
        surprise = motion_modes.surprise(modes, rows, z, raw)
        for i in np.flatnonzero(surprise > p.gate).tolist():
            # Nothing explains where it is: what was known of its motion is void.
            k, moving = rows[i], max(float(objects[i].modes.moving), 0.5)
            begun = motion_modes.begun(z[i], raw[i], moving, p)
            modes.weights[k], modes.states[k], modes.covariances[k] = begun
        motion_modes.update(modes, rows, z, R, p.evidence)
        for i, (o, column) in enumerate(zip(objects, columns.tolist(), strict=True)):
            self._widen(o, seen.observations[column], inflation[i])
            o.hits += 1
            o.misses = 0
            o.expected_for = 0.0
            o.last_time = time
            o.last_seen, o.seen_covariance = z[i].copy(), raw[i].copy()
            if _trace(raw[i]) < _trace(o.best_covariance):
                o.best_covariance = o.seen_covariance
            o.particles = None
            o.presence = 1.0
            o.classify(p)

    def _widen(self, o: TrackedObject, observation: Observation, inflation: float) -> None:
        """Fuse the radius, unless the part that was seen tells next to nothing about it."""
        p = self._parameters
        part = observation.cut or observation.occluded
        if part and observation.radius_sigma > p.vague_radius:
            return
        measured = observation.radius_sigma**2 * inflation
        prior = o.radius_sigma**2
        gain = prior / (prior + measured)
        o.radius += gain * (observation.radius - o.radius)
        o.radius_sigma = max(((1.0 - gain) * prior) ** 0.5, p.radius_limit)

    def _begin(self, time: float, columns: list[int], seen: Sightings) -> None:
        """Start a tentative track at each sighting that no track explains."""
        p = self._parameters
        for j in columns:
            z, R, observation = seen.positions[j], seen.covariances[j], seen.observations[j]
            if observation.distance > p.birth_range:
                continue
            reach = p.overlap * observation.radius
            if any(
                o.label == observation.label
                and o.last_time == time
                and float(np.hypot(*(o.position - z))) < reach + p.overlap * o.radius
                for o in self._objects
            ):
                continue
            moving = p.intruder_moving if self._freed[j] else p.birth_moving
            self._objects.append(
                TrackedObject(
                    id=self._next_id,
                    label=observation.label,
                    modes=motion_modes.begun(z, R, moving, p),
                    radius=observation.radius,
                    radius_sigma=max(observation.radius_sigma, p.radius_limit),
                    first_time=time,
                    last_time=time,
                    last_seen=z.copy(),
                    seen_covariance=R.copy(),
                    best_covariance=R.copy(),
                )
            )
            self._next_id += 1

    def _doubt(self, time: float, dt: float, seen: Sightings, viewpoint: Viewpoint) -> None:
        """Count what should have been seen but was not, lose movers, end tracks."""
        unseen = [o for o in self._objects if o.last_time < time]
        if not unseen:
            return
        clouds = [
            o.position[None] if o.particles is None else o.particles.positions for o in unseen
        ]
        expected = self._expected(np.concatenate(clouds), seen, viewpoint)
        start = 0
        ended = set()
        for o, points in zip(unseen, clouds, strict=True):
            mask = expected[start : start + len(points)]
            start += len(points)
            if not self._survives(o, time, dt, mask):
                ended.add(o.id)
        self._objects = [o for o in self._objects if o.id not in ended]
        self._respread(time, seen, viewpoint)

    def _expected(self, points: Array, seen: Sightings, viewpoint: Viewpoint) -> Mask:
        p = self._parameters
        standing = [o for o in self._objects if o.motion is Motion.STATIC]
        centres = np.concatenate([seen.positions, *(o.position[None] for o in standing)])
        radii = np.concatenate([seen.radii, [o.radius for o in standing]])
        return viewpoint.expects(points, centres, radii, margin=p.view_margin, slack=p.hiding_slack)

    def _survives(self, o: TrackedObject, time: float, dt: float, expected: Mask) -> bool:
        """Hold a frame without detection against a track; False ends it."""
        p = self._parameters
        age = time - o.last_time
        if o.hits < p.birth_hits:
            return age <= p.birth_time
        if o.motion is Motion.STATIC:
            o.expected_for = o.expected_for + dt if expected[0] else 0.0
            if o.expected_for >= p.miss_time:
                o.expected_for = 0.0
                o.misses += 1
            return o.misses < p.misses
        if age > (p.forget_time if o.hits >= p.moving_hits else p.tentative_time):
            return False
        if o.particles is None:
            if age > p.lost_time:
                o.particles = track_particles.spawn(o.modes, p.particles, self._rng)
            return True
        survival = (1.0 - p.detection_probability) ** (dt / p.refutation_time)
        cloud, left = track_particles.refute(o.particles, expected, survival)
        o.presence *= left
        o.particles = track_particles.resample(cloud, p, self._rng)
        return True

    def _respread(self, time: float, seen: Sightings, viewpoint: Viewpoint) -> None:
        """Spread refuted clouds over what is out of view of all they could have reached."""
        p = self._parameters
        refuted = [o for o in self._objects if o.particles is not None and o.presence < p.refuted]
        # What was not known to move and is not where it was has never been there.
        ended = {o.id for o in refuted if o.motion is Motion.UNKNOWN}
        for o in refuted:
            if o.id in ended:
                continue
            velocity = o.estimate(p)[0][2:4]
            cloud = track_particles.scatter(
                o.last_seen, o.lost_reach(time, p), velocity, p, self._rng
            )
            places = np.flatnonzero(~self._expected(cloud.positions, seen, viewpoint))
            o.presence = 1.0
            if len(places) < p.particles:
                ended.add(o.id)
            else:
                o.particles = track_particles.chosen(cloud, places[: p.particles])
        self._objects = [o for o in self._objects if o.id not in ended]

    def _merge(self, time: float) -> None:
        """End one of two tracks of a colour that stand where only one obstacle fits."""
        p = self._parameters
        objects = [o for o in self._objects if o.particles is None]
        if len(objects) < 2:
            return
        places = np.array([o.position for o in objects])
        reach = p.overlap * np.array([o.radius for o in objects])
        close = overlapping(places, reach)
        ended: set[int] = set()
        for i, j in close.tolist():
            a, b = objects[i], objects[j]
            if a.label != b.label or ended & {a.id, b.id}:
                continue
            if a.last_time == time and b.last_time == time:
                continue
            worse = min(a, b, key=lambda o: (o.hits >= p.birth_hits, o.last_time, o.hits))
            ended.add(worse.id)
        if ended:
            self._objects = [o for o in self._objects if o.id not in ended]


def _trace(covariance: Array) -> float:
    (xx, _), (_, yy) = covariance.tolist()
    return float(xx + yy)
