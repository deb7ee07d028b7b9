"""The commands and their options; nothing heavy is imported, so that ``--help`` is quick."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import tyro
from tyro.conf import Positional, UseAppendAction


def _arg(metavar: str, text: str) -> object:
    return tyro.conf.arg(metavar=metavar, help=text, help_behavior_hint="")


ScenarioName = Annotated[str, _arg("SCENARIO", "name (see `hsr8 list`) or TOML file")]
Settings = UseAppendAction[
    Annotated[
        tuple[tuple[str, ...], ...],
        _arg("KEY=VALUE", "any setting, e.g. --set world.n_moving=8; may be repeated"),
    ]
]
Body = Annotated[
    Literal["full", "kinematic"] | None,
    _arg("{full,kinematic}", "full physics, or feet that land exactly as planned, faster"),
]
Camera = Annotated[
    Literal["rendered", "analytic", "omnidirectional"] | None,
    _arg(
        "{rendered,analytic,omnidirectional}",
        "rendered: OpenGL images; analytic: geometric projection, no OpenGL; omnidirectional: "
        "analytic with a 360 deg view",
    ),
]
RunPath = Annotated[
    Path, tyro.conf.arg(metavar="RUN", help="run folder, or a folder whose newest run is meant")
]


@dataclass(frozen=True)
class Run:
    """Run a scenario: physics, head camera, belief, gaze, walking; all of it logged."""

    scenario: Positional[
        Annotated[str, _arg("SCENARIO", "name (see `hsr8 list`) or TOML file; with --resume a run")]
    ]
    seed: Annotated[int | None, _arg("N", "seed of world and noise; else the scenario's")] = None
    out: Path = Path("runs")
    """Folder for run folders."""
    duration: Annotated[
        float | None, _arg("S", "simulated time at most [s]; else the scenario's")
    ] = None
    set: Settings = ()
    body: Body = None
    camera: Camera = None
    no_log: bool = False
    """Write no Rerun log."""
    log_level: Annotated[
        Literal["minimal", "standard", "full"] | None,
        _arg(
            "{minimal,standard,full}",
            "minimal: poses, curves, events; standard (default): images and beliefs too; "
            "full: every frame",
        ),
    ] = None
    view: Annotated[
        Literal["native", "web"] | None,
        _arg(
            "[{native,web}]",
            "show the log as it is written too: in a window, or to a browser on this machine",
        ),
    ] = None
    checkpoint: Annotated[
        str, _arg("every=S", "save the run every so many whole simulated seconds; else never")
    ] = ""
    resume: bool = False
    """Go on with a run that was killed, from its last checkpoint, to the identical end."""
    verify_determinism: bool = False
    """Run twice, in processes of their own, and compare every bit."""
    dry_run: bool = False
    """Check everything, say what it would take, and run nothing."""
    json: bool = False
    """Print the results as one JSON object, and nothing else, on standard output."""
    quiet: bool = False
    """No progress line, no result table."""


@dataclass(frozen=True)
class Sweep:
    """Run a scenario over many seeds, a process each, and sum up the results.

    What has a result in the folder is not run again: the same command line goes on where a
    stopped sweep ended, and more seeds join the old ones.
    """

    scenario: Positional[ScenarioName]
    seeds: Annotated[
        str,
        _arg("SEEDS", "A:B for A to B-1, or a list: 1000:1200, 1,5,9, or 0:10,42"),
    ]
    out: Annotated[
        Path | None, _arg("DIR", "folder of the sweep; by default sweeps/ and the scenario's name")
    ] = None
    workers: Annotated[int | None, _arg("N", "runs at a time; by default, one per CPU")] = None
    set: Settings = ()
    vary: UseAppendAction[
        Annotated[
            tuple[tuple[str, ...], ...],
            _arg(
                "KEY=V1,V2,...",
                "sweep over these values too, a folder each; repeated, over all combinations",
            ),
        ]
    ] = ()
    duration: Annotated[
        float | None, _arg("S", "simulated time at most [s]; else the scenario's")
    ] = None
    body: Body = None
    camera: Camera = None
    executor: str = "local"
    """Who runs: local, dask, dask://HOST:PORT, ray or ray://HOST:PORT."""
    shard: Annotated[
        str | None,
        _arg("I/N", "run part I of N; afterwards the same line without --shard writes the report"),
    ] = None
    timeout: Annotated[
        float | None,
        _arg("S", "wall time after which a run hangs [s]; by default 60 s + 20 x its duration"),
    ] = None
    keep: Literal["all", "failed", "none"] = "all"
    """Run folders that stay; one takes about 100 kB per simulated second."""
    log: bool = False
    """Write the Rerun log of every run."""
    dry_run: bool = False
    """Check everything, say what it would take, and run nothing."""
    json: bool = False
    """Print the results as one JSON object on standard output."""
    quiet: bool = False
    """No progress, no result table."""


@dataclass(frozen=True)
class Compare:
    """Compare two sweeps, or two runs, on their common seeds: paired differences with tests."""

    a: Positional[Annotated[Path, tyro.conf.arg(metavar="A", help="sweep's folder, or run folder")]]
    b: Positional[Annotated[Path, tyro.conf.arg(metavar="B", help="the one compared with it")]]
    metric: UseAppendAction[
        Annotated[
            tuple[str, ...],
            _arg("NAME", "a number of metrics.json, else the usual ones; may be repeated"),
        ]
    ] = ()
    json: bool = False
    """Print one JSON object, else a page of Markdown."""


@dataclass(frozen=True)
class List:
    """List the scenarios that come with hsr8."""

    json: bool = False
    """Print one JSON object."""


@dataclass(frozen=True)
class Diff:
    """Compare two runs bit for bit: the first tick, channel and values that differ."""

    a: Positional[RunPath]
    b: Positional[RunPath]
    json: bool = False
    """Print one JSON object."""


@dataclass(frozen=True)
class Info:
    """Tell what a run folder holds: results, events, versions, files."""

    run: Positional[RunPath]
    json: bool = False
    """Print one JSON object."""


@dataclass(frozen=True)
class BugReport:
    """Pack what helps to find a mistake into one ZIP file: versions, OpenGL, the run."""

    run: Positional[
        Annotated[Path | None, _arg("[RUN]", "run folder; without one, this machine alone")]
    ] = None
    out: Path = Path("hsr8-bug-report.zip")
    """File to write."""
    json: bool = False
    """Print one JSON object."""


@dataclass(frozen=True)
class Schema:
    """Print the JSON Schema of scenario files, for editors that check as one types."""

    out: Annotated[Path | None, _arg("FILE", "file to write; else standard output")] = None


@dataclass(frozen=True)
class Completion:
    """Print the completion script of a shell; `--help` says where it goes.

    bash: hsr8 completion bash > ~/.local/share/bash-completion/completions/hsr8

    zsh: hsr8 completion zsh > ~/.zfunc/_hsr8, in a folder of $fpath

    fish: hsr8 completion fish > ~/.config/fish/completions/hsr8.fish
    """

    shell: Positional[Literal["bash", "zsh", "fish"]] = "bash"
    """Shell to complete in."""


@dataclass(frozen=True)
class Check:
    """Check a scenario without running it: settings, world, fairness."""

    scenario: Positional[ScenarioName]
    seed: Annotated[int | None, _arg("N", "seed of the world; else the scenario's")] = None
    set: Settings = ()
    picture: Annotated[
        Path | None, _arg("FILE", "draw the world and the certificate's way as a PNG")
    ] = None
    json: bool = False
    """Print one JSON object."""


@dataclass(frozen=True)
class CheckReplay:
    """Compute a run again: physics, belief and decisions from their records, bit for bit."""

    run: Positional[RunPath]
    json: bool = False
    """Print one JSON object."""


@dataclass(frozen=True)
class Doctor:
    """Look whether everything is in place: OpenGL, libraries, models, disk."""

    json: bool = False
    """Print one JSON object."""


@dataclass(frozen=True)
class Render:
    """Draw the video of a run: H.264, with a thumbnail beside it."""

    run: Positional[RunPath]
    camera: str = "dashboard"
    """dashboard, follow, head, top, or any camera of the model."""
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
            "by default video.mp4 in the run folder; .gif and .webp are animations, "
            ".png is one picture, at --start",
        ),
    ] = None
    start: float = 0.0
    """Simulated time at which the video begins [s]."""
    stop: Annotated[float | None, _arg("S", "simulated time at which it ends [s]")] = None
    speed: Annotated[
        float | None,
        _arg(
            "X",
            "simulated seconds per second of video; else so that it lasts a minute at most",
        ),
    ] = None
    json: bool = False
    """Print one JSON object."""
    quiet: bool = False
    """No progress bar."""


@dataclass(frozen=True)
class Replay:
    """Open the log of a run in the Rerun viewer."""

    run: Positional[RunPath]
    screenshot: Annotated[
        Path | None, _arg("PNG", "write a picture of the viewer instead; needs no display")
    ] = None
    time: Annotated[
        float | None, _arg("S", "simulated time of the picture [s]; else the middle of the run")
    ] = None
    size: str = "1600x900"
    """Width x height of the window [pixel]."""
    json: bool = False
    """Print one JSON object."""


@dataclass(frozen=True)
class Plot:
    """Plot how a run walked: ZMP, CoM, DCM, soles, velocities, torques, tilt."""

    run: Positional[RunPath]
    what: Literal["walking", "zmp", "footsteps", "velocity", "torques", "tilt"] = "walking"
    """What to plot; walking is all of it."""
    out: Annotated[
        Path | None, _arg("FILE", ".png, .svg or .pdf; by default a PNG in the run folder")
    ] = None
    start: Annotated[float, tyro.conf.arg(name="from", metavar="S")] = 0.0
    """Simulated time at which the plot begins [s]."""
    stop: Annotated[
        float | None,
        tyro.conf.arg(
            name="to",
            metavar="S",
            help="simulated time at which it ends [s]",
            help_behavior_hint="",
        ),
    ] = None
    json: bool = False
    """Print one JSON object."""


@dataclass(frozen=True)
class Colours:
    """Build a colour table for vision from labelled images.

    Beside each image, NAME.png or NAME.jpg, lies its mask, NAME.mask.png: black where there
    is nothing to recognise, white where nobody has judged, else the colour that marks the
    class. A wrong mask is refused with the list of these colours.
    """

    images: Positional[Annotated[tuple[Path, ...], _arg("IMAGE", "images with masks beside them")]]
    out: Path = Path("colours.npz")
    """File of the table; name it in a scenario as vision.color_table."""
    json: bool = False
    """Print one JSON object."""


Command = (
    Run
    | Sweep
    | Compare
    | List
    | Check
    | CheckReplay
    | Info
    | Diff
    | Render
    | Replay
    | Plot
    | Colours
    | Schema
    | Completion
    | Doctor
    | BugReport
)
