"""Several environments, each in a process."""

from collections.abc import Mapping
from typing import Any

import gymnasium
from gymnasium.vector import AsyncVectorEnv

from hsr8.errors import UsageError

MODULE = "hsr8.gym:"
CONTEXTS = ("forkserver", "spawn")


def make_vec(
    name: str, n: int, *, vector_kwargs: Mapping[str, Any] | None = None, **settings: Any
) -> AsyncVectorEnv:
    """Return `n` environments in processes of the start method forkserver.

    Args:
        name: id of the environment, for example ``hsr8/Gaze-v0``.
        n: number of processes.
        vector_kwargs: of `gymnasium.vector.AsyncVectorEnv`.
        settings: of every environment, see `hsr8.gym.Environment`.

    Raises:
        UsageError: the start method is fork.
    """
    options = {"context": CONTEXTS[0], **(vector_kwargs or {})}
    if options["context"] not in CONTEXTS:
        raise UsageError(
            f"context: OpenGL hangs after a fork, got {options['context']!r}; "
            f"expected {' or '.join(CONTEXTS)}"
        )
    made = gymnasium.make_vec(
        MODULE + name.removeprefix(MODULE), n, "async", vector_kwargs=options, **settings
    )
    assert isinstance(made, AsyncVectorEnv)
    return made
