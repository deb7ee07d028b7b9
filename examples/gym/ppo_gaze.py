"""Learned gaze: PPO on two cores, then a comparison on held-out seeds; extra hsr8[train].

python examples/gym/ppo_gaze.py
"""

import multiprocessing
import pickle
import time
from pathlib import Path

import hsr8
import hsr8.gym

import gymnasium
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import SubprocVecEnv, VecNormalize

SETTINGS = ["robot.body=kinematic", "camera.source=analytic"]
MINUTES, SEEDS = 20.0, 30  # of training, and of the comparison
MODEL, SCALES = "gaze.zip", Path("gaze_scales.pkl")
KEYS = ["head", "pose_std", "target", "velocity", "tracks"]
NOISE = {"use_sde": True, "sde_sample_freq": 8, "policy_kwargs": {"log_std_init": -1.5}}


def make():
    """Return an environment."""
    return gymnasium.make("hsr8.gym:hsr8/Gaze-v0", scenario="crowd", settings=SETTINGS)


def load():
    """Return the learned policy."""
    model, scales = PPO.load(MODEL, device="cpu"), pickle.loads(SCALES.read_bytes())
    return lambda obs: model.predict(scales.normalize_obs(obs), deterministic=True)[0]


Learned = hsr8.gym.as_gaze(load)


def evaluate(mode, seed):
    """Return the metrics of one run."""
    settings = SETTINGS if mode == "learned" else [*SETTINGS, f"navigation.gaze.mode={mode}"]
    gaze = Learned() if mode == "learned" else None
    return hsr8.run("crowd", seed=seed, settings=settings, gaze=gaze).metrics


if __name__ == "__main__":
    envs = VecNormalize(SubprocVecEnv([make] * 2, "forkserver"), norm_obs_keys=KEYS)
    model = PPO("MultiInputPolicy", envs, n_steps=1024, batch_size=256, seed=1, **NOISE)
    end = time.time() + 60.0 * MINUTES
    model.learn(10_000_000, callback=lambda *_: time.time() < end)
    model.save(MODEL)
    envs.save(SCALES)
    envs.close()
    print(f"{model.num_timesteps} decisions; seeds 0 to {SEEDS - 1}, not in the training:")
    with multiprocessing.get_context("forkserver").Pool(2) as pool:
        for mode in ("fixed", "risk", "learned"):
            runs = pool.starmap(evaluate, [(mode, seed) for seed in range(SEEDS)])
            success, hits = (sum(run[key] for run in runs) for key in ("success", "collisions"))
            print(f"{mode:8} success {success}/{len(runs)}, {hits} collisions", flush=True)
