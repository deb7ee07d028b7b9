"""Commands and their options; no heavy import, so that ``--help`` is fast."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import tyro
from tyro.conf import Positional, UseAppendAction
from tyro.constructors import PrimitiveConstructorSpec


def _arg(metavar: str, text: str) -> object:
    return tyro.conf.arg(metavar=metavar, help=text, help_behavior_hint="")


def _optional(kind: Callable[[str], Any], *choices: str) -> PrimitiveConstructorSpec[Any]:
    """Parse one value of an option whose default is None; the word ``None`` is not a value."""
    return PrimitiveConstructorSpec(
        nargs=1,
        metavar="VALUE",
        instance_from_str=lambda words: kind(words[0]),
        is_instance=lambda value: value is not None,
        str_from_instance=lambda value: [str(value)],
        choices=choices or None,
    )


INTEGER, NUMBER = _optional(int), _optional(float)
ScenarioName = Annotated[str, _arg("SCENARIO", "name (see `hsr8 list`) or TOML file")]
Settings = UseAppendAction[
    Annotated[
        tuple[tuple[str, ...], ...],
        _arg("KEY=VALUE", "any setting, e.g. --set world.n_moving=8; may be repeated"),
    ]
]
Duration = Annotated[
    float | None,
    NUMBER,
    _arg("S", "simulated time at most [s]; default: that of the scenario"),
]
Body = Annotated[
    Literal["full", "kinematic"] | None,
    _optional(str, "full", "kinematic"),
    _arg("{full,kinematic}", "full physics, or feet that land exactly as planned (faster)"),
]
Camera = Annotated[
    Literal["rendered", "analytic", "omnidirectional"] | None,
    _optional(str, "rendered", "analytic", "omnidirectional"),
    _arg(
        "{rendered,analytic,omnidirectional}",
        "rendered: images drawn with OpenGL; analytic: geometry only; "
        "omnidirectional: analytic, 360 deg",
    ),
]
RunPath = Annotated[Path, _arg("RUN", "run folder, or a parent folder for its newest run")]
Json = Annotated[
    bool, tyro.conf.arg(help="print one JSON object on standard output", help_behavior_hint="")
]
Quiet = Annotated[
    bool, tyro.conf.arg(help="print neither progress nor results", help_behavior_hint="")
]


@dataclass(frozen=True)
class Run:
    """Run a scenario and record it: physics, head camera, belief, gaze, walking."""

    scenario: Positional[ScenarioName]
    seed: Annotated[
        int | None, INTEGER, _arg("N", "seed of world and noise; default: that of the scenario")
    ] = None
    out: Path = Path("runs")
    """Parent folder of run folders."""
    duration: Duration = None
    set: Settings = ()
    body: Body = None
    camera: Camera = None
    no_log: bool = False
    """Write no Rerun log."""
    log_level: Annotated[
        Literal["minimal", "standard", "full"] | None,
        _optional(str, "minimal", "standard", "full"),
        _arg(
            "{minimal,standard,full}",
            "minimal: poses, curves, events; standard (default): also images and beliefs; "
            "full: every frame",
        ),
    ] = None
    view: Annotated[
        Literal["native", "web"] | None,
        _optional(str, "native", "web"),
        _arg("{native,web}", "show the log during the run: in a window or in a browser"),
    ] = None
    json: Json = False
    quiet: Quiet = False


@dataclass(frozen=True)
class Sweep:
    """Run a scenario over many seeds in parallel and summarize the results.

    Runs with a result in the folder are not repeated: the same command line continues a
    stopped sweep, and further seeds are added.
    """

    scenario: Positional[ScenarioName]
    seeds: Annotated[
        str,
        _arg("SEEDS", "A:B for A to B-1, or a list: 1000:1200, 1,5,9, or 0:10,42"),
    ]
    out: Annotated[
        Path | None, _arg("DIR", "folder of the sweep; default: sweeps/ and the scenario's name")
    ] = None
    workers: Annotated[int | None, INTEGER, _arg("N", "parallel runs; default: number of CPUs")] = (
        None
    )
    set: Settings = ()
    vary: UseAppendAction[
        Annotated[
            tuple[tuple[str, ...], ...],
            _arg(
                "KEY=V1,V2,...",
                "also vary a setting, one folder per value; repeated: all combinations",
            ),
        ]
    ] = ()
    duration: Duration = None
    body: Body = None
    camera: Camera = None
    executor: str = "local"
    """Executor: local, or dask://HOST:PORT for a Dask cluster."""
    shard: Annotated[
        str | None,
        _arg("I/N", "run part I of N; afterwards the same line without --shard writes the report"),
    ] = None
    timeout: Annotated[
        float | None,
        NUMBER,
        _arg("S", "wall-clock limit per run [s]; default: 60 s + 20 x its duration"),
    ] = None
    keep: Literal["all", "failed", "none"] = "all"
    """Run folders to keep; one takes about 100 kB per simulated second."""
    log: bool = False
    """Write the Rerun log of every run."""
    json: Json = False
    quiet: Quiet = False


@dataclass(frozen=True)
class Compare:
    """Compare two sweeps or two runs on their common seeds: paired differences with tests."""

    a: Positional[Annotated[Path, _arg("A", "folder of a sweep or of a run")]]
    b: Positional[Annotated[Path, _arg("B", "folder to compare with A")]]
    metric: UseAppendAction[
        Annotated[
            tuple[str, ...],
            _arg("NAME", "numeric key of metrics.json; may be repeated; default: the usual ones"),
        ]
    ] = ()
    json: Json = False


@dataclass(frozen=True)
class List:
    """List the built-in scenarios."""

    json: Json = False


@dataclass(frozen=True)
class Check:
    """Check a scenario without running it: settings, world, feasibility."""

    scenario: Positional[ScenarioName]
    seed: Annotated[
        int | None, INTEGER, _arg("N", "seed of the world; default: that of the scenario")
    ] = None
    set: Settings = ()
    image: Annotated[
        Path | None, _arg("PNG", "draw the world and the path of the feasibility certificate")
    ] = None
    json: Json = False


@dataclass(frozen=True)
class Verify:
    """Recompute a run from its records and compare physics, belief and decisions bit for bit."""

    run: Positional[RunPath]
    json: Json = False


@dataclass(frozen=True)
class Info:
    """Show a run folder: results, events, versions, files."""

    run: Positional[RunPath]
    json: Json = False


@dataclass(frozen=True)
class Diff:
    """Compare two runs bit for bit: first tick, channel and values that differ."""

    a: Positional[RunPath]
    b: Positional[RunPath]
    json: Json = False


@dataclass(frozen=True)
class Render:
    """Render the video of a run: H.264, with a thumbnail."""

    run: Positional[RunPath]
    camera: str = "dashboard"
    """Camera: dashboard, follow, head, top, or any camera of the model."""
    fps: int = 25
    """Frames per second of the video [1/s]."""
    size: str = "960x540"
    """Width x height [pixel]."""
    fine: bool = False
    """Smooth edges and sharper shadows, at twice the cost."""
    out: Annotated[
        Path | None,
        _arg(
            "FILE",
            "output file; default: video.mp4 in the run folder; .gif and .webp: animation, "
            ".png: one image, at --start",
        ),
    ] = None
    start: float = 0.0
    """Simulated time at which the video begins [s]."""
    stop: Annotated[
        float | None, NUMBER, _arg("S", "simulated time at which the video ends [s]")
    ] = None
    speed: Annotated[
        float | None,
        NUMBER,
        _arg("X", "simulated seconds per second of video; default: a video of at most a minute"),
    ] = None
    json: Json = False
    quiet: Quiet = False


@dataclass(frozen=True)
class Replay:
    """Open the log of a run in the Rerun viewer."""

    run: Positional[RunPath]
    screenshot: Annotated[
        Path | None, _arg("PNG", "write a screenshot of the viewer instead; needs no display")
    ] = None
    time: Annotated[
        float | None,
        NUMBER,
        _arg("S", "simulated time of the screenshot [s]; default: the middle of the run"),
    ] = None
    size: str = "1600x900"
    """Width x height of the window [pixel]."""
    json: Json = False


@dataclass(frozen=True)
class Plot:
    """Plot the walking of a run: ZMP, CoM, DCM, soles, velocities, torques, tilt."""

    run: Positional[RunPath]
    what: Literal["walking", "zmp", "footsteps", "velocity", "torques", "tilt"] = "walking"
    """Quantity to plot; walking is all of them."""
    out: Annotated[
        Path | None, _arg("FILE", ".png, .svg or .pdf; default: a PNG in the run folder")
    ] = None
    start: Annotated[float, tyro.conf.arg(name="from", metavar="S")] = 0.0
    """Simulated time at which the plot begins [s]."""
    stop: Annotated[
        float | None,
        NUMBER,
        tyro.conf.arg(
            name="to",
            metavar="S",
            help="simulated time at which the plot ends [s]",
            help_behavior_hint="",
        ),
    ] = None
    json: Json = False


@dataclass(frozen=True)
class ColorTable:
    """Learn a color table for vision from labelled images.

    The mask of NAME.png or NAME.jpg is NAME.mask.png in the same folder. Pixels of the mask are
    black for background, white for "not labelled", or the color that marks a class. A wrong
    mask is refused with the list of these colors.
    """

    images: Positional[Annotated[tuple[Path, ...], _arg("IMAGE", "images that have masks")]]
    out: Path = Path("colors.npz")
    """File of the table; value of vision.color_table in a scenario."""
    json: Json = False


@dataclass(frozen=True)
class Schema:
    """Print the JSON Schema of scenario files, for completion and checks in editors."""

    out: Annotated[Path | None, _arg("FILE", "output file; default: standard output")] = None


@dataclass(frozen=True)
class Doctor:
    """Check the installation: OpenGL, libraries, models, disk."""

    json: Json = False


Command = (
    Run
    | Sweep
    | Compare
    | List
    | Check
    | Verify
    | Info
    | Diff
    | Render
    | Replay
    | Plot
    | ColorTable
    | Schema
    | Doctor
)
