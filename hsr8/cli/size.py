"""Sizes of pictures as people write them."""

import re

from hsr8.errors import UsageError


def parse_size(text: str) -> tuple[int, int]:
    """Width and height [pixel] of ``960x540``.

    Raises:
        UsageError: it is no such thing, or not even, or out of range.
    """
    match = re.fullmatch(r"(\d{2,5})[x×](\d{2,5})", text.strip())
    size = (int(match[1]), int(match[2])) if match else (0, 0)
    if any(side % 2 or not 64 <= side <= 4096 for side in size):
        raise UsageError(
            f"--size {text!r}: give WIDTHxHEIGHT, even and from 64 to 4096, for example 1280x720"
        )
    return size
