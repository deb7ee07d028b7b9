"""Multi-object tracker: association, filtering, classification, birth and death of tracks.

Every track has an IMM filter, whose mode probabilities classify it as static or moving. A lost
track that may move becomes a particle filter. Association uses colour and position only.
"""

from itertools import compress
from math import inf, log, pi

import numpy as np
from numpy.typing import NDArray

from navigation.belief import imm, imm_kernel, particle_kernel, track_particles
from navigation.belief.association import Indices, assign
from navigation.belief.association_kernel import overlapping
from navigation.belief.belief import Motion, Track
from navigation.belief.correlated_noise import variance_inflation
from navigation.belief.detections import Detections
from navigation.belief.tracked_object import TrackedObject, reach_of
from navigation.belief.visibility import Mask, Viewpoint
from navigation.observation import Observation
from navigation.parameters.belief import TrackingParameters

Array = NDArray[np.float64]


class Tracker:
    """Multi-object tracker of the obstacles.

    Args:
        parameters: motion models, association, classification, birth and death.
        rng: source of the particles.
    """

    def __init__(self, parameters: TrackingParameters, rng: np.random.Generator) -> None:
        self._parameters = parameters
        self._rng = rng
        # Costs of a track birth on unseen floor and on floor seen empty.
        self._birth_cost = 2.0 * log(2.0 * pi * parameters.birth_density)
        self._intruder_cost = 2.0 * log(2.0 * pi * parameters.intruder_density)
        self._objects: list[TrackedObject] = []
        # One row per object: filters, covariance of the most precise detection, position.
        self._modes = imm.empty()
        self._best = np.zeros((0, 2, 2))
        self._static: Mask = np.zeros(0, np.bool_)
        self._positions = np.zeros((0, 2))
        self._time: float | None = None
        self._on_free_floor: Mask = np.zeros(0, np.bool_)
        self._next_id = 1

    def update(
        self, time: float, detections: Detections, viewpoint: Viewpoint, on_free_floor: Mask
    ) -> tuple[Track, ...]:
        """Update by one frame and return the confirmed tracks, by id.

        Args:
            time: of the frame [s].
            detections: in W.
            viewpoint: camera in W, with the range within which detection is certain.
            on_free_floor: which detections are on floor seen empty before (m,): a new obstacle
                there has moved.
        """
        self._on_free_floor = on_free_floor
        dt = 0.0 if self._time is None else time - self._time
        self._time = time
        unassigned = set(range(len(detections.radii)))
        if self._objects:
            self._predict(dt)
            rows, columns = assign(self._costs(time, detections))
            self._correct(time, rows, columns, detections)
            self._update_positions()
            unassigned -= set(columns.tolist())
        self._begin(time, sorted(unassigned), detections)
        self._handle_misses(time, dt, detections, viewpoint)
        self._merge(time)
        return self._published(time)

    def clear(self) -> None:
        """Delete all tracks."""
        self._objects.clear()
        self._modes = imm.empty()
        self._best = np.zeros((0, 2, 2))
        self._update_positions()

    def _predict(self, dt: float) -> None:
        p = self._parameters
        self._modes = imm.predict(self._modes, dt, p)
        for o in self._objects:
            if o.particles is not None:
                o.particles = track_particles.advance(o.particles, dt, p, self._rng)

    def _costs(self, time: float, detections: Detections) -> Array:
        """Return the association costs relative to the birth of a track (n, m).

        A lost track has the smaller of the costs of its filters and its particles.
        """
        p = self._parameters
        n, m = len(self._objects), len(detections.radii)
        if m == 0:
            return np.empty((n, 0))
        z, R = detections.positions, detections.covariances
        costs = imm_kernel.costs(*self._modes, z, R, p.gate)
        variance = 0.5 * (R[:, 0, 0] + R[:, 1, 1])
        for i, o in enumerate(self._objects):
            if (cloud := o.particles) is not None:
                radius = o.search_radius(time, self._modes.at(i), p)
                lost = o.last_seen, radius, p.uniform_probability
                kernel = z, variance, p.position_jitter
                lost_costs = particle_kernel.costs(cloud.positions, cloud.weights, *kernel, *lost)
                costs[i] = np.minimum(costs[i], lost_costs)
        costs += np.where(self._on_free_floor, self._intruder_cost, self._birth_cost)
        for i, j in np.argwhere(costs < 0.0).tolist():
            if self._objects[i].label != detections.observations[j].label:
                costs[i, j] = inf
        return costs

    def _correct(
        self, time: float, rows: Indices, columns: Indices, detections: Detections
    ) -> None:
        """Update filter, motion class and radius of the detected tracks."""
        if len(rows) == 0:
            return
        p, modes = self._parameters, self._modes
        pairs = list(zip(rows.tolist(), columns.tolist(), strict=True))
        objects = [self._objects[row] for row, _ in pairs]
        z, raw = detections.positions[columns], detections.covariances[columns]
        for i, (o, (_, column)) in enumerate(zip(objects, pairs, strict=True)):
            if o.radius_sigma < detections.radius_sigmas[column]:
                z[i], raw[i] = detections.given_radius(column, o.radius, o.radius_sigma)
        inflation = [variance_inflation(time - o.last_time, p.correlation_time) for o in objects]
        R = raw * np.array(inflation)[:, None, None]
        nis = imm_kernel.nis(modes.states, modes.covariances, rows, z, raw)
        for i in np.flatnonzero(nis > p.gate).tolist():
            # Assigned through the particles, outside the gate of all modes: reset the filters.
            old = modes.at(pairs[i][0])
            reset = imm.initial(z[i], raw[i], max(float(old.moving), 0.5), p)
            for part, value in zip(old, reset, strict=True):
                part[:] = value
        imm_kernel.update(*modes, rows, z, R, p.max_log_ratio)
        for i, (o, (row, column)) in enumerate(zip(objects, pairs, strict=True)):
            self._fuse_radius(o, detections.observations[column], inflation[i])
            o.hits += 1
            o.misses = 0
            o.unseen_time = 0.0
            o.last_time = time
            o.last_seen, o.reach_at_detection = z[i], reach_of(raw[i], p)
            if np.trace(raw[i]) < np.trace(self._best[row]):
                self._best[row] = raw[i]
            o.particles = None
            o.existence = 1.0
            o.classify(modes.at(row), p)

    def _fuse_radius(self, o: TrackedObject, observation: Observation, inflation: float) -> None:
        """Fuse the radius, unless a partly visible obstacle gives hardly any information."""
        p = self._parameters
        partial = observation.cut or observation.occluded
        if partial and observation.radius_sigma > p.max_radius_sigma:
            return
        measured = observation.radius_sigma**2 * inflation
        prior = o.radius_sigma**2
        gain = prior / (prior + measured)
        o.radius += gain * (observation.radius - o.radius)
        o.radius_sigma = max(((1.0 - gain) * prior) ** 0.5, p.min_radius_sigma)

    def _begin(self, time: float, columns: list[int], detections: Detections) -> None:
        """Start a tentative track at each unassigned detection."""
        p = self._parameters
        positions, modes, covariances = list(self._positions), [], []
        for j in columns:
            z, R = detections.positions[j], detections.covariances[j]
            observation = detections.observations[j]
            if observation.distance > p.birth_range:
                continue
            reach = p.merge_fraction * observation.radius
            if any(
                o.label == observation.label
                and o.last_time == time
                and _within(position - z, reach + p.merge_fraction * o.radius)
                for o, position in zip(self._objects, positions, strict=True)
            ):
                continue
            intruder = self._on_free_floor[j]
            moving = p.intruder_moving_probability if intruder else p.birth_moving_probability
            self._objects.append(
                TrackedObject(
                    id=self._next_id,
                    label=observation.label,
                    radius=observation.radius,
                    radius_sigma=max(observation.radius_sigma, p.min_radius_sigma),
                    first_time=time,
                    last_time=time,
                    last_seen=z,
                    reach_at_detection=reach_of(R, p),
                )
            )
            self._next_id += 1
            positions.append(z)
            modes.append(imm.initial(z, R, moving, p))
            covariances.append(R)
        if modes:
            self._modes = self._modes.append(modes)
            self._best = np.concatenate([self._best, np.array(covariances)])
            self._update_positions()

    def _handle_misses(
        self, time: float, dt: float, detections: Detections, viewpoint: Viewpoint
    ) -> None:
        """Count missed detections, spawn and weigh particles, delete tracks."""
        objects = self._objects
        if all(o.last_time == time for o in objects):
            return
        clouds = [o.particles.positions for o in objects if o.particles is not None]
        points = np.concatenate([self._positions, *clouds])
        expected = self._in_clear_view(points, detections, viewpoint)
        start = len(objects)
        deleted = set()
        for row, o in enumerate(objects):
            mask = expected[row : row + 1]
            if o.particles is not None:
                mask = expected[start : start + len(o.particles.weights)]
                start += len(mask)
            if o.last_time < time and not self._survives(row, time, dt, mask):
                deleted.add(o.id)
        self._delete(deleted)
        self._redistribute(time, detections, viewpoint)

    def _in_clear_view(self, points: Array, detections: Detections, viewpoint: Viewpoint) -> Mask:
        p = self._parameters
        radii = [o.radius for o in compress(self._objects, self._static)]
        return viewpoint.in_clear_view(
            points,
            np.concatenate([detections.positions, self._positions[self._static]]),
            np.concatenate([detections.radii, radii]),
            margin=p.view_margin,
            occlusion_margin=p.occlusion_margin,
        )

    def _survives(self, row: int, time: float, dt: float, expected: Mask) -> bool:
        """Handle a frame without detection; return whether the track is kept."""
        p, o = self._parameters, self._objects[row]
        age = time - o.last_time
        if o.hits < p.birth_hits:
            return age <= p.birth_time
        if o.motion is Motion.STATIC:
            o.unseen_time = o.unseen_time + dt if expected[0] else 0.0
            if o.unseen_time >= p.miss_time:
                o.unseen_time = 0.0
                o.misses += 1
            return o.misses < p.max_misses
        if age > (p.forget_time if o.hits >= p.min_moving_hits else p.tentative_time):
            return False
        if o.particles is None:
            if age > p.lost_time:
                o.particles = track_particles.spawn(self._modes.at(row), p.particles, self._rng)
            return True
        survival = (1.0 - p.detection_probability) ** (dt / p.detection_time)
        cloud, likelihood = track_particles.refute(o.particles, expected, survival)
        o.existence *= likelihood
        o.particles = track_particles.resample(cloud, p, self._rng)
        return True

    def _redistribute(self, time: float, detections: Detections, viewpoint: Viewpoint) -> None:
        """Redistribute refuted particles over the reachable area out of view."""
        p = self._parameters
        deleted = set()
        for row, o in enumerate(self._objects):
            if o.particles is None or o.existence >= p.min_existence:
                continue
            if o.motion is Motion.UNKNOWN:
                # Most likely a false detection: it neither moved nor is at its position.
                deleted.add(o.id)
                continue
            modes = self._modes.at(row)
            velocity = imm_kernel.moments(*modes)[0][2:4]
            radius = o.search_radius(time, modes, p)
            cloud = track_particles.redistribute(o.last_seen, radius, velocity, p, self._rng)
            hidden = np.flatnonzero(~self._in_clear_view(cloud.positions, detections, viewpoint))
            o.existence = 1.0
            if len(hidden) < p.particles:
                deleted.add(o.id)
            else:
                o.particles = track_particles.select(cloud, hidden[: p.particles])
        self._delete(deleted)

    def _merge(self, time: float) -> None:
        """Delete one of two tracks of a colour whose discs overlap too much."""
        p = self._parameters
        reach = p.merge_fraction * np.array([o.radius for o in self._objects], float)
        deleted: set[int] = set()
        for i, j in overlapping(self._positions, reach).tolist():
            a, b = self._objects[i], self._objects[j]
            if a.particles is not None or b.particles is not None:
                continue
            if a.label != b.label or deleted & {a.id, b.id}:
                continue
            if a.last_time == time and b.last_time == time:
                continue
            worse = min(a, b, key=lambda o: (o.hits >= p.birth_hits, o.last_time, o.hits))
            deleted.add(worse.id)
        self._delete(deleted)

    def _delete(self, ids: set[int]) -> None:
        if not ids:
            return
        kept = np.array([o.id not in ids for o in self._objects])
        self._objects = list(compress(self._objects, kept))
        self._modes, self._best = self._modes.at(kept), self._best[kept]
        self._static, self._positions = self._static[kept], self._positions[kept]

    def _update_positions(self) -> None:
        static = Motion.STATIC
        self._static = np.array([o.motion is static for o in self._objects], np.bool_)
        self._positions = imm_kernel.positions(
            self._modes.weights, self._modes.states, self._static
        )

    def _published(self, time: float) -> tuple[Track, ...]:
        """Return the confirmed tracks as of `time` [s]."""
        p = self._parameters
        *moments, turn_rates = imm_kernel.estimates(
            *self._modes, self._static, self._best, p.bias_fraction**2, p.static_velocity_sigma**2
        )
        estimates = zip(*moments, turn_rates.tolist(), strict=True)
        return tuple(
            o.track(time, p, estimate)
            for o, estimate in zip(self._objects, estimates, strict=True)
            if o.hits >= p.birth_hits
        )


def _within(offset: Array, reach: float) -> bool:
    """Return whether an offset (2,) is shorter than `reach` [m]."""
    x, y = offset.tolist()
    return bool(x * x + y * y < reach * reach)
