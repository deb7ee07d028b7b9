"""Random generators of the subsystems, derived from the seed of a run."""

import zlib

import numpy as np


def named_rng(seed: int, name: str) -> np.random.Generator:
    """Return the generator of the subsystem `name`, independent of those of other names."""
    return np.random.default_rng(
        np.random.SeedSequence(entropy=seed, spawn_key=(zlib.crc32(name.encode()),))
    )
