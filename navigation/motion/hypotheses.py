"""Collision hypotheses of the safety filter: tracks, particles of lost movers, reversals."""

from collections.abc import Sequence
from dataclasses import fields
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from navigation.belief.belief import Track
from navigation.motion.bend_kernel import mean_velocity
from navigation.obstacle_set import ObstacleSet
from navigation.parameters.motion import SafetyFilterParameters
from navigation.value import value

if TYPE_CHECKING:
    from navigation.belief.local_map import LocalMap

Array = NDArray[np.float64]


@value
class Hypotheses:
    """m discs at constant velocity.

    Attributes:
        position: in W (m, 2) [m].
        velocity: (m, 2) [m/s].
        radius: distance of the robot's centre that counts as a collision (m,) [m].
        horizon: maximum time to collision (m,) [s].
        weight: of the penalty (m,).
    """

    position: Array
    velocity: Array
    radius: Array
    horizon: Array
    weight: Array

    def __len__(self) -> int:
        return len(self.radius)

    def within_reach(self, position: Array, speed: float) -> "Hypotheses":
        """Return those a robot at `position` (2,) [m] can reach in time at `speed` [m/s]."""
        offset = self.position - position
        gap = np.hypot(offset[:, 0], offset[:, 1]) - self.radius
        reach = (np.hypot(self.velocity[:, 0], self.velocity[:, 1]) + speed) * self.horizon
        near = gap < reach
        return Hypotheses(*(getattr(self, f.name)[near] for f in fields(self)))


def collision_hypotheses(
    tracks: Sequence[Track],
    obstacles: ObstacleSet,
    s_robot: float,
    parameters: SafetyFilterParameters,
    local_map: "LocalMap",
) -> Hypotheses:
    """Build the hypotheses of all tracks.

    A lost mover counts as its particles; a visible one also as its reversal. A turning mover
    follows the chord of its arc over `bend_time`.

    Args:
        tracks: of the belief.
        obstacles: the tracks as arrays.
        s_robot: radius of the robot [m].
        parameters: horizons, weights and margins.
        local_map: ages of positions.
    """
    radius_sigma = np.array([t.radius_sigma for t in tracks], dtype=np.float64)
    base = s_robot + obstacles.radius + radius_sigma + parameters.margin
    inflated = base + np.minimum(parameters.max_sigma, obstacles.sigma)
    lost = np.array([t.particles is not None for t in tracks], dtype=np.bool_)
    known = ~lost
    static = obstacles.static[known]
    time = parameters.bend_time
    forward = mean_velocity(obstacles.velocity, obstacles.turn_rate, time)
    parts = [
        Hypotheses(
            obstacles.position[known],
            forward[known],
            np.where(static, base[known], inflated[known]),
            np.where(static, parameters.static_horizon, parameters.moving_horizon),
            np.ones(int(known.sum())),
        )
    ]
    reversing = known & obstacles.moving
    if parameters.reversal_weight > 0.0 and reversing.any():
        n = int(reversing.sum())
        backward = mean_velocity(obstacles.velocity, -obstacles.turn_rate, time)
        parts.append(
            Hypotheses(
                obstacles.position[reversing],
                -backward[reversing],
                inflated[reversing],
                np.full(n, parameters.reversal_horizon),
                np.full(n, parameters.reversal_weight),
            )
        )
    for index, track in enumerate(tracks):
        if track.particles is not None:
            cloud = track.particles
            n = len(cloud.weights)
            parts.append(
                Hypotheses(
                    cloud.positions,
                    mean_velocity(cloud.velocities, cloud.turn_rates, time),
                    np.full(n, base[index]),
                    np.full(n, parameters.moving_horizon),
                    parameters.particle_weight * cloud.weights,
                )
            )
    if parameters.reachable:
        parts.append(reachable_discs(tracks, obstacles, base, parameters, local_map))
    return Hypotheses(
        *(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(Hypotheses))
    )


def reachable_discs(
    tracks: Sequence[Track],
    obstacles: ObstacleSet,
    base: Array,
    parameters: SafetyFilterParameters,
    local_map: "LocalMap",
) -> Hypotheses:
    """Return the reachable sets of unseen movers, as static discs at their latest detections.

    A disc lasts until its centre is seen or it is too old.

    Args:
        tracks: of the belief.
        obstacles: the tracks as arrays.
        base: collision distances of visible tracks (n,) [m].
        parameters: growth and age.
        local_map: ages of positions.
    """
    p = parameters
    centre = np.array([t.last_seen for t in tracks], dtype=np.float64).reshape(-1, 2)
    unseen = obstacles.age - local_map.age_at(centre) < p.reachable_delay
    kept = obstacles.moving & (obstacles.age > p.reachable_delay) & unseen
    kept &= obstacles.age <= p.reachable_age
    grown = obstacles.speed * np.maximum(0.0, obstacles.age - p.reachable_delay)
    n = int(kept.sum())
    return Hypotheses(
        centre[kept],
        np.zeros((n, 2)),
        base[kept] + np.minimum(p.reachable_radius, grown[kept]),
        np.full(n, p.static_horizon),
        np.ones(n),
    )
