"""The word that was probably meant."""

from collections.abc import Sequence
from difflib import get_close_matches


def suggestion(word: str, choices: Sequence[str]) -> str:
    """``; did you mean 'x'?`` for the closest choice, else nothing."""
    close = get_close_matches(word, choices, n=1)
    return f"; did you mean '{close[0]}'?" if close else ""
