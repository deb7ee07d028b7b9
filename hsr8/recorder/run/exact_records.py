"""The exact records of a run folder: its tape and its measurements, whole if the run ended."""

from hsr8.errors import UsageError
from hsr8.recorder.run import run_folder
from hsr8.recorder.run.measurements import Measured, read_measurements
from hsr8.recorder.run.run_reader import Run
from hsr8.recorder.run.tape import Block, read_tape


def tape_of(run: Run) -> list[Block]:
    """What the servos of `run` were told.

    Raises:
        UsageError: it is missing, damaged, or cut off though the run ended.
    """
    file = run.path / run_folder.TAPE
    tape = read_tape(file, whole=run.ended)
    if run.ended and not (tape and len(tape[-1].setpoints) == 0):
        raise UsageError(f"{file} is cut off: it lacks the end of the run")
    return tape


def measurements_of(run: Run) -> list[Measured]:
    """All that reached the belief and the decisions of `run`.

    Raises:
        UsageError: it is missing, damaged, or cut off though the run ended.
    """
    measured = read_measurements(run.path / run_folder.MEASUREMENTS, whole=run.ended)
    run.must_hold(run_folder.MEASUREMENTS, len(measured), "camera_frames", "frames")
    return measured


def require_whole(run: Run) -> None:
    """Refuse a run that ended and has lost a part of what was drawn and plotted from it.

    Raises:
        UsageError: it has.
    """
    if run.ended:
        for read in (run.trajectory, run.walking, run.frames, run.events):
            read()
