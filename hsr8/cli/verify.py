"""``hsr8 verify``: recompute a run from its records."""

from dataclasses import asdict
from typing import TYPE_CHECKING

from hsr8.cli.options import Verify
from hsr8.errors import UsageError
from hsr8.files import atomic
from hsr8.recording.manifest import other_versions
from hsr8.recording.run import Run, open_run
from hsr8.robots.file.locate import digest

if TYPE_CHECKING:
    from hsr8.recording.verification import Recomputed

DIFFERENT = 1


def main(options: Verify) -> int:
    """Recompute physics, belief and decisions and compare them bit for bit."""
    run = open_run(options.run, trust=options.trust)
    if not options.json:
        print(f"run         {run.folder}", flush=True)
    from hsr8.recording.verification import recompute  # noqa: PLC0415  takes seconds

    stages = recompute(run)
    if not any(stage.count for stage in stages):
        raise UsageError(f"{run.folder}: nothing to recompute: the run ended in its first second")
    equal = all(stage.equal for stage in stages)
    changes = [] if equal else _changes(run)
    if options.json:
        rows = [asdict(stage) | {"equal": stage.equal} for stage in stages]
        changed = {name: {"then": then, "now": now} for name, then, now in changes}
        result = {"run": str(run.folder), "equal": equal, "changed": changed, "stages": rows}
        print(atomic.dumps(result))
    else:
        for name, then, now in changes:
            print(f"{'changed':<12}{name} was {then}, is {now}: {_effect(name)}")
        for stage in stages:
            print(f"{stage.stage:<12}{_verdict(stage)}")
    return 0 if equal else DIFFERENT


def _changes(run: Run) -> list[tuple[str, str, str]]:
    """Return name, then and now of every library that differs, and of the robot's files."""
    recorded = run.manifest.get("libraries", {})
    robot = digest(run.scenario().robot.model)
    changed = [(name, str(recorded.get(name)), now) for name, now in robot.items()]
    return other_versions(run.manifest) + [c for c in changed if c[1] != c[2]]


def _effect(name: str) -> str:
    """Return the effect of a changed library, robot file or arithmetic on a comparison."""
    return "the last bits differ" if name == "arithmetic" else "results may differ"


def _verdict(stage: "Recomputed") -> str:
    if stage.equal:
        return f"equal, {stage.count} {stage.unit}, bit for bit"
    unit = stage.unit.removesuffix("s")
    return f"different: {stage.channel} of {unit} {stage.index} ({stage.time:.3f} s)"
