"""Commands and their options; no heavy import, so that ``--help`` is fast."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from tyro.conf import Positional, UseAppendAction, arg

from hsr8.cli.option_types import (
    AnyRunPath,
    Body,
    Camera,
    EntrySettings,
    File,
    Flag,
    Integer,
    Json,
    Number,
    Quiet,
    RunPath,
    Scenario,
    Seconds,
    Settings,
    Text,
    Values,
    View,
)
from hsr8.cli.robot_options import Robot


@dataclass(frozen=True)
class ScenarioOptions:
    """Scenario and changes of its settings."""

    scenario: Scenario
    robot: Text = None
    """Robot: a shipped name or the file of a description; default: that of the scenario."""
    set: Settings = ()


@dataclass(frozen=True, kw_only=True)
class RunOptions(ScenarioOptions):
    """Scenario of one or several runs."""

    duration: Seconds = None
    """Maximum simulated time [s]; default: that of the scenario."""
    body: Body = None
    """Full physics, or feet that land exactly as planned (faster)."""
    camera: Camera = None
    """rendered: OpenGL; analytic: geometry only; neck-reach, omnidirectional: bounds."""
    trust: Flag = False
    """Run the code of plugins that the scenario names outside of its folder."""


@dataclass(frozen=True, kw_only=True)
class Run(RunOptions):
    """Run a scenario and record it: physics, head camera, belief, gaze, walking."""

    seed: Integer = None
    """Seed of world and noise; default: that of the scenario."""
    out: Annotated[Path, arg(metavar="DIR")] = Path("runs")
    """Parent folder of run folders."""
    log: Flag = False
    """Also write the Rerun log at the end; `hsr8 replay` makes it otherwise."""
    view: View = None
    """Show the log during the run: in a window or in a browser."""
    video: Flag = False
    """Also draw the video, after the run."""
    bag: Flag = False
    """Also write the run as a rosbag2 folder, see `hsr8 export`."""
    ros: Flag = False
    """Publish ROS 2 topics over Zenoh during the run, on this machine; needs the extra `ros`."""
    ros_domain: int = 0
    """ROS domain."""
    ros_connect: Text = None
    """Zenoh endpoint to connect to, such as tcp/HOST:7447, the router of another machine."""
    ros_listen: Text = None
    """Zenoh endpoint to listen on, such as tcp/0.0.0.0:7447; default: tcp/127.0.0.1:7447."""
    ros_drive: Flag = False
    """Follow /cmd_vel instead of the planner, and /head/command instead of the gaze."""
    pace: Number = None
    """Simulated seconds per second at most, 0: unlimited; default: 1 with --ros, else unlimited."""
    json: Json = False
    quiet: Quiet = False


@dataclass(frozen=True, kw_only=True)
class Sweep(RunOptions):
    """Run a scenario over many seeds in parallel and summarize the results.

    Runs with a result in the folder are not repeated: the same command line continues a
    stopped sweep, and further seeds are added. Started on several machines with a shared disk,
    it shares the work.
    """

    seeds: Annotated[str, arg(metavar="SEEDS")]
    """A:B for A to B-1, or a list: 1000:1200, 1,5,9, or 0:10,42."""
    out: Annotated[File, arg(metavar="DIR")] = None
    """Folder of the sweep; default: sweeps/ and the scenario's name."""
    workers: Integer = None
    """Parallel runs; default: number of CPUs."""
    vary: Values = ()
    """Also vary a setting, one folder per value; repeated: all combinations."""
    executor: str = "local"
    """Executor: local, or dask://HOST:PORT for a Dask cluster."""
    timeout: Seconds = None
    """Wall-clock limit per run [s]; default: 60 s + 20 x its duration."""
    keep: Literal["all", "failed", "none"] = "all"
    """Runs to keep tables of, 200 to 300 kB per simulated second; failed: those without success."""
    json: Json = False
    quiet: Quiet = False


@dataclass(frozen=True, kw_only=True)
class ComparisonOutput:
    """Outputs of a comparison."""

    csv: File = None
    """Also write a line per arm and metric as CSV."""
    latex: Flag = False
    """Print a LaTeX table in place of Markdown."""
    figure: File = None
    """Also draw the differences with their intervals: .png, .svg or .pdf."""
    json: Json = False


@dataclass(frozen=True, kw_only=True)
class Compare(ComparisonOutput):
    """Compare sweeps or runs with a reference on common seeds: paired differences with tests."""

    a: Positional[Annotated[Path, arg(metavar="A")]]
    """Reference: folder of a sweep or of a run."""
    b: Positional[Annotated[tuple[Path, ...], arg(metavar="B", help_behavior_hint="")]]
    """Folders to compare with A."""
    metric: UseAppendAction[
        Annotated[tuple[str, ...], arg(metavar="KEY", help_behavior_hint="")]
    ] = ()
    """Numeric key of metrics.json; may be repeated; default: the usual ones."""


@dataclass(frozen=True)
class Bench:
    """Benchmark a planner, gaze or walker: six families of worlds with fixed seeds.

    Writes bench.json, report.md and a sweep folder per family. Runs with a result in the folder
    are not repeated: the same command line continues a stopped benchmark.
    `hsr8 bench compare A B` compares two entries on their common worlds.
    """

    quick: Flag = False
    """Only the first seeds of every family: a few minutes on two cores."""
    name: Text = None
    """Name of the entry in tables; default: its settings, or "default"."""
    set: EntrySettings = ()
    body: Body = None
    """Full physics in place of the standard, footsteps that land exactly as planned."""
    camera: Camera = None
    """Camera in place of the standard, analytic."""
    suite: File = None
    """Suite, a TOML file; default: the one shipped."""
    out: Annotated[File, arg(metavar="DIR")] = None
    """Folder of the entry; default: bench/, the name of a custom suite, and that of the entry."""
    workers: Integer = None
    """Parallel runs; default: number of CPUs."""
    timeout: Seconds = None
    """Wall-clock limit per run [s]; default: 60 s + 20 x its duration."""
    keep: Literal["all", "failed", "none"] = "none"
    """Runs to keep tables of, 200 to 300 kB per simulated second; failed: those without success."""
    json: Json = False
    quiet: Quiet = False


@dataclass(frozen=True, kw_only=True)
class BenchCompare(ComparisonOutput):
    """Compare entries of `hsr8 bench` with a reference on their common worlds."""

    a: Positional[Annotated[Path, arg(metavar="A")]]
    """Reference: folder of an entry, or its bench.json."""
    b: Positional[Annotated[tuple[Path, ...], arg(metavar="B", help_behavior_hint="")]]
    """Entries to compare with A."""


@dataclass(frozen=True)
class List:
    """List the built-in scenarios."""

    json: Json = False


@dataclass(frozen=True, kw_only=True)
class Check(ScenarioOptions):
    """Check a scenario without running it: settings, world, feasibility."""

    seed: Integer = None
    """Seed of the world; default: that of the scenario."""
    image: File = None
    """Draw the world and the path of the feasibility certificate as a PNG."""
    json: Json = False


@dataclass(frozen=True)
class Verify:
    """Recompute a run from its records and compare physics, belief and decisions bit for bit."""

    run: RunPath
    trust: Flag = False
    """Run the code of the plugins that the run folder names."""
    json: Json = False


@dataclass(frozen=True)
class Info:
    """Show a run folder: results, events, versions, files."""

    run: AnyRunPath = None
    all: Flag = False
    """All results; default: the first eight."""
    bibtex: Flag = False
    """Print the references of this program and of the paper instead; needs no RUN."""
    json: Json = False


@dataclass(frozen=True)
class Diff:
    """Compare two runs bit for bit: first tick, channel and values that differ."""

    a: RunPath
    b: RunPath
    json: Json = False


@dataclass(frozen=True)
class Render:
    """Render the video of a run: H.264, with a thumbnail."""

    run: RunPath
    camera: str = "dashboard"
    """Camera: dashboard, follow, head, top, or any camera of the model."""
    fps: int = 25
    """Frames per second of the video [1/s]."""
    size: str = "960x540"
    """Width x height [pixel]; 1280x720 takes 1.3 times as long."""
    fine: Flag = False
    """Smooth edges and sharper shadows, at twice the cost."""
    out: File = None
    """Video (.mp4, .webp) or image (.png, at --from); default: run folder, video.mp4."""
    start: Annotated[float, arg(name="from", metavar="S")] = 0.0
    """Simulated time at which the video begins [s]."""
    stop: Annotated[Seconds, arg(name="to")] = None
    """Simulated time at which the video ends [s]."""
    speed: Number = None
    """Simulated seconds per second of video; default: a video of at most a minute."""
    json: Json = False
    quiet: Quiet = False


@dataclass(frozen=True)
class Replay:
    """Open the log of a run in the Rerun viewer; a missing log is made from the tables."""

    run: RunPath
    full: Flag = False
    """Make the log again, with every record and frame; default: 17 poses, 6 frames per second."""
    view: View = None
    """native (default): a window; web: a page for a browser on this machine."""
    screenshot: File = None
    """Write a screenshot of the viewer as a PNG instead; needs no display."""
    time: Seconds = None
    """Simulated time of the screenshot [s]; default: the middle of the run."""
    size: str = "1600x900"
    """Width x height of the window [pixel]."""
    json: Json = False


@dataclass(frozen=True)
class Plot:
    """Plot the walking of a run: ZMP, CoM, DCM, soles, velocities, torques, tilt."""

    run: RunPath
    what: Literal["walking", "zmp", "footsteps", "velocity", "torques", "tilt"] = "walking"
    """Quantity to plot; walking is all of them."""
    out: File = None
    """Figure, .png, .svg or .pdf; default: a PNG in the run folder."""
    start: Annotated[float, arg(name="from", metavar="S")] = 0.0
    """Simulated time at which the plot begins [s]."""
    stop: Annotated[Seconds, arg(name="to")] = None
    """Simulated time at which the plot ends [s]."""
    json: Json = False


@dataclass(frozen=True)
class Export:
    """Export runs, a robot or a world in the formats of other tools.

    Existing files and folders are not overwritten.
    """

    runs: Positional[Annotated[tuple[Path, ...], arg(metavar="RUN", help_behavior_hint="")]] = ()
    """Run folder, or a parent folder for its newest run; a scenario for --irsim and --map."""
    bag: Annotated[File, arg(metavar="DIR")] = None
    """New rosbag2 folder of the run (MCAP); needs the extra `ros`."""
    csv: Annotated[File, arg(metavar="DIR")] = None
    """New folder of CSV files, one per table, with units in columns.csv."""
    lerobot: Annotated[File, arg(metavar="DIR")] = None
    """New LeRobotDataset v3.0 with one episode per RUN."""
    urdf: File = None
    """URDF file of the robot, with its meshes in a folder next to it."""
    robot: Text = None
    """Robot of --urdf: a shipped name or a description file; default: that of RUN, or hsr8."""
    irsim: File = None
    """World of the run or scenario for IR-SIM, a YAML file."""
    map: File = None
    """Map of its static obstacles for the ROS map server, YAML, with a PGM file next to it."""
    seed: Integer = None
    """Seed of the world of a scenario; default: that of the scenario."""
    json: Json = False


@dataclass(frozen=True)
class ColorTable:
    """Learn a color table for vision from labelled images.

    The mask of NAME.png or NAME.jpg is NAME.mask.png in the same folder. Pixels of the mask are
    black for background, white for "not labelled", or the color that marks a class. A wrong
    mask is refused with the list of these colors.
    """

    images: Positional[Annotated[tuple[Path, ...], arg(metavar="IMAGE", help_behavior_hint="")]]
    """Images that have masks."""
    out: Path = Path("colors.npz")
    """File of the table; value of vision.color_table in a scenario."""
    json: Json = False


@dataclass(frozen=True)
class Schema:
    """Print the JSON Schema of scenario files, for completion and checks in editors."""

    out: File = None
    """File to write; default: standard output."""


@dataclass(frozen=True)
class Doctor:
    """Check the installation: OpenGL, libraries, models, disk."""

    compile: Flag = False
    """Also compile the kernels, which the first run does otherwise."""
    json: Json = False


OfRun = Verify | Info | Diff | Render | Replay | Plot | Export
OfMany = Sweep | Compare | Bench
Command = Run | OfMany | List | Check | OfRun | Robot | ColorTable | Schema | Doctor
