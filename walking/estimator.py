"""What the body really does: tilt of the trunk and error of the centre of mass."""

from dataclasses import dataclass
from math import cosh, sinh

import numpy as np
from scipy.linalg import solve_discrete_are

from walking.parameters import CONTROL_PERIOD, EstimatorParameters


class TiltFilter:
    """Complementary filter of roll and pitch.

    The gyro is integrated with the coupling that a yawing trunk has (a roll becomes a pitch
    as the body turns under it) and pulled towards the IMU's own attitude.

    Args:
        parameters: pull per tick.

    Attributes:
        roll, pitch: filtered tilt [rad].
    """

    def __init__(self, parameters: EstimatorParameters) -> None:
        self._gain = parameters.tilt_gain
        self._started = False
        self.roll = self.pitch = 0.0

    def update(self, roll: float, pitch: float, gyro: list[float]) -> None:
        """Take in the IMU's roll and pitch [rad] and the gyro [rad/s]."""
        if not self._started:
            self._started = True
            self.roll, self.pitch = roll, pitch
            return
        gx, gy, gz = gyro
        predicted_roll = self.roll + CONTROL_PERIOD * (gx + self.pitch * gz)
        predicted_pitch = self.pitch + CONTROL_PERIOD * (gy - self.roll * gz)
        self.roll = predicted_roll + self._gain * (roll - predicted_roll)
        self.pitch = predicted_pitch + self._gain * (pitch - predicted_pitch)


@dataclass(frozen=True, slots=True)
class SteadyGains:
    """Steady Kalman gains of the error filter.

    Attributes:
        position: correction of the position per innovation [1].
        velocity: correction of the velocity per innovation [1/s].
    """

    position: float
    velocity: float


def steady_gains(omega: float, parameters: EstimatorParameters) -> SteadyGains:
    """Gains of the filter e'' = ω² (e - d) + noise, e measured in every tick."""
    dt = CONTROL_PERIOD
    wh = omega * dt
    A = np.array([[cosh(wh), sinh(wh) / omega], [omega * sinh(wh), cosh(wh)]])
    G = np.array([[0.5 * dt * dt], [dt]]) * parameters.acceleration_noise
    C = np.array([[1.0, 0.0]])
    R = np.array([[parameters.position_noise**2]])
    # A little noise on the position itself keeps the Riccati equation well posed.
    Q = G @ G.T + np.diag([1e-12, 0.0])
    P = solve_discrete_are(A.T, C.T, Q, R)
    K = (P @ C.T / (C @ P @ C.T + R)).ravel().tolist()
    return SteadyGains(position=K[0], velocity=K[1])


class ErrorFilter:
    """Position and velocity of the difference between measured and planned mass centre.

    Args:
        omega: of the pendulum [1/s].
        parameters: noise levels.

    Attributes:
        x, y: error in the plan frame [m].
        vx, vy: its rate [m/s].
    """

    def __init__(self, omega: float, parameters: EstimatorParameters) -> None:
        self._omega2 = omega * omega
        gains = steady_gains(omega, parameters)
        self._kp, self._kv = gains.position, gains.velocity
        self.x = self.y = self.vx = self.vy = 0.0

    def shift(self, dx: float, dy: float) -> None:
        """The plan jumped by -dx, -dy under the body: no velocity in that [m]."""
        self.x += dx
        self.y += dy

    def update(
        self,
        measured: tuple[float, float],
        zmp_shift: tuple[float, float],
        slip: tuple[float, float],
    ) -> None:
        """One tick.

        Args:
            measured: error of the centre of mass [m].
            zmp_shift: by how much the ankles moved the ZMP [m].
            slip: velocity that a foot turning on the floor gives the body unseen by the
                encoders [m/s].
        """
        dt, w2 = CONTROL_PERIOD, self._omega2
        ax = w2 * (self.x - zmp_shift[0])
        ay = w2 * (self.y - zmp_shift[1])
        x = self.x + dt * (self.vx - slip[0] + 0.5 * dt * ax)
        y = self.y + dt * (self.vy - slip[1] + 0.5 * dt * ay)
        ix, iy = measured[0] - x, measured[1] - y
        self.x, self.vx = x + self._kp * ix, self.vx + dt * ax + self._kv * ix
        self.y, self.vy = y + self._kp * iy, self.vy + dt * ay + self._kv * iy


class TouchDown:
    """Decides that a swinging foot has met the floor.

    Args:
        parameters: force and duration.
    """

    def __init__(self, parameters: EstimatorParameters) -> None:
        self._force = parameters.contact_force
        self._ticks = parameters.contact_ticks
        self._phase = parameters.contact_phase
        self._count = 0

    def update(self, phase: float, force: float) -> bool:
        """Whether the foot is down at `phase` of its swing under `force` [N]."""
        self._count = self._count + 1 if phase >= self._phase and force > self._force else 0
        return self._count >= self._ticks
