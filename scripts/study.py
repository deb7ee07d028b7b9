"""Shared by the studies: seeds on the command line, and settings of a quick run."""

import argparse

from hsr8.errors import UsageError
from hsr8.sweep.seeds import parse_seeds

STAND_INS = ("robot.body=kinematic", "camera.source=analytic")
"""Settings of a run without physics and images."""


def seeds(text: str) -> tuple[int, ...]:
    """Return the seeds of ``1000:1020`` or ``1,5,9``, as ``hsr8 sweep`` reads them.

    Raises:
        ArgumentTypeError: `text` is malformed.
    """
    try:
        return parse_seeds(text)
    except UsageError as error:
        raise argparse.ArgumentTypeError(str(error)) from error
