"""``hsr8 run --verify-determinism``: the same run once more, in another process."""

import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from hsr8.cli.diff import first_difference
from hsr8.errors import Hsr8Error
from hsr8.recorder.run import run_folder
from hsr8.recorder.run.run_reader import open_run
from hsr8.recorder.run.tape import read_tape

ENDED = (0, 1)  # exit codes of a run that came to its end


@dataclass(frozen=True, slots=True)
class Verified:
    """What came of the second run.

    Attributes:
        difference: the first one, in a sentence; empty where there is none.
        hashes: how many hashes of the whole state were compared.
        second: folder of the second run, kept where it differs.
    """

    difference: str
    hashes: int
    second: Path

    @property
    def equal(self) -> bool:
        """Whether every bit is the same."""
        return not self.difference


def verify(folder: Path) -> Verified:
    """Run what `folder` holds again, without a log, and compare.

    Raises:
        Hsr8Error: the second run did not come to its end.
    """
    first = open_run(folder)
    out = Path(tempfile.mkdtemp(prefix="hsr8-verify-"))
    difference = ""
    try:
        words = [sys.executable, "-P", "-m", "hsr8", "run", str(first.scenario_file)]
        words += ["--no-log", "--quiet", "--out", str(out)]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        if done.returncode not in ENDED:
            raise Hsr8Error(f"the second run failed: {done.stderr.strip() or done.returncode}")
        second = open_run(out)
        difference = first_difference(first, second)
        hashes = len(read_tape(folder / run_folder.TAPE, whole=True))
        return Verified(difference, hashes, second.path)
    finally:
        told = any(out.rglob(run_folder.CRASH))  # a message names this file
        if not difference and not told:
            shutil.rmtree(out, ignore_errors=True)
