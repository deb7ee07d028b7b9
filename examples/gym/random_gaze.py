"""Random gaze: three runs, each in another world.

python examples/gym/random_gaze.py
"""

import hsr8  # noqa: F401  before NumPy: it selects the arithmetic

import gymnasium

SETTINGS = ["robot.body=kinematic", "camera.source=analytic"]

env = gymnasium.make("hsr8.gym:hsr8/Gaze-v0", scenario="quick", settings=SETTINGS)
env.action_space.seed(1)
env.reset(seed=1)
for _ in range(3):
    total, ended = 0.0, False
    while not ended:
        observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
        total += reward
        ended = terminated or truncated
    print(f"seed {info['seed']}: {info['exit_reason']}, reward {total:.1f}")
    env.reset()
env.close()
