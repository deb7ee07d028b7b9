"""Scene of one frame: the inputs that gaze and motion planner share."""

import numpy as np
from numpy.typing import NDArray

from compilation.value import value
from navigation.belief.belief import Belief
from navigation.belief.tracks import Tracks, join
from navigation.decision import Task
from navigation.parameters.motion import UnivectorParameters
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import psi_obstacle, psi_self
from navigation.transform import velocity_in_world

Array = NDArray[np.float64]


@value
class Scene:
    """Belief, task and partial evaluations of one frame.

    Obstacles are the landmarks nearby, then the tracks of the belief.

    Attributes:
        belief: belief of the robot.
        task: task of the mission.
        look: direction in W that the body turns to for a fixed camera; None with a head [rad].
        body: velocity in force in R, vx, vy, wz (3,) [m/s, m/s, rad/s].
        obstacles: n obstacles in W.
        landmarks: number of landmarks at their beginning.
        psi_sf: eq. (2).
        psi_ob: eq. (3) of each obstacle (n,).
        s_oe: extended radius of each obstacle, eq. (7) (n,) [m].
    """

    belief: Belief
    task: Task
    look: float | None
    body: Array
    obstacles: Tracks
    landmarks: int
    psi_sf: float
    psi_ob: Array
    s_oe: Array

    @classmethod
    def of(
        cls,
        belief: Belief,
        task: Task,
        parameters: NavigationParameters,
        *,
        body: Array,
        landmarks: Tracks | None = None,
        look: float | None = None,
    ) -> "Scene":
        """Evaluate (2), (3) and (7) in the present belief.

        Args:
            belief: belief of the robot.
            task: task of the mission.
            parameters: parameters of the decisions.
            body: velocity in force in R (3,) [m/s, m/s, rad/s].
            landmarks: landmarks nearby, as static tracks.
            look: direction in W that the body turns to for a fixed camera, if any [rad].
        """
        obstacles = Tracks.of(belief.tracks)
        if landmarks is not None and len(landmarks):
            obstacles = join(landmarks, obstacles)
        psi_sf = psi_self(belief.pose_covariance, parameters.evaluation)
        velocity = velocity_in_world(belief.pose, body)
        psi_ob = psi_obstacle(obstacles, belief.pose[:2], velocity, parameters.evaluation)
        return cls(
            belief,
            task,
            look,
            body,
            obstacles,
            len(obstacles) - len(belief.tracks),
            psi_sf,
            psi_ob,
            extended_radius(obstacles, psi_sf, psi_ob, parameters.univector),
        )

    @property
    def velocity(self) -> Array:
        """Velocity of the robot in W (2,) [m/s]."""
        return velocity_in_world(self.belief.pose, self.body)


def extended_radius(
    obstacles: Tracks, psi_sf: float, psi_ob: Array, parameters: UnivectorParameters
) -> Array:
    """Return S_oe = S_r + S_o + eta_vo |v_o| + eta_imp (psi_sf + psi_ob), eq. (7) (n,) [m].

    |v_o| is the speed over ground: a speed relative to the walking robot would inflate every
    static obstacle and close the gaps.

    Args:
        obstacles: n obstacles.
        psi_sf: eq. (2).
        psi_ob: eq. (3) of each (n,).
        parameters: radii and gains; omega_soe is 1.
    """
    p = parameters
    inflation = p.eta_vo * obstacles.speed + p.eta_imp * (psi_sf + psi_ob)
    s_oe: Array = p.s_robot + p.margin + obstacles.radius + inflation
    return s_oe
