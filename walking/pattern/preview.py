"""Gains of Kajita's preview control, with the change of the ZMP per tick as input.

Kajita et al., ICRA 2003. With the state z = (x, x', p) the cart-table is
z⁺ = A z + B u, p⁺ = p + u, discretized exactly; the cost is Σ (p - p_ref)² + R u².
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_discrete_are

from walking.parameters import CONTROL_PERIOD, PatternParameters
from walking.pattern.lipm import Lipm


@dataclass(frozen=True)
class PreviewGains:
    """Gains of u = -K z + Σ_j f_j p_ref(j ticks ahead), u the change of the ZMP [m].

    Attributes:
        position, velocity, zmp: the row K.
        sums: F_n = Σ_{j ≤ n} f_j for n = 0 … N.
        moments: Σ_{j ≤ n} j f_j for n = 0 … N.
        total: Σ of all f_j to infinity: gain of a constant reference.
    """

    position: float
    velocity: float
    zmp: float
    sums: tuple[float, ...]
    moments: tuple[float, ...]
    total: float


def preview_gains(lipm: Lipm, parameters: PatternParameters) -> PreviewGains:
    """Solve the linear-quadratic regulator."""
    columns = [lipm.step(1.0, 0.0, 0.0), lipm.step(0.0, 1.0, 0.0), lipm.step(0.0, 0.0, 1.0)]
    A = np.eye(3)
    A[:2] = np.array(columns).T
    B = np.array([[A[0, 2]], [A[1, 2]], [1.0]])
    C = np.array([[0.0, 0.0, 1.0]])
    R = np.array([[parameters.preview_weight]])
    P = solve_discrete_are(A, B, C.T @ C, R)
    scale = R + B.T @ P @ B
    K = np.linalg.solve(scale, B.T @ P @ A)
    closed = (A - B @ K).T
    horizon = round(parameters.preview_time / CONTROL_PERIOD)
    f = np.empty(horizon)
    costate = C.T
    for j in range(horizon):
        f[j] = np.linalg.solve(scale, B.T @ costate).item()
        costate = closed @ costate
    k_position, k_velocity, k_zmp = K[0].tolist()
    return PreviewGains(
        position=k_position,
        velocity=k_velocity,
        zmp=k_zmp,
        sums=tuple(np.concatenate([[0.0], np.cumsum(f)]).tolist()),
        moments=tuple(np.concatenate([[0.0], np.cumsum(f * np.arange(1, horizon + 1))]).tolist()),
        total=k_position + k_zmp,
    )
