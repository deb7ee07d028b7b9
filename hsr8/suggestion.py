"""Did-you-mean hints."""

from collections.abc import Sequence
from difflib import get_close_matches

MAX_WORD = 100  # characters; the comparison takes the square of the length


def suggestion(word: str, choices: Sequence[str]) -> str:
    """Return ``; did you mean 'x'?`` for the closest choice, or an empty string."""
    close = get_close_matches(word, choices, n=1) if len(word) <= MAX_WORD else []
    return f"; did you mean '{close[0]}'?" if close else ""
