"""``hsr8 sweep --dry-run``: what a sweep would take."""

from collections.abc import Sequence
from datetime import timedelta
from pathlib import Path

from hsr8.cli.cost import estimate
from hsr8.cli.options import Sweep
from hsr8.recorder.files import atomic
from hsr8.recorder.log_level import LogLevel
from hsr8.scenario.schema import Scenario


def tell_cost(
    options: Sweep,
    scenarios: Sequence[Scenario],
    *,
    seeds: int,
    workers: int,
    out: Path,
    command: str,
) -> None:
    """Print it.

    Args:
        options: as they were given.
        scenarios: one for each combination of varied values.
        seeds: how many runs each of them makes.
        workers: runs at a time.
        out: folder of the sweep.
        command: line that starts it.
    """
    costs = [estimate(s, log=LogLevel.STANDARD if options.log else None) for s in scenarios]
    runs = seeds * len(scenarios)
    wall = seeds * sum(cost.wall for cost in costs) / max(1, min(workers, runs))
    disk = 0.0 if options.keep == "none" else seeds * sum(cost.disk for cost in costs)
    if options.json:
        told = {
            "scenario": scenarios[0].name,
            "runs": runs,
            "workers": workers,
            "folder": str(out),
            "simulated_time_s": seeds * sum(cost.simulated for cost in costs),
            "estimated_wall_time_s": round(wall, 1),
            "estimated_disk_mb": round(disk, 1),
            "command": command,
        }
        print(atomic.dumps(told))
        return
    each = f"{seeds} seeds" if len(scenarios) == 1 else f"{len(scenarios)} x {seeds} seeds"
    print(f"would run   {scenarios[0].name}, {each}, {workers} at a time, into {out}")
    print(f"takes       {timedelta(seconds=round(wall))} at most, with a processor for each worker")
    print(f"leaves      {disk:.0f} MB at most; what has a result there is not run again")
    print(f"for real    {command}")
