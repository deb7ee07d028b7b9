"""Obstacle tracks: who is who, where, how fast, and whether it moves at all.

Every obstacle carries a Kalman filter for each way in which it may move; how probable they
are decides between static and moving, and tells a reversal. A track that may move and is out
of sight becomes a cloud of particles. Nothing but colour tells two obstacles apart, so
identity is decided by position alone.
"""

from itertools import compress
from math import hypot, inf, log, pi

import numpy as np
from numpy.typing import NDArray

from navigation.belief import imm, track_particles
from navigation.belief.association import Indices, assign
from navigation.belief.association_kernel import overlapping
from navigation.belief.belief import Motion, Track
from navigation.belief.correlated_noise import variance_inflation
from navigation.belief.sightings import Sightings
from navigation.belief.tracked_object import TrackedObject, reach_of
from navigation.belief.visibility import Mask, Viewpoint
from navigation.observation import Observation
from navigation.parameters.belief import TrackingParameters

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
        # What it costs to take a sighting for new: anywhere, and where the floor was empty.
        self._beginning = 2.0 * log(2.0 * pi * parameters.birth_density)
        self._intruding = 2.0 * log(2.0 * pi * parameters.intruder_density)
        self._objects: list[TrackedObject] = []
        # Of every object its row: its filters, the covariance of its most precise detection,
        # its verdict, and where it is.
        self._modes = imm.none()
        self._best = np.zeros((0, 2, 2))
        self._standing: Mask = np.zeros(0, np.bool_)
        self._places = np.zeros((0, 2))
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
        unexplained = set(range(len(seen.radii)))
        if self._objects:
            self._predict(dt)
            rows, columns = assign(self._costs(time, seen))
            self._correct(time, rows, columns, seen)
            self._locate()
            unexplained -= set(columns.tolist())
        self._begin(time, sorted(unexplained), seen)
        self._doubt(time, dt, seen, viewpoint)
        self._merge(time)
        return self._published(time)

    def clear(self) -> None:
        """Forget all tracks, for instance because the robot was carried away."""
        self._objects.clear()
        self._modes = imm.none()
        self._best = np.zeros((0, 2, 2))
        self._locate()

    def _predict(self, dt: float) -> None:
        """Carry everything on by `dt` [s]."""
        p = self._parameters
        self._modes = imm.predict(self._modes, dt, p)
        for o in self._objects:
            if o.particles is not None:
                o.particles = track_particles.advance(o.particles, dt, p, self._rng)

    def _costs(self, time: float, seen: Sightings) -> Array:
        """Cost of every track with every sighting against the sighting being new (n, m).

        A lost track is also a cloud of particles, and with a small probability anywhere
        within its reach.
        """
        p = self._parameters
        n, m = len(self._objects), len(seen.radii)
        if m == 0:
            return np.empty((n, 0))
        costs = imm.costs(self._modes, seen.positions, seen.covariances, p.gate)
        width = 0.5 * (seen.covariances[:, 0, 0] + seen.covariances[:, 1, 1])
        for i, o in enumerate(self._objects):
            if o.particles is not None:
                lost = o.last_seen, o.lost_reach(time, self._modes.at(i), p)
                cloud = track_particles.costs(o.particles, seen.positions, width, lost, p)
                costs[i] = np.minimum(costs[i], cloud)
        costs += np.where(self._freed, self._intruding, self._beginning)
        for i, j in np.argwhere(costs < 0.0).tolist():
            if self._objects[i].label != seen.observations[j].label:
                costs[i, j] = inf
        return costs

    def _correct(self, time: float, rows: Indices, columns: Indices, seen: Sightings) -> None:
        """Update the filters, verdict and radius of the tracks that were detected."""
        if len(rows) == 0:
            return
        p, modes = self._parameters, self._modes
        pairs = list(zip(rows.tolist(), columns.tolist(), strict=True))
        objects = [self._objects[row] for row, _ in pairs]
        z, raw = seen.positions[columns], seen.covariances[columns]
        for i, (o, (_, column)) in enumerate(zip(objects, pairs, strict=True)):
            if o.radius_sigma < seen.radius_sigmas[column]:
                z[i], raw[i] = seen.of_radius(column, o.radius, o.radius_sigma)
        inflation = [variance_inflation(time - o.last_time, p.correlation_time) for o in objects]
        R = raw * np.array(inflation)[:, None, None]
        nis = imm.nis(modes, rows, z, raw)
        for i in np.flatnonzero(nis > p.gate).tolist():
            # Nothing explains where it is: what was known of its motion is void.
            known = modes.at(pairs[i][0])
            begun = imm.begun(z[i], raw[i], max(float(known.moving), 0.5), p)
            for part, anew in zip(known, begun, strict=True):
                part[:] = anew
        imm.update(modes, rows, z, R, p.max_log_ratio)
        for i, (o, (row, column)) in enumerate(zip(objects, pairs, strict=True)):
            self._fuse_radius(o, seen.observations[column], inflation[i])
            o.hits += 1
            o.misses = 0
            o.expected_for = 0.0
            o.last_time = time
            o.last_seen, o.known_reach = z[i], reach_of(raw[i], p)
            if _trace(raw[i]) < _trace(self._best[row]):
                self._best[row] = raw[i]
            o.particles = None
            o.presence = 1.0
            o.classify(modes.at(row), p)

    def _fuse_radius(self, o: TrackedObject, observation: Observation, inflation: float) -> None:
        """Fuse the radius, unless the part that was seen tells next to nothing about it."""
        p = self._parameters
        part = observation.cut or observation.occluded
        if part and observation.radius_sigma > p.max_radius_sigma:
            return
        measured = observation.radius_sigma**2 * inflation
        prior = o.radius_sigma**2
        gain = prior / (prior + measured)
        o.radius += gain * (observation.radius - o.radius)
        o.radius_sigma = max(((1.0 - gain) * prior) ** 0.5, p.min_radius_sigma)

    def _begin(self, time: float, columns: list[int], seen: Sightings) -> None:
        """Start a tentative track at each sighting that no track explains."""
        if not columns:
            return
        p = self._parameters
        places, begun, noise = list(self._places), [], []
        for j in columns:
            z, R, observation = seen.positions[j], seen.covariances[j], seen.observations[j]
            if observation.distance > p.birth_range:
                continue
            reach = p.merge_fraction * observation.radius
            if any(
                o.label == observation.label
                and o.last_time == time
                and hypot(*(place - z).tolist()) < reach + p.merge_fraction * o.radius
                for o, place in zip(self._objects, places, strict=True)
            ):
                continue
            moving = p.intruder_moving_probability if self._freed[j] else p.birth_moving_probability
            self._objects.append(
                TrackedObject(
                    id=self._next_id,
                    label=observation.label,
                    radius=observation.radius,
                    radius_sigma=max(observation.radius_sigma, p.min_radius_sigma),
                    first_time=time,
                    last_time=time,
                    last_seen=z,
                    known_reach=reach_of(R, p),
                )
            )
            self._next_id += 1
            places.append(z)
            begun.append(imm.begun(z, R, moving, p))
            noise.append(R)
        if begun:
            self._modes = self._modes.followed_by(begun)
            self._best = np.concatenate([self._best, np.array(noise)])
            self._locate()

    def _doubt(self, time: float, dt: float, seen: Sightings, viewpoint: Viewpoint) -> None:
        """Count what should have been seen but was not, lose movers, end tracks."""
        objects = self._objects
        if all(o.last_time == time for o in objects):
            return
        clouds = [o.particles.positions for o in objects if o.particles is not None]
        expected = self._expected(np.concatenate([self._places, *clouds]), seen, viewpoint)
        start = len(objects)
        ended = set()
        for row, o in enumerate(objects):
            mask = expected[row : row + 1]
            if o.particles is not None:
                mask = expected[start : start + len(o.particles.weights)]
                start += len(mask)
            if o.last_time < time and not self._survives(row, time, dt, mask):
                ended.add(o.id)
        self._end(ended)
        self._respread(time, seen, viewpoint)

    def _expected(self, points: Array, seen: Sightings, viewpoint: Viewpoint) -> Mask:
        p = self._parameters
        standing = [o.radius for o in compress(self._objects, self._standing)]
        centres = np.concatenate([seen.positions, self._places[self._standing]])
        radii = np.concatenate([seen.radii, standing])
        return viewpoint.expects(
            points, centres, radii, margin=p.view_margin, slack=p.occlusion_margin
        )

    def _survives(self, row: int, time: float, dt: float, expected: Mask) -> bool:
        """Count a frame without detection; return whether the track is kept."""
        p, o = self._parameters, self._objects[row]
        age = time - o.last_time
        if o.hits < p.birth_hits:
            return age <= p.birth_time
        if o.motion is Motion.STATIC:
            o.expected_for = o.expected_for + dt if expected[0] else 0.0
            if o.expected_for >= p.miss_time:
                o.expected_for = 0.0
                o.misses += 1
            return o.misses < p.max_misses
        if age > (p.forget_time if o.hits >= p.min_moving_hits else p.tentative_time):
            return False
        if o.particles is None:
            if age > p.lost_time:
                o.particles = track_particles.spawn(self._modes.at(row), p.particles, self._rng)
            return True
        survival = (1.0 - p.detection_probability) ** (dt / p.detection_time)
        cloud, left = track_particles.refute(o.particles, expected, survival)
        o.presence *= left
        o.particles = track_particles.resample(cloud, p, self._rng)
        return True

    def _respread(self, time: float, seen: Sightings, viewpoint: Viewpoint) -> None:
        """Spread refuted clouds over what is out of view of all they could have reached."""
        p = self._parameters
        ended = set()
        for row, o in enumerate(self._objects):
            if o.particles is None or o.presence >= p.min_existence:
                continue
            if o.motion is Motion.UNKNOWN:
                # What was not known to move and is not where it was has never been there.
                ended.add(o.id)
                continue
            modes = self._modes.at(row)
            velocity, reach = imm.moments(modes)[0][2:4], o.lost_reach(time, modes, p)
            cloud = track_particles.scatter(o.last_seen, reach, velocity, p, self._rng)
            places = np.flatnonzero(~self._expected(cloud.positions, seen, viewpoint))
            o.presence = 1.0
            if len(places) < p.particles:
                ended.add(o.id)
            else:
                o.particles = track_particles.chosen(cloud, places[: p.particles])
        self._end(ended)

    def _merge(self, time: float) -> None:
        """End one of two tracks of a colour that stand where only one obstacle fits."""
        p = self._parameters
        reach = p.merge_fraction * np.array([o.radius for o in self._objects], float)
        ended: set[int] = set()
        for i, j in overlapping(self._places, reach).tolist():
            a, b = self._objects[i], self._objects[j]
            if a.particles is not None or b.particles is not None:
                continue
            if a.label != b.label or ended & {a.id, b.id}:
                continue
            if a.last_time == time and b.last_time == time:
                continue
            worse = min(a, b, key=lambda o: (o.hits >= p.birth_hits, o.last_time, o.hits))
            ended.add(worse.id)
        self._end(ended)

    def _end(self, ended: set[int]) -> None:
        """Drop the objects with these ids."""
        if not ended:
            return
        kept = np.array([o.id not in ended for o in self._objects])
        self._objects = list(compress(self._objects, kept))
        self._modes, self._best = self._modes.at(kept), self._best[kept]
        self._standing, self._places = self._standing[kept], self._places[kept]

    def _locate(self) -> None:
        """Work out where the objects are, or would be were they not lost."""
        static = Motion.STATIC
        self._standing = np.array([o.motion is static for o in self._objects], np.bool_)
        self._places = imm.places(self._modes, self._standing)

    def _published(self, time: float) -> tuple[Track, ...]:
        """The tracks as of `time` [s], without what may be a false blob."""
        p = self._parameters
        estimates = imm.estimates(self._modes, self._standing, self._best, p)
        return tuple(
            o.track(time, p, estimate)
            for o, estimate in zip(self._objects, zip(*estimates, strict=True), strict=True)
            if o.hits >= p.birth_hits
        )


def _trace(covariance: Array) -> float:
    (xx, _), (_, yy) = covariance.tolist()
    return float(xx + yy)
