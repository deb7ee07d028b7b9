"""Seeds and varied values as written on the command line."""

import re
from collections import Counter

from hsr8.errors import UsageError

MAX_RUNS = 1_000_000
MAX_SEED = 2**63 - 1


def parse_seeds(text: str, option: str = "--seeds") -> tuple[int, ...]:
    """Return the seeds of ``1000:1200``, ``1,5,9`` or ``0:10,42``; ranges exclude their end.

    Args:
        text: words of the command line.
        option: named in messages.

    Raises:
        UsageError: `text` is malformed, or names no seed or one twice.
    """
    seeds: list[int] = []
    for part in text.split(","):
        match = re.fullmatch(r"\s*(\d{1,19})\s*(?::\s*(\d{1,19})\s*)?", part, re.ASCII)
        first = int(match[1]) if match else 0
        stop = int(match[2]) if match and match[2] else first + 1
        if match is None or stop <= first:
            raise UsageError(
                f"{option}: not a seed or a range, got {part.strip()!r}; expected A:B for A to B-1 "
                "or a list, such as 1000:1200 or 1,5,9"
            )
        if len(seeds) + stop - first > MAX_RUNS or stop - 1 > MAX_SEED:
            raise UsageError(
                f"{option}: too many or too large, got {text}; expected at most {MAX_RUNS:,} seeds "
                "below 2^63"
            )
        seeds += range(first, stop)
    seed, count = Counter(seeds).most_common(1)[0]
    if count > 1:
        raise UsageError(f"{option}: seed {seed} is repeated, got {text}")
    return tuple(seeds)


def parse_values(text: str) -> tuple[str, tuple[str, ...]]:
    """Return key and values of ``camera.period_ms=40,80``; brackets and quotes protect commas.

    Raises:
        UsageError: `text` is malformed, or repeats a value.
    """
    key, _, rest = text.partition("=")
    values = [value.strip() for value in _split(rest)]
    if not key.strip() or not all(values) or len(set(values)) < len(values):
        raise UsageError(
            f"--vary: malformed or repeated values, got {text}; expected KEY=VALUE,VALUE,..., "
            "such as camera.period_ms=40,80,120"
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
