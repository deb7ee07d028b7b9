"""A 2-D stand-in for the head camera: a noisy detector of cylinders."""

from math import asin, atan2, cos, hypot, pi, sin, sqrt
from typing import Literal

from navigation.angles import wrap
from navigation.observation import CameraView, Observation

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Kind = Literal["obstacle", "beacon"]

Thing = tuple[Kind, str, Array, float]
"""Kind, label, position in W [m] and radius [m]."""

COLORS = ("red", "green", "blue", "violet")
CAMERA_HEIGHT = 0.47
HFOV, VFOV = 1.50, 1.22
FOCAL = 171.0
RANGE, BEACON_RANGE = 2.5, 5.0
PITCH_SIGMA, YAW_SIGMA = 0.009, 0.006
FRAME = 0.06


class Smooth:
    """First-order Gauss-Markov error."""

    def __init__(self, sigma: float, tau: float, rng: np.random.Generator) -> None:
        self.sigma, self.tau, self.rng = sigma, tau, rng
        self.value = sigma * float(rng.standard_normal())

    def step(self, dt: float) -> float:
        """Advance and return the error."""
        a = float(np.exp(-dt / self.tau))
        self.value = a * self.value + self.sigma * sqrt(1 - a * a) * float(
            self.rng.standard_normal()
        )
        return self.value


class Camera:
    """Noisy detector: what one frame of a walking robot's head camera yields."""

    def __init__(self, rng: np.random.Generator, hfov: float = HFOV, period: float = FRAME) -> None:
        self.rng = rng
        self.period = period
        self.hfov = hfov
        self.pitch = Smooth(0.006, 0.15, rng)
        self.pitch_bias = 0.002 * float(rng.standard_normal())
        self.yaw = Smooth(0.004, 0.15, rng)
        self.sway_phase = float(rng.uniform(0, 2 * pi))
        self.size: dict[int, Smooth] = {}

    def observe(
        self, time: float, pose: Array, pan: float, objects: list[Thing]
    ) -> tuple[Observation, ...]:
        """Observations of `objects` (kind, label, position, radius) from a true pose."""
        rng = self.rng
        dt = self.period
        pitch = self.pitch.step(dt) + self.pitch_bias
        pitch += 0.006 * sin(2 * pi * 1.5 * time + self.sway_phase)
        yaw = self.yaw.step(dt)
        polar: list[tuple[int, Kind, str, float, float, float]] = []
        for i, (kind, label, p, radius) in enumerate(objects):
            dx, dy = p[0] - pose[0], p[1] - pose[1]
            d = hypot(dx, dy)
            polar.append((i, kind, label, d, wrap(atan2(dy, dx) - pose[2]), radius))
        observations = []
        for i, kind, label, d, b, radius in polar:
            own = self.size.setdefault(i, Smooth(1.0, 0.1, rng)).step(dt)
            half = asin(min(0.9, radius / d))
            off = abs(wrap(b - pan)) - 0.5 * self.hfov
            if d > (RANGE if kind == "obstacle" else BEACON_RANGE) or d < 0.2 or off > 0.5 * half:
                continue
            hidden = max(
                (
                    min(1.0, (half + asin(min(0.9, r2 / d2)) - abs(wrap(b - b2))) / (2 * half))
                    for j, k2, _, d2, b2, r2 in polar
                    if j != i and d2 < d and k2 == "obstacle"
                ),
                default=0.0,
            )
            # A beacon is twice as tall and shows above whatever stands before it.
            if (kind == "obstacle" and hidden > 0.7) or rng.random() > 0.97:
                continue
            cut = off > -half
            occluded = hidden > 0.05 and kind == "obstacle"
            worse = (3.0 if cut else 1.0) * (1.5 if occluded else 1.0)
            ground_gain = (CAMERA_HEIGHT**2 + d * d) / CAMERA_HEIGHT
            size_sigma = 0.4 * worse * d * d / (FOCAL * radius) + 0.003
            ground_sigma = ground_gain * PITCH_SIGMA * worse + 0.003
            weight = size_sigma**2 / (size_sigma**2 + ground_sigma**2)
            error = weight * ground_gain * pitch * worse + (1 - weight) * size_sigma * own
            variance = 1.0 / (1.0 / size_sigma**2 + 1.0 / ground_sigma**2)
            bearing_sigma = sqrt(YAW_SIGMA**2 + (0.002 * worse) ** 2)
            bias = 0.5 * (off + half) if cut else 0.0
            bearing = b + yaw + 0.002 * worse * float(rng.standard_normal())
            bearing -= bias * (1.0 if wrap(b - pan) > 0 else -1.0)
            if cut:
                bearing_sigma = hypot(bearing_sigma, half)
            radius_sigma = worse * (0.05 * radius + 0.4 * d / FOCAL)
            observations.append(
                Observation(
                    kind=kind,
                    label=label,
                    distance=max(0.1, d + error),
                    bearing=bearing,
                    covariance=np.diag([variance, bearing_sigma**2]),
                    radius=max(0.02, radius + radius_sigma * own),
                    radius_sigma=radius_sigma,
                    cut=cut,
                    occluded=occluded,
                )
            )
        if rng.random() < 0.005:
            observations.append(
                Observation(
                    "obstacle",
                    COLORS[int(rng.integers(4))],
                    float(rng.uniform(0.4, RANGE)),
                    pan + float(rng.uniform(-0.7, 0.7)),
                    np.diag([0.01, 1e-4]),
                    0.08,
                    0.03,
                )
            )
        return tuple(observations)


def view(pan: float, tilt: float, hfov: float = HFOV) -> CameraView:
    """Camera at a pan and tilt."""
    cp, sp, ct, st = cos(pan), sin(pan), cos(tilt), sin(tilt)
    forward = np.array([cp * ct, sp * ct, st])
    right = np.array([sp, -cp, 0.0])
    down = np.cross(forward, right)
    rotation = np.stack([right, down, forward], axis=1)
    return CameraView(rotation, np.array([0.0, 0.0, CAMERA_HEIGHT]), pan, tilt, hfov, VFOV)
