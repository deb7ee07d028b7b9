"""Obstacle tracks: who is who, where, how fast, and whether it moves at all.

Every obstacle carries two Kalman filters, one that lets it move and one that does not;
the likelihoods of their innovations decide between static and moving. A track that may
move and is out of sight becomes a cloud of particles. Nothing but colour tells two
obstacles apart, so identity is decided by position alone.
"""

from math import exp, inf, log, log1p, pi

import numpy as np
from numpy.typing import NDArray

from navigation import track_filter, track_particles
from navigation.association import assign
from navigation.belief import Motion, Track
from navigation.belief_parameters import TrackingParameters
from navigation.correlated_noise import variance_inflation
from navigation.observation import Observation
from navigation.resighting import found_again, resight_mover
from navigation.sightings import Sightings
from navigation.tracked_object import TrackedObject
from navigation.turning import accumulated_lag, perhaps_turned
from navigation.visibility import Mask, Viewpoint

Array = NDArray[np.float64]

REFUTED = 0.05
"""Probability of a cloud given what was not seen, below which it is refuted."""

SCATTER = 4
"""Places tried per particle of a refuted cloud; it ends if three of four are in view."""


def _log_sigmoid(a: float) -> float:
    """Logarithm of 1/(1 + exp(-a))."""
    return -log1p(exp(-a)) if a > 0.0 else a - log1p(exp(a))


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
        self._time: float | None = None
        self._next_id = 1

    def update(self, time: float, seen: Sightings, viewpoint: Viewpoint) -> tuple[Track, ...]:
        """Take in one frame and return the tracks, by id.

        Args:
            time: of the frame [s].
            seen: its obstacles in W.
            viewpoint: its camera in W, with the range within which detection is sure.
        """
        dt = 0.0 if self._time is None else time - self._time
        self._time = time
        if self._objects and dt > 0.0:
            self._predict(dt)
        pairs = assign(self._costs(seen))
        self._correct(time, [(self._objects[row], column) for row, column in pairs], seen)
        taken = {column for _, column in pairs}
        self._begin(time, [j for j in range(len(seen.radii)) if j not in taken], seen)
        self._doubt(time, dt, seen, viewpoint)
        self._merge(time)
        return tuple(o.track(time) for o in self._objects if o.hits >= self._parameters.birth_hits)

    def clear(self) -> None:
        """Forget all tracks, for instance because the robot was carried away."""
        self._objects.clear()

    def _predict(self, dt: float) -> None:
        p = self._parameters
        state, covariance = track_filter.predict_moving(
            np.stack([o.state for o in self._objects]),
            np.stack([o.covariance for o in self._objects]),
            dt,
            p.acceleration_noise,
        )
        spread = p.static_diffusion * dt * np.eye(2)
        for i, o in enumerate(self._objects):
            o.state, o.covariance = state[i], covariance[i]
            o.still_covariance = o.still_covariance + spread
            if o.particles is not None:
                o.particles = track_particles.advance(o.particles, dt, p.reversal_rate, self._rng)

    def _costs(self, seen: Sightings) -> Array:
        """Cost of every track with every sighting against the sighting being new (n, m).

        The better of the two filters counts, each weighted with how probable its model
        is; a lost track is a cloud of particles.
        """
        p = self._parameters
        n, m = len(self._objects), len(seen.radii)
        if n == 0 or m == 0:
            return np.empty((n, m))
        objects = self._objects
        z, R = seen.positions[None], seen.covariances[None]
        moving = track_filter.innovation(
            np.stack([o.state[:2] for o in objects])[:, None],
            np.stack([o.covariance[:2, :2] for o in objects])[:, None],
            z,
            R,
        )
        still = track_filter.innovation(
            np.stack([o.still for o in objects])[:, None],
            np.stack([o.still_covariance for o in objects])[:, None],
            z,
            R,
        )
        evidence = [o.evidence for o in objects]
        moves = np.array([_log_sigmoid(e) for e in evidence])[:, None]
        stands = np.array([_log_sigmoid(-e) for e in evidence])[:, None]
        costs = np.minimum(
            np.where(moving.distance < p.gate, moving.distance + moving.log_det - 2 * moves, inf),
            np.where(still.distance < p.gate, still.distance + still.log_det - 2 * stands, inf),
        )
        width = 0.5 * (seen.covariances[:, 0, 0] + seen.covariances[:, 1, 1])
        width += 4.0 * track_particles.POSITION_JITTER**2
        for i, o in enumerate(objects):
            if o.particles is not None:
                cloud = -2.0 * track_particles.log_density(o.particles, seen.positions, width)
                costs[i] = np.minimum(costs[i], cloud)
        same = np.array([[o.label == s.label for s in seen.observations] for o in objects])
        new = -2.0 * log(2.0 * pi * p.birth_density)
        return np.where(same, costs - new, inf)

    def _correct(
        self, time: float, pairs: list[tuple[TrackedObject, int]], seen: Sightings
    ) -> None:
        """Update the filters, evidence and radius of the tracks that were detected."""
        if not pairs:
            return
        p = self._parameters
        objects = [o for o, _ in pairs]
        columns = [column for _, column in pairs]
        z, raw = seen.positions[columns], seen.covariances[columns]
        inflation = [variance_inflation(time - o.last_time, p.correlation_time) for o in objects]
        R = raw * np.array(inflation)[:, None, None]
        x = np.stack([o.state for o in objects])
        P = np.stack([o.covariance for o in objects])
        s = np.stack([o.still for o in objects])
        S = np.stack([o.still_covariance for o in objects])
        surprise = track_filter.innovation(x[:, :2], P[:, :2, :2], z, raw).distance
        doubt = track_filter.innovation(s, S, z, raw).distance
        for i, o in enumerate(objects):
            gap = time - o.last_time
            if o.motion is Motion.MOVING and gap > p.lost_time:
                x[i], P[i] = resight_mover(x[i], P[i], (o.last_seen, gap), (z[i], raw[i]), p)
            elif surprise[i] > p.manoeuvre_gate and o.motion is not Motion.STATIC:
                if gap > p.lost_time:
                    x[i], P[i] = found_again(z[i], raw[i], np.zeros(2), p.resighting_sigma)
                else:
                    P[i, 2:, 2:] += p.manoeuvre_sigma**2 * np.eye(2)
            P[i] = self._turning(o, time, x[i], P[i], (z[i], R[i]))
        moving = track_filter.innovation(x[:, :2], P[:, :2, :2], z, R)
        still = track_filter.innovation(s, S, z, R)
        gain = moving.log_likelihood - still.log_likelihood
        x, P = track_filter.update(x, P, R, moving)
        s_new, S_new = track_filter.update(s, S, R, still)
        for i, o in enumerate(objects):
            o.state, o.covariance = x[i], P[i]
            if doubt[i] > p.gate:
                # It is not there any more: the static hypothesis starts again here.
                o.still, o.still_covariance = x[i, :2].copy(), P[i, :2, :2].copy()
            else:
                o.still, o.still_covariance = s_new[i], S_new[i]
            observation = seen.observations[columns[i]]
            if not observation.cut:
                step = min(max(float(gain[i]), -p.evidence_limit), p.evidence_limit)
                o.evidence = min(max(o.evidence + step, p.evidence_floor), p.evidence_ceiling)
            self._widen(o, observation, inflation[i])
            o.hits += 1
            o.misses = 0
            o.expected_for = 0.0
            o.last_time = time
            o.last_seen = z[i].copy()
            o.particles = None
            o.presence = 1.0
            o.classify(p)

    def _turning(
        self, o: TrackedObject, time: float, x: Array, P: Array, sighting: tuple[Array, Array]
    ) -> Array:
        """Covariance before an update; wider if a mover in view has perhaps turned back."""
        p = self._parameters
        z, R = sighting
        in_view = time - o.last_time <= p.lost_time
        if in_view and o.motion is Motion.MOVING and o.speed > p.moving_speed:
            o.lag = accumulated_lag(o.lag, z - x[:2], P[:2, :2] + R, x[2:])
        else:
            o.lag = 0.0
        if o.lag > p.turning_lag:
            P = perhaps_turned(x, P, time - o.on_course)
            o.lag = 0.0
        if o.lag == 0.0:
            o.on_course = time
        return P

    def _widen(self, o: TrackedObject, observation: Observation, inflation: float) -> None:
        """Fuse the radius, unless only part of the obstacle was seen."""
        if observation.cut or observation.occluded:
            return
        measured = observation.radius_sigma**2 * inflation
        prior = o.radius_sigma**2
        gain = prior / (prior + measured)
        o.radius += gain * (observation.radius - o.radius)
        o.radius_sigma = max(((1.0 - gain) * prior) ** 0.5, self._parameters.radius_limit)

    def _begin(self, time: float, columns: list[int], seen: Sightings) -> None:
        """Start a tentative track at each sighting that no track explains."""
        p = self._parameters
        for j in columns:
            z, R, observation = seen.positions[j], seen.covariances[j], seen.observations[j]
            reach = p.overlap * observation.radius
            if any(
                o.label == observation.label
                and o.last_time == time
                and float(np.hypot(*(o.position - z))) < reach + p.overlap * o.radius
                for o in self._objects
            ):
                continue
            covariance = np.zeros((4, 4))
            covariance[:2, :2] = R
            covariance[2, 2] = covariance[3, 3] = p.velocity_sigma**2
            self._objects.append(
                TrackedObject(
                    id=self._next_id,
                    label=observation.label,
                    state=np.concatenate([z, np.zeros(2)]),
                    covariance=covariance,
                    still=z.copy(),
                    still_covariance=R.copy(),
                    radius=observation.radius,
                    radius_sigma=max(observation.radius_sigma, p.radius_limit),
                    first_time=time,
                    last_time=time,
                    last_seen=z.copy(),
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
        centres = np.concatenate([seen.positions, *(o.still[None] for o in standing)])
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
        if age > p.forget_time:
            return False
        if o.particles is None:
            if age > p.lost_time:
                still = (o.still, o.still_covariance) if o.motion is Motion.UNKNOWN else None
                o.particles = track_particles.spawn(
                    o.state, o.covariance, still, p.particles, self._rng
                )
            return True
        survival = (1.0 - p.detection_probability) ** (dt / p.refutation_time)
        cloud, left = track_particles.refute(o.particles, expected, survival)
        o.presence *= left
        o.particles = track_particles.resample(cloud, p.resample_share, self._rng)
        return True

    def _respread(self, time: float, seen: Sightings, viewpoint: Viewpoint) -> None:
        """Spread refuted clouds over what is out of view of all they could have reached."""
        p = self._parameters
        refuted = [o for o in self._objects if o.particles is not None and o.presence < REFUTED]
        ended = set()
        for o in refuted:
            reach = max(o.speed, p.moving_speed) * (time - o.last_time) + p.line_width
            cloud = track_particles.scatter(
                o.last_seen, reach, o.speed, SCATTER * p.particles, self._rng
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
        places = np.stack([o.position for o in objects])
        radii = np.array([o.radius for o in objects])
        apart = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1))
        close = np.argwhere(np.triu(apart < p.overlap * (radii[:, None] + radii), 1))
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
