"""Random numbers: every subsystem has a generator of its own, drawn from the run's seed."""

import zlib

import numpy as np


def named_rng(seed: int, name: str) -> np.random.Generator:
    """Generator of the subsystem `name`; independent of every other name's."""
    return np.random.default_rng(
        np.random.SeedSequence(entropy=seed, spawn_key=(zlib.crc32(name.encode()),))
    )
