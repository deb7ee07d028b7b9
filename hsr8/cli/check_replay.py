"""``hsr8 check replay``: what a run believed, computed again from what it measured."""

from hsr8.cli.options import CheckReplay
from hsr8.errors import UsageError
from hsr8.loop import named_rng
from hsr8.recorder import atomic, run_folder
from hsr8.recorder.manifest import RUNNING, other_versions
from hsr8.recorder.measurements import CHANNELS, Measured, fingerprints, read_measurements
from hsr8.recorder.run_reader import Run, open_run
from hsr8.robot_builder import build_estimator
from hsr8.scenario.loader import load
from hsr8.world.generator import draw_layout

FAILED = 1


def main(options: CheckReplay) -> int:
    """Feed a run's measurements to the estimator and compare every belief, bit for bit.

    Raises:
        UsageError: there is no such run, or its measurements cannot be read.
    """
    run = open_run(options.run)
    file = run.path / run_folder.MEASUREMENTS
    if not file.exists():
        raise UsageError(f"{run.path} has no measurements: there is no {file.name}")
    measured = read_measurements(file, whole=run.manifest.get("exit_reason") != RUNNING)
    if not measured:
        raise UsageError(f"{file} holds no frame")
    difference = _first_difference(run, measured)
    if options.json:
        result = {"run": str(run.path), "frames": len(measured), "equal": difference is None}
        if difference is not None:
            index, channel = difference
            result |= {"frame": index, "time_s": measured[index].frame.time, "channel": channel}
        print(atomic.dumps(result))
    elif difference is None:
        print(f"equal       {len(measured)} frames of {run.path}, bit for bit")
    else:
        index, channel = difference
        time = measured[index].frame.time
        print(f"different   {run.path}: {channel} of frame {index} ({time:.3f} s)")
        for name, then, now in other_versions(run.manifest):
            print(f"            {name} was {then}, is {now}")
    return 0 if difference is None else FAILED


def _first_difference(run: Run, measured: list[Measured]) -> tuple[int, str] | None:
    """Frame and channel where the belief first differs from the recorded one."""
    scenario = load(str(run.scenario_file), seed=run.seed)
    layout = draw_layout(scenario, run.seed)
    estimator = build_estimator(scenario, layout, named_rng(run.seed, "belief"))
    for index, recorded in enumerate(measured):
        try:
            found = fingerprints(estimator.update(recorded.frame))
        except ValueError:  # the frames are not in their order
            return index, "order"
        for channel, a, b in zip(CHANNELS, found, recorded.fingerprints, strict=True):
            if a != b:
                return index, channel
    return None
