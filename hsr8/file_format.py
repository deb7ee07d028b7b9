"""Format numbers of run and sweep folders.

A format number is raised whenever older folders can no longer be read.
"""

from pathlib import Path

from hsr8.errors import UsageError
from hsr8.version import VERSION


def check_number(number: int, expected: int, path: Path | str, file: str) -> None:
    """Refuse a format `number` other than `expected`.

    Args:
        number: format number of the folder.
        expected: format that this version reads.
        path: path of the folder, for messages.
        file: kind of folder, for messages: ``run folder``.

    Raises:
        UsageError: the formats differ.
    """
    if number != expected:
        raise UsageError(
            f"{path}: {file} of format {number}, hsr8 {VERSION} reads format {expected}: "
            "run the scenario again, or use the version of hsr8 that wrote it"
        )
