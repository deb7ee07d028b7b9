"""Seeds, shards and values as people write them."""

import re
from collections import Counter

from hsr8.errors import UsageError

MOST = 1_000_000  # runs of one sweep
LARGEST = 2**63 - 1


def parse_seeds(text: str) -> tuple[int, ...]:
    """Seeds of ``1000:1200``, ``1,5,9`` or ``0:10,42``; the end of a range is not included.

    Raises:
        UsageError: it is no such thing, names none or a seed twice.
    """
    seeds: list[int] = []
    for part in text.split(","):
        match = re.fullmatch(r"\s*(\d{1,19})\s*(?::\s*(\d{1,19})\s*)?", part, re.ASCII)
        if match is None:
            raise UsageError(
                f"--seeds {text}: {part.strip()!r} is neither a seed nor a range: give A:B for "
                "A to B-1, or a list, for example 1000:1200 or 1,5,9"
            )
        first = int(match[1])
        stop = int(match[2]) if match[2] else first + 1
        if stop <= first:
            raise UsageError(f"--seeds {text}: the range {part.strip()} is empty; B is excluded")
        if len(seeds) + stop - first > MOST or stop - 1 > LARGEST:
            raise UsageError(f"--seeds {text}: at most {MOST:,} seeds, none above 2^63 - 1")
        seeds += range(first, stop)
    seed, times = Counter(seeds).most_common(1)[0]
    if times > 1:
        raise UsageError(f"--seeds {text}: seed {seed} is there twice")
    return tuple(seeds)


def parse_shard(text: str) -> tuple[int, int]:
    """Number and count of ``2/8``, counted from 1.

    Raises:
        UsageError: it is no such thing.
    """
    match = re.fullmatch(r"(\d{1,6})/(\d{1,6})", text.strip(), re.ASCII)
    if match is None or not 1 <= int(match[1]) <= int(match[2]):
        raise UsageError(f"--shard {text}: give I/N with I from 1 to N, for example 1/4")
    return int(match[1]), int(match[2])


def parse_values(text: str) -> tuple[str, tuple[str, ...]]:
    """Key and values of ``camera.period_ms=40,80``; commas within brackets and quotes stay.

    Raises:
        UsageError: it is no such thing.
    """
    key, equals, rest = text.partition("=")
    values = [value.strip() for value in _split(rest)]
    if not equals or not key.strip() or not all(values) or len(set(values)) < len(values):
        raise UsageError(
            f"--vary {text}: must be KEY=VALUE,VALUE,... without repeats, for example "
            "--vary camera.period_ms=40,80,120"
        )
    return key.strip(), tuple(values)


def _split(text: str) -> list[str]:
    parts, depth, quote = [""], 0, ""
    for character in text:
        if quote:
            quote = "" if character == quote else quote
        elif character in "\"'":
            quote = character
        else:
            depth += (character in "[{") - (character in "]}")
        if character == "," and depth == 0 and not quote:
            parts.append("")
        else:
            parts[-1] += character
    return parts
