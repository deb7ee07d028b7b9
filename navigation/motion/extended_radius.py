"""Extended radius of obstacles, Yoo & Kim, eq. (7)."""

import numpy as np
from numpy.typing import NDArray

from navigation.belief.tracks import Tracks
from navigation.parameters.motion import UnivectorParameters

Array = NDArray[np.float64]


def extended_radius(
    obstacles: Tracks, psi_sf: float, psi_ob: Array, parameters: UnivectorParameters
) -> Array:
    """Return S_oe = S_r + S_o + omega (eta_vo |v_o| + eta_imp (psi_sf + psi_ob)), eq. (7).

    |v_o| is the speed over ground: a speed relative to the walking robot would inflate every
    static obstacle and close the gaps.

    Args:
        obstacles: n obstacles.
        psi_sf: eq. (2).
        psi_ob: eq. (3) of each (n,).
        parameters: radii and gains.

    Returns:
        (n,) [m].
    """
    inflation = parameters.eta_vo * obstacles.speed + parameters.eta_imp * (psi_sf + psi_ob)
    s_phys = physical_radius(obstacles, parameters)
    return s_phys + parameters.margin + parameters.omega_soe * inflation


def physical_radius(obstacles: Tracks, parameters: UnivectorParameters) -> Array:
    """Return S_phys = S_robot + S_o, the distance at which the bodies touch (n,) [m]."""
    return parameters.s_robot + obstacles.radius
