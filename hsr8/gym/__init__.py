"""Gymnasium environments in which a policy decides gaze, motion or both; extra ``gym``.

    import hsr8  # before NumPy
    import gymnasium

    env = gymnasium.make("hsr8.gym:hsr8/Gaze-v0", scenario="crowd")

`as_gaze` and `as_planner` turn a policy into a plugin for ``hsr8 run``, ``sweep`` and ``bench``,
see ``docs/gym.md``.
"""

try:
    import gymnasium
except ImportError as error:
    raise ImportError(f"hsr8.gym: {error}; pip install -e '.[gym]' in the checkout") from error

from hsr8.gym.environment import Environment
from hsr8.gym.policy import as_gaze, as_planner

__all__ = ["Environment", "as_gaze", "as_planner"]

for _name, _decides in (
    ("Gaze", ("gaze",)),
    ("Navigate", ("motion",)),
    ("GazeAndNavigate", ("motion", "gaze")),
):
    gymnasium.register(
        f"hsr8/{_name}-v0",
        entry_point="hsr8.gym.environment:Environment",
        kwargs={"decides": _decides},
        disable_env_checker=True,  # after a failed first reset, it refuses every step
    )
