"""``hsr8 export``: runs, robots and worlds in the formats of other tools."""

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path

from hsr8.cli.options import Export
from hsr8.cli.output_file import require_file_name, require_new, writing
from hsr8.errors import UsageError
from hsr8.export.bag import write_bag
from hsr8.export.csv_tables import write_csv
from hsr8.export.lerobot import write_lerobot
from hsr8.export.urdf import urdf_of
from hsr8.export.world_files import irsim_yaml, write_map
from hsr8.files import atomic
from hsr8.files.atomic import draft
from hsr8.recording.run import Run, open_run
from hsr8.robots.loaded import load_robot
from hsr8.scenario.loader import load_scenario
from hsr8.scenario.schema import Scenario
from hsr8.world.field.generator import draw_layout
from hsr8.world.field.layout import Layout

DEFAULT_ROBOT = "hsr8"
WORLD = ("--irsim", "--map")
IMAGE = ".pgm"  # of a map, next to its YAML file


def main(options: Export) -> int:
    """Write the exports and print their paths.

    Every export is a draft until all are complete.
    """
    given = {
        "--urdf": options.urdf,
        "--bag": options.bag,
        "--csv": options.csv,
        "--lerobot": options.lerobot,
        "--irsim": options.irsim,
        "--map": options.map,
    }
    targets = {option: path for option, path in given.items() if path is not None}
    if not targets:
        raise UsageError(
            "export: nothing to export; expected --bag, --csv, --lerobot, --urdf, --irsim or --map"
        )
    _require_new(targets)
    runs = _runs(options, targets)
    world = _world(options, targets)
    with ExitStack() as drafts:
        for option, path in targets.items():
            drafts.enter_context(writing(option, path))
            new = drafts.enter_context(draft(path))
            if option == "--urdf":
                _write_urdf(path, new, options.robot or _robot_of(runs), drafts)
            elif option == "--bag":
                write_bag(runs[0], new)
            elif option == "--csv":
                write_csv(runs[0], new)
            elif option == "--lerobot":
                write_lerobot(runs, new)
            elif world is not None:
                _write_world(option, path, new, world, drafts)
    if options.json:
        print(atomic.dumps({option.removeprefix("--"): str(p) for option, p in targets.items()}))
    else:
        for option, path in targets.items():
            print(f"{option.removeprefix('--'):<12}{path}")
    return 0


def _robot_of(runs: Sequence[Run]) -> str:
    """Return the robot of the runs, the default without runs.

    Raises:
        UsageError: the runs have several robots.
    """
    robots = sorted({run.scenario().robot.model for run in runs} or {DEFAULT_ROBOT})
    if len(robots) > 1:
        raise UsageError(f"--urdf: several robots, got runs of {', '.join(robots)}; expected one")
    return robots[0]


def _runs(options: Export, targets: Mapping[str, Path]) -> list[Run]:
    """Return the runs; none if only a world is exported.

    Raises:
        UsageError: an export has too few or too many runs, or a run cannot be read.
    """
    if targets.keys() <= set(WORLD):
        return []
    if options.lerobot is not None and not options.runs:
        raise UsageError("--lerobot: got 0 runs; expected at least one")
    for option in ("--bag", "--csv"):
        if option in targets and len(options.runs) != 1:
            raise UsageError(f"{option}: got {len(options.runs)} runs; expected one")
    return [open_run(path) for path in options.runs]


def _world(options: Export, targets: Mapping[str, Path]) -> tuple[Scenario, Layout] | None:
    """Return scenario and world of a run or a scenario; None if no world is exported.

    Raises:
        UsageError: there is not one run or scenario, or the run cannot be read.
        ScenarioError: the scenario is invalid, or its world cannot be drawn.
    """
    wanted = [option for option in targets if option in WORLD]
    if not wanted:
        return None
    if len(options.runs) != 1:
        raise UsageError(f"{wanted[0]}: got {len(options.runs)} worlds; expected one")
    (path,) = options.runs
    if path.is_dir():
        scenario = open_run(path).scenario()
    else:
        scenario = load_scenario(str(path), seed=options.seed)
    return scenario, draw_layout(scenario, scenario.seed)


def _write_world(
    option: str, path: Path, new: Path, world: tuple[Scenario, Layout], drafts: ExitStack
) -> None:
    scenario, layout = world
    if option == "--irsim":
        new.write_text(irsim_yaml(layout, scenario), encoding="utf-8")
    else:
        write_map(layout, new, drafts.enter_context(draft(path.with_suffix(IMAGE))))


def _require_new(targets: Mapping[str, Path]) -> None:
    """Require different new targets."""
    options: dict[Path, str] = {}
    for option, path in targets.items():
        if option == "--urdf":
            require_file_name(option, path, (".urdf",))
            require_new(option, _meshes(path))
        elif option == "--map":
            require_file_name(option, path, (".yaml", ".yml"))
            require_new(option, path.with_suffix(IMAGE))
        require_new(option, path)
        first = options.setdefault(path.parent.resolve() / path.name, option)
        if first != option:
            raise UsageError(f"{option} {path}: the same as {first}; expected another name")


def _meshes(file: Path) -> Path:
    """Return the folder of the meshes of a URDF file."""
    return file.with_name(f"{file.stem}_meshes")


def _write_urdf(file: Path, new: Path, robot: str, drafts: ExitStack) -> None:
    meshes = _meshes(file)
    urdf = urdf_of(load_robot(robot), meshes.name)
    urdf.write(new, drafts.enter_context(draft(meshes)) if urdf.meshes else meshes)
