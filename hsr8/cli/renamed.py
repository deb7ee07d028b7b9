"""Former names of commands and options."""

from collections.abc import Sequence

from hsr8.errors import UsageError

RENAMED = {
    "--camera all-round": "--camera omnidirectional",
    "--camera egl": "--camera rendered",
    "--picture": "--image",
    "check replay": "verify",
    "colours": "color-table",
    "completion": "--tyro-print-completion",
}


def require_present_names(words: Sequence[str]) -> None:
    """Refuse a command line with a former name.

    Args:
        words: words of the command line.

    Raises:
        UsageError: a command or an option was renamed.
    """
    line = f"{' '.join(words).replace('=', ' ')} "
    for former, present in RENAMED.items():
        option = former.startswith("-") and f" {former} " in line
        if option or line.startswith(f"{former} "):
            raise UsageError(f"{former}: renamed to {present}")
