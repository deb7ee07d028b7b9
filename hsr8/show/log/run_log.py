"""Log of a run for the Rerun viewer: a function of the run's tables."""

from collections import deque
from collections.abc import Iterator
from pathlib import Path

import mujoco
import numpy as np
import rerun as rr
from numpy.typing import NDArray

from hsr8.files import atomic
from hsr8.recording import palette, run_folder
from hsr8.recording.derived import Speedometer
from hsr8.recording.recorder import Tables
from hsr8.recording.run import Run
from hsr8.recording.table import Table
from hsr8.recording.write_errors import failure, writing
from hsr8.robots.loaded import LoadedRobot, load_robot
from hsr8.robots.scale import DEFAULT_ROBOT, DEFAULT_STATURE
from hsr8.robots.shown import stature, visual_model
from hsr8.scenario.schema import Scenario
from hsr8.show.log.belief import log_belief, style_belief
from hsr8.show.log.blueprint import RobotView, blueprint
from hsr8.show.log.camera import log_camera, log_gaze, log_gaze_window, style_camera
from hsr8.show.log.decisions import LANES, PLOTS, log_clearance, log_decisions, style_plots
from hsr8.show.log.robot import RobotShapes, followed_entity
from hsr8.show.log.shapes import sole_outline
from hsr8.show.log.stream import ABANDONED, APPLICATION, LogStream
from hsr8.show.log.walking import log_every_record, log_walking, style_walking
from hsr8.show.log.world import PATH_HEIGHT, WorldShapes, log_footsteps, log_via_points
from hsr8.simulation.robot_builder import build_model
from hsr8.world.field.generator import draw_layout
from hsr8.world.field.layout import Layout

Array = NDArray[np.float64]

POSE_PERIOD, FRAME_PERIOD = 0.06, 0.18  # intervals of poses and curves, and of camera frames [s]
TRAIL, TRAIL_PERIOD = 60.0, 0.12  # length of the path shown, interval between its points [s]
PATH_PERIOD = 1.0  # interval between two paths [s]
BATCH = 500  # records of a batch of a finished run, which bounds the memory
WRITE_TIMEOUT = 20.0  # wall time until a batch must be written [s]
MAX_INDEXED = 600.0  # logs of longer runs have no index, which is held in memory [s]
LEVELS = {"fall": "ERROR", "diverged": "ERROR"} | dict.fromkeys(
    ("collision", "fault", "lost", "push"), "WARN"
)


class RunLog:
    """Log of a run, a sink of its recorder: pass the tables to `add`, in any batches.

    Args:
        target: file to write, or address of a viewer that shows the log during the run.
        world: compiled world, robot in it, and layout.
        scenario: scenario of the run.
        name: name of the recording.
        full: log every record and frame.

    Raises:
        OSError, RuntimeError: the file cannot be written.
    """

    def __init__(
        self,
        target: Path | str,
        world: tuple[mujoco.MjModel, LoadedRobot, Layout],
        scenario: Scenario,
        *,
        name: str,
        full: bool = False,
    ) -> None:
        model, robot, layout = world
        self._pose_period, self._frame_period = (0.0, 0.0) if full else (POSE_PERIOD, FRAME_PERIOD)
        # Without this call Rerun keeps the threads of streams that are no longer used. It waits for
        # all streams, so it fails after one that was abandoned.
        if not ABANDONED:
            rr.init(APPLICATION, init_logging=False)
        self.stream = log = LogStream(name)
        indexed = scenario.duration <= MAX_INDEXED
        is_file = isinstance(target, Path)
        sink = rr.FileSink(str(target), write_footer=indexed) if is_file else rr.GrpcSink(target)
        view = _view(robot)
        walking = len(layout.waypoints) == 0
        log.begin(sink, blueprint(max(layout.field_size), walking=walking, robot=view))
        log.send_recording_name(f"{scenario.name} {scenario.seed}")
        log.log("/", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        self._gaze = scenario.navigation.gaze
        self._camera = scenario.camera.pinhole
        self._model, self._sole = robot.model, sole_outline(robot.model.sole)
        self._scale, self._robot_scale = layout.scale, view.size
        self._world, self._robot = WorldShapes(log, model, layout), RobotShapes(log, robot)
        style_camera(log, self._camera, view.size)
        style_belief(log, layout.scale)
        style_plots(log, PLOTS, LANES)
        style_walking(log, robot.model, view.size)
        log_via_points(log, layout)
        self._meter = Speedometer()
        self._trail: deque[list[float]] = deque(maxlen=round(TRAIL / TRAIL_PERIOD))
        self._time = 0.0

    def add(self, tables: Tables) -> None:
        """Log new rows of the tables."""
        records, frames = tables.get("records"), tables.get("frames")
        if records is not None:
            self._time = float(records["time"][-1])
            self._add_records(records)
            if frames is not None:
                self._add_frames(records, frames, tables.get("images"))
        if "events" in tables:
            for event in tables["events"].objects():
                self._log_event(event.time, event.kind, event.text)

    def close(self, exit_reason: str) -> None:
        """Log the end."""
        self._log_event(self._time, "end", exit_reason)
        self.stream.disconnect()

    def require_written(self, folder: Path) -> None:
        """Wait until the operating system has all rows of the file; abandon the log otherwise.

        Args:
            folder: folder of the run, for the message.

        Raises:
            RecordingFailed: the file cannot be written.
        """
        try:
            self.stream.flush(timeout_sec=WRITE_TIMEOUT)
        except RuntimeError as error:
            self.stream.abandon()
            reason = f"the log could not be written, is the disk full? ({error})"
            raise failure(folder, reason) from error

    def _log_event(self, time: float, kind: str, text: str) -> None:
        level = LEVELS.get(kind, "INFO")
        times, texts = np.array([time]), [f"{kind}: {text}"]
        self.stream.rows("/events", rr.TextLog, times, text=texts, level=[level])

    def _add_records(self, records: Table) -> None:
        log = self.stream
        log_every_record(log, records, self._meter, self._model, self._robot_scale)
        shown = records.take(log.due("poses", records["time"], self._pose_period))
        if not len(shown):
            return
        self._robot.log(log, shown["time"], shown["qpos"])
        self._world.log(log, shown)
        log_clearance(log, shown)
        log_walking(log, shown, self._model, self._robot_scale)

    def _add_frames(self, records: Table, frames: Table, images: Table | None) -> None:
        log = self.stream
        shown = frames.take(log.due("frames", frames["time"], self._frame_period))
        log_camera(log, shown, images)
        log_gaze_window(log, shown, self._camera)
        log_gaze(log, frames, self._gaze)
        log_belief(log, frames, shown, self._scale)
        if not len(shown):
            return
        times, true = shown["time"], records.take(records.at(shown["time"]))
        log_decisions(log, shown, true["robot"])
        self._add_path(times, true["robot"])
        log_footsteps(log, true, times, self._sole)

    def _add_path(self, times: Array, truth: Array) -> None:
        """Extend the path by true poses (n, 3) and log it once per second."""
        rows = self.stream.due("trail", times, TRAIL_PERIOD)
        ends = set(self.stream.due("path", times[rows], PATH_PERIOD).tolist())
        paths = []
        for k, row in enumerate(rows.tolist()):
            x, y, _ = truth[row].tolist()
            self._trail.append([x, y, PATH_HEIGHT])
            if k in ends:
                paths.append(np.array(self._trail))
        self.stream.rows(
            "/world/path",
            rr.LineStrips3D,
            times[rows[sorted(ends)]],
            strips=paths,
            colors=palette.packed_all([palette.TRUTH] * len(paths)),
            radii=np.full(len(paths), 0.006),
        )


def write_log(run: Run, *, full: bool = False) -> Path:
    """Write the log of a run into its folder and return the file.

    Args:
        run: run that has ended, or was killed.
        full: log every record and frame.

    Raises:
        UsageError: a table is damaged, or the scenario cannot be read.
        RecordingFailed: the log cannot be written.
    """
    scenario, file = run.scenario(), run.folder / run_folder.LOG
    layout, robot = draw_layout(scenario, run.seed), load_robot(scenario.robot.model)
    world = build_model(scenario, layout), robot, layout
    batches = [*_batches(run)]  # reports damage before a file is begun
    with writing(run.folder), atomic.draft(file) as draft:
        log = RunLog(draft, world, scenario, name=run.folder.name, full=full)
        for batch in batches:
            log.add(batch)
            log.require_written(run.folder)
        log.close(run.exit_reason)
    return file


def _batches(run: Run) -> Iterator[Tables]:
    """Yield the tables of a run in parts, each of which ends with a record."""
    tables: Tables = {
        name: getattr(run, name) for name in ("records", "frames", "events", "images")
    }
    times = tables["records"]["time"]
    ends = [*times[BATCH - 1 :: BATCH].tolist(), float("inf")]
    firsts = dict.fromkeys(tables, 0)
    for end in ends:
        part = {}
        for name, table in tables.items():
            last = int(np.searchsorted(table["time"], end + 1e-9))
            if last > firsts[name]:
                part[name] = table.rows(firsts[name], last)
                firsts[name] = last
        if part:
            yield part


def _view(robot: LoadedRobot) -> RobotView:
    """Return a robot as the views need it."""
    name = "HSR-VIII" if robot.name == DEFAULT_ROBOT else robot.name
    entity = followed_entity(visual_model(robot), robot.roles.base)
    return RobotView(name, entity, stature(robot) / DEFAULT_STATURE)
