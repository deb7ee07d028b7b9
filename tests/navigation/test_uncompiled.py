"""Navigation gives the same bits compiled and in plain Python, as used for debugging."""

import hashlib
import os
import subprocess
import sys
from math import cos, sin

import numpy as np

from navigation.belief.estimator import Estimator
from navigation.decision import SpeedLimits, Task
from navigation.gaze.planner import GazePlanner
from navigation.motion.planner import Planner
from navigation.motion.safety_filter import RolloutStart, SafetyFilter
from navigation.motion.velocity_mapping import Facing
from navigation.observation import CameraView, Frame, Sight
from navigation.parameters.belief import BeliefParameters
from navigation.parameters.navigation import NavigationParameters
from vision.detection import Detection

BEACONS = {"cyan/yellow": (2.4, 0.6), "yellow/magenta": (1.8, -0.9)}
MOVER_GONE = 0.5  # time from which the mover is out of view [s]


def camera(time):
    pan, tilt = 0.4 * sin(9.0 * time), -0.4
    cp, sp, ct, st = cos(pan), sin(pan), cos(tilt), sin(tilt)
    forward, right = np.array([cp * ct, sp * ct, st]), np.array([sp, -cp, 0.0])
    rotation = np.stack([right, np.cross(forward, right), forward], axis=1)
    sight = Sight(0.30, np.full(36, 0.1))
    return CameraView(
        rotation, np.array([0.02, 0.0, 0.47]), pan, tilt, 1.05, 0.82, 0.001, sight=sight
    )


def observation(pose, point, noise, kind="obstacle", label="red"):
    dx, dy = point[0] - pose[0], point[1] - pose[1]
    distance = (dx * dx + dy * dy) ** 0.5 + 0.005 * noise[0]
    bearing = float(np.arctan2(dy, dx)) - pose[2] + 0.002 * noise[1]
    return Detection(
        kind=kind,
        label=label,
        distance=distance,
        bearing=bearing,
        covariance=np.array([[3e-5, 1e-6], [1e-6, 4e-6]]),
        radius=0.08,
        radius_sigma=0.01,
        by_radius=np.array([0.3, 0.01]),
        cut=False,
        occluded=False,
        box=(0, 0, 0, 0),
    )


def journey():
    """Return a digest of beliefs and decisions of a short walk past a mover that gets lost."""
    rng, digest = np.random.default_rng(3), hashlib.sha256()
    p, limits = NavigationParameters(), SpeedLimits(0.20, 0.10, 0.08, 0.8, 0.3, 0.34)
    start = np.diag([4e-4, 4e-4, 4e-4])
    estimator = Estimator(BeliefParameters(), BEACONS, np.zeros(3), start, np.random.default_rng(1))
    planner, gaze = Planner(p, limits), GazePlanner(p, limits, BEACONS, (1.05, 0.82), (3.0, 40.0))
    task, motion = Task(np.array([2.0, 0.2]), 0.3, False, 0, False, False), None
    safety_filter = SafetyFilter(p.safety_filter, p.velocity_mapping, limits)
    for k in range(25):
        time = 0.06 * (k + 1)
        pose = (0.15 * time, 0.01 * sin(4.0 * time), 0.05 * sin(3.0 * time))
        seen = [
            observation(pose, point, rng.standard_normal(2), "beacon", name)
            for name, point in BEACONS.items()
        ]
        seen.append(observation(pose, (0.9, -0.3), rng.standard_normal(2)))
        seen.append(observation(pose, (1.2, -0.35), rng.standard_normal(2), label="blue"))
        if time < MOVER_GONE:
            mover = (0.8, 0.5 - 0.15 * time)
            seen.append(observation(pose, mover, rng.standard_normal(2), label="green"))
        motion_covariance = np.diag([4e-6, 4e-6, 1e-6])
        frame = Frame(time, np.array(pose), motion_covariance, camera(time), tuple(seen))
        belief = estimator.update(frame)
        parts = [belief.pose, belief.pose_covariance, belief.local_map.age]
        for track in belief.tracks:
            parts += [track.position, track.velocity, track.covariance, np.array(track.radius)]
            parts += [] if track.particles is None else [track.particles.positions]
        motion = planner.plan(belief, task)
        parts += [motion.velocity, np.array(motion.extended_radii)]
        rollout = RolloutStart(belief.pose, motion.velocity, motion.direction, Facing())
        parts += safety_filter.rollout(rollout, safety_filter.candidates(np.ones(2), 0.3))
        if k % 8 == 1:
            decision = gaze.choose(belief, task, motion)
            parts += [decision.gaze_map, np.array([decision.pan, decision.tilt, decision.psi_sf])]
        for part in parts:
            digest.update(np.ascontiguousarray(part).tobytes())
    lost = sum(track.particles is not None for track in belief.tracks)
    return f"{len(belief.tracks)} tracks, {lost} lost, {digest.hexdigest()}"


def test_plain_python_gives_the_same_bits_as_compiled_code():
    done = subprocess.run(
        [sys.executable, __file__],
        env=os.environ | {"NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
        check=False,
        timeout=100,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == journey()
    assert done.stdout.startswith("3 tracks, 1 lost")


if __name__ == "__main__":
    print(journey())
