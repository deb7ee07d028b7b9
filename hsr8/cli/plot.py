"""``hsr8 plot``: figures of the walking of a run."""

import sys

from hsr8.cli.options import Plot
from hsr8.cli.output_file import require_file_name, writing
from hsr8.errors import UsageError
from hsr8.files import atomic
from hsr8.recording.run import open_run

SUFFIXES = (".png", ".svg", ".pdf")


def main(options: Plot) -> int:
    """Draw the plot and print its path."""
    run = open_run(options.run)
    out = options.out or run.folder / f"{options.what}.png"
    require_file_name("--out", out, SUFFIXES)
    time = run.records["time"]
    end = float(time[-1]) if len(time) else 0.0
    start = options.start
    stop = end if options.stop is None else min(options.stop, end)
    if not 0.0 <= start < stop:
        raise UsageError(
            f"--from, --to: nothing to plot from {start:g} s to {stop:g} s; "
            f"the run ended at {end:g} s"
        )
    print(f"plotting    {run.folder}", file=sys.stderr, flush=True)
    try:
        from hsr8.show.walk_figure import draw, save  # noqa: PLC0415  takes seconds
    except OSError as error:
        raise UsageError(
            "MPLCONFIGDIR: Matplotlib can write neither to the home nor to a temporary folder; "
            "expected MPLCONFIGDIR=DIR with a writable folder"
        ) from error
    from hsr8.robots.loaded import load_robot  # noqa: PLC0415  takes seconds
    from hsr8.world.field.generator import draw_layout  # noqa: PLC0415  with the robot

    scenario = run.scenario()
    robot, layout = load_robot(scenario.robot.model).model, draw_layout(scenario, run.seed)
    title = f"{run.manifest.get('scenario', run.folder.name)}, seed {run.seed}"
    if (start, stop) != (0.0, end):
        title += f", {start:g} to {stop:g} s"
    figure = draw(run.records.window(start, stop), robot, layout, options.what, title)
    with writing("--out", out):
        save(figure, out)
    if options.json:
        print(atomic.dumps({"plot": str(out), "what": options.what, "from_s": start, "to_s": stop}))
    else:
        print(f"plot        {out}")
    return 0
