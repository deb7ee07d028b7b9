"""Learned gaze: PPO for 20 minutes on two cores; extra `train`.

python examples/gym/ppo_gaze.py
"""

import time

import hsr8
import hsr8.gym

import gymnasium
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import SubprocVecEnv

MINUTES, MODEL = 20.0, "gaze.zip"
SETTINGS = ["robot.body=kinematic", "camera.source=analytic"]
OPTIONS = {"n_steps": 256, "batch_size": 128, "gamma": 0.98, "ent_coef": 0.01, "seed": 1}
LOOKS, HOLD = [(pan, -0.15) for pan in (-0.7, -0.35, 0.0, 0.35, 0.7)], 8  # frames per look


class Looks(gymnasium.Wrapper):
    """Choice among a few looks, each held for half a second: a head that turns is blind."""

    action_space = gymnasium.spaces.Discrete(len(LOOKS))

    def step(self, action):
        """Hold a look and add up the rewards."""
        steps = [self.env.step(LOOKS[action])]
        while len(steps) < HOLD and not any(steps[-1][2:4]):
            steps.append(self.env.step(LOOKS[action]))
        return steps[-1][0], sum(step[1] for step in steps), *steps[-1][2:]


def make():
    """Return an environment."""
    return Looks(gymnasium.make("hsr8.gym:hsr8/Gaze-v0", scenario="crowd", settings=SETTINGS))


def load():
    """Return the learned policy."""
    model, looks = PPO.load(MODEL, device="cpu"), []

    def act(observation):
        if not looks:
            looks.extend(HOLD * [LOOKS[model.predict(observation, deterministic=True)[0]]])
        return looks.pop()

    return act


Learned = hsr8.gym.as_gaze(load)

if __name__ == "__main__":
    envs = SubprocVecEnv([make] * 2, "forkserver")
    model, end = PPO("MultiInputPolicy", envs, **OPTIONS), time.time() + 60.0 * MINUTES
    model.learn(10_000_000, callback=lambda *_: time.time() < end).save(MODEL)
    print(f"{model.num_timesteps} decisions")
    envs.close()
