"""Several environments, each in a process."""

from collections.abc import Mapping
from typing import Any

import gymnasium
from gymnasium.vector import AsyncVectorEnv

from hsr8.errors import UsageError
from hsr8.gym.options import check_integer

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
        UsageError: an argument is invalid.
    """
    options = {"context": CONTEXTS[0], **(vector_kwargs or {})}
    context = options["context"]
    if context not in CONTEXTS:
        problem = "OpenGL hangs after a fork" if context == "fork" else "unknown start method"
        raise UsageError(f"context: {problem}, got {context!r}; expected {' or '.join(CONTEXTS)}")
    if "vectorization_mode" in settings:
        raise UsageError(
            "vectorization_mode: every environment has a process, got "
            f"{settings['vectorization_mode']!r}; expected no such option"
        )
    check_integer("n", n, 1)
    try:
        made = gymnasium.make_vec(
            MODULE + name.removeprefix(MODULE),
            n,
            "async",
            vector_kwargs=options,
            **settings,
        )
    except OSError as error:
        raise UsageError(
            f"make_vec: processes cannot share memory: {error}; expected a writable /dev/shm "
            "(docker run --tmpfs /dev/shm), or use gymnasium.vector.SyncVectorEnv"
        ) from error
    assert isinstance(made, AsyncVectorEnv)
    return made
