"""What the collision filter must not touch: tracks, particles of lost movers, reversals."""

from collections.abc import Sequence
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
    """m discs that may be where they say, moving at constant velocity.

    Attributes:
        position: in W (m, 2) [m].
        velocity: (m, 2) [m/s].
        radius: distance from the robot's centre at which they count as touched (m,) [m].
        horizon: time to contact below which they count (m,) [s].
        weight: of their penalty (m,).
    """

    position: Array
    velocity: Array
    radius: Array
    horizon: Array
    weight: Array

    def __len__(self) -> int:
        return len(self.radius)

    def within_reach(self, position: Array, speed: float) -> "Hypotheses":
        """Those a robot at `position` (2,) [m] could touch in time at up to `speed` [m/s]."""
        offset = self.position - position
        gap = np.hypot(offset[:, 0], offset[:, 1]) - self.radius
        reach = (np.hypot(self.velocity[:, 0], self.velocity[:, 1]) + speed) * self.horizon
        near = gap < reach
        return Hypotheses(
            self.position[near],
            self.velocity[near],
            self.radius[near],
            self.horizon[near],
            self.weight[near],
        )


def collision_hypotheses(
    tracks: Sequence[Track],
    obstacles: ObstacleSet,
    s_robot: float,
    parameters: SafetyFilterParameters,
    local_map: "LocalMap",
) -> Hypotheses:
    """Build the hypotheses of all tracks.

    A lost mover counts as its particles; a visible one also as its own reversal. What walks a
    bend counts as going straight along its chord over `bend_time`, as fast as it gets on there.

    Args:
        tracks: of the belief.
        obstacles: the same tracks as arrays.
        s_robot: radius of the robot [m].
        parameters: horizons, weights and margins.
        local_map: when a place was last looked at.
    """
    unsure = np.array([t.radius_sigma for t in tracks], dtype=np.float64)
    base = s_robot + obstacles.radius + unsure + parameters.margin
    swollen = base + np.minimum(parameters.max_sigma, obstacles.sigma)
    lost = np.array([t.particles is not None for t in tracks], dtype=np.bool_)
    seen = ~lost
    still = obstacles.static[seen]
    time = parameters.bend_time
    onward = mean_velocity(obstacles.velocity, obstacles.turn_rate, time)
    parts = [
        Hypotheses(
            obstacles.position[seen],
            onward[seen],
            np.where(still, base[seen], swollen[seen]),
            np.where(still, parameters.static_horizon, parameters.moving_horizon),
            np.ones(int(seen.sum())),
        )
    ]
    reversing = seen & obstacles.moving
    if parameters.reversal_weight > 0.0 and reversing.any():
        n = int(reversing.sum())
        backward = mean_velocity(obstacles.velocity, -obstacles.turn_rate, time)
        parts.append(
            Hypotheses(
                obstacles.position[reversing],
                -backward[reversing],
                swollen[reversing],
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
        np.concatenate([p.position for p in parts]),
        np.concatenate([p.velocity for p in parts]),
        np.concatenate([p.radius for p in parts]),
        np.concatenate([p.horizon for p in parts]),
        np.concatenate([p.weight for p in parts]),
    )


def reachable_discs(
    tracks: Sequence[Track],
    obstacles: ObstacleSet,
    base: Array,
    parameters: SafetyFilterParameters,
    local_map: "LocalMap",
) -> Hypotheses:
    """All that unseen movers can have reached, as still discs about where they were seen last.

    A disc lasts until its place is looked at or it is too old.

    Args:
        tracks: of the belief.
        obstacles: the same tracks as arrays.
        base: radii at which they count as touched when seen (n,) [m].
        parameters: growth and age.
        local_map: when a place was last looked at.
    """
    p = parameters
    place = np.array([t.last_seen for t in tracks], dtype=np.float64).reshape(-1, 2)
    unseen = obstacles.age - local_map.age_at(place) < p.reachable_delay
    kept = obstacles.moving & (obstacles.age > p.reachable_delay) & unseen
    kept &= obstacles.age <= p.reachable_age
    grown = obstacles.speed * np.maximum(0.0, obstacles.age - p.reachable_delay)
    n = int(kept.sum())
    return Hypotheses(
        place[kept],
        np.zeros((n, 2)),
        base[kept] + np.minimum(p.reachable_radius, grown[kept]),
        np.full(n, p.static_horizon),
        np.ones(n),
    )
