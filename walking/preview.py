"""Kajita's preview control, with the change of the ZMP per tick as input.

Kajita et al., ICRA 2003. With the state z = (x, x', p) the cart-table is
z⁺ = A z + B u, p⁺ = p + u, discretized exactly; the cost is Σ (p - p_ref)² + R u². The preview sum
over a piecewise-linear reference is closed form in running sums of the gains: the reference is not
sampled.
"""

from math import cosh, sinh
from typing import NamedTuple

import numpy as np
from scipy.linalg import solve_discrete_are

from compilation import compiled
from walking.arrays import Point
from walking.parameters import CONTROL_PERIOD, PatternParameters
from walking.pendulum import step_pendulum
from walking.records import PREVIEW_SUM, Record
from walking.support import Region


class PreviewGains(NamedTuple):
    """Gains of u = -K z + Σ_j f_j p_ref(j ticks ahead), u the change of the ZMP [m].

    Attributes:
        position, velocity, zmp: the row K.
        total: Σ of all f_j to infinity: gain of a constant reference.
        sums: running sums to n = 0 … N, see `PREVIEW_SUM` (N + 1,).
    """

    position: float
    velocity: float
    zmp: float
    total: float
    sums: Record


def preview_gains(omega: float, parameters: PatternParameters) -> PreviewGains:
    """Solve the linear-quadratic regulator for a pendulum with ω [1/s]."""
    wh = omega * CONTROL_PERIOD
    c, s = cosh(wh), sinh(wh)
    A = np.array([[c, 1.0 / omega * s, 1.0 - c], [omega * s, c, -omega * s], [0.0, 0.0, 1.0]])
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
    position, velocity, zmp = K[0].tolist()
    sums = np.zeros(horizon + 1, PREVIEW_SUM)
    sums["gain"][1:] = np.cumsum(f)
    sums["moment"][1:] = np.cumsum(f * np.arange(1, horizon + 1))
    return PreviewGains(position, velocity, zmp, position + zmp, sums)


@compiled
def advance_preview(
    pendulum: Record, ramps: Record, count: int, region: Region, robot: Record, sums: Record
) -> None:
    """Advance the pendulum by a tick along a reference.

    Args:
        pendulum: changed.
        ramps: reference.
        count: number of its ramps.
        region: admissible ZMP.
        robot: constants.
        sums: see `PreviewGains`.
    """
    p = pendulum
    ahead_x, ahead_y = preview_sum(ramps, count, robot, sums)
    px = p.zmp_x * (1.0 - robot.preview_zmp) + ahead_x
    py = p.zmp_y * (1.0 - robot.preview_zmp) + ahead_y
    px -= robot.preview_position * p.x + robot.preview_velocity * p.vx
    py -= robot.preview_position * p.y + robot.preview_velocity * p.vy
    step_pendulum(pendulum, robot, (px, py), region)


@compiled
def preview_sum(ramps: Record, count: int, robot: Record, sums: Record) -> Point:
    """Return Σ_j f_j p_ref(j) over the horizon, and with its last point beyond."""
    horizon = sums.shape[0] - 1
    x = y = 0.0
    begin, end_x, end_y = 0, ramps[count - 1].bx, ramps[count - 1].by
    for k in range(count):
        ramp = ramps[k]
        stop = min(begin + ramp.ticks, horizon)
        weight = sums[stop].gain - sums[begin].gain
        slope = (sums[stop].moment - sums[begin].moment - begin * weight) / ramp.ticks
        x += weight * ramp.ax + slope * (ramp.bx - ramp.ax)
        y += weight * ramp.ay + slope * (ramp.by - ramp.ay)
        begin = stop
        if stop == horizon:
            end_x, end_y = ramp.bx, ramp.by
            break
    rest = robot.preview_total - sums[begin].gain
    return x + rest * end_x, y + rest * end_y
