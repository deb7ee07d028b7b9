"""Scripted policy for motion and gaze, in the environment and as plugins of ``hsr8 run``.

    python examples/gym/scripted.py
    hsr8 run quick --set plugin.planner=examples/gym/scripted.py:Planner \
        plugin.gaze=examples/gym/scripted.py:Gaze

Walks to the target and stops in front of obstacles; looks at the nearest obstacle.
"""

import hsr8
import hsr8.gym

import gymnasium
import numpy as np

SETTINGS = ["robot.body=kinematic", "camera.source=analytic"]
STOP = 0.45  # distance to an obstacle ahead [m]


def policy(observation):
    """Return vx, vy, wz, pan and tilt, each from -1 to 1."""
    x, y, _ = observation["target"]
    bearing = np.arctan2(y, x)
    tracks = observation["tracks"][observation["track_mask"] == 1]
    ahead = tracks[(np.abs(tracks[:, 1]) < 0.3) & (tracks[:, 0] > 0.0)]
    blocked = bool((np.hypot(*ahead[:, :2].T) < STOP).any())
    vx = 0.0 if blocked else max(0.0, np.cos(bearing))
    pan = np.arctan2(tracks[0, 1], tracks[0, 0]) if len(tracks) else bearing
    return np.clip([vx, 0.0, 2.0 * bearing, pan / (0.5 * np.pi), 0.0], -1.0, 1.0)


def load():
    """Return the policy of a run."""
    return policy


Planner, Gaze = hsr8.gym.as_planner(load), hsr8.gym.as_gaze(load)

if __name__ == "__main__":
    options = {"scenario": "quick", "settings": SETTINGS, "end_on_contact": False}
    env = gymnasium.make("hsr8.gym:hsr8/GazeAndNavigate-v0", **options)
    observation, info = env.reset(seed=4)
    ended = False
    while not ended:
        observation, _, terminated, truncated, info = env.step(policy(observation))
        ended = terminated or truncated
    native = hsr8.run("quick", seed=4, settings=SETTINGS, planner=Planner(), gaze=Gaze())
    same = info["metrics"]["state_hash"] == native.metrics["state_hash"]
    print(f"{info['exit_reason']}; the same run as hsr8.run: {same}")
