"""Log of a run for the Rerun viewer, ``log.rrd``: a function of its tables."""

from math import cos, sin
from pathlib import Path

import mujoco
import numpy as np
import rerun as rr
from numpy.typing import NDArray

from hsr8.files.writing import failure
from hsr8.recorder import palette
from hsr8.recorder.derived import WorldFrame
from hsr8.recorder.log.belief_layer import BeliefLayer
from hsr8.recorder.log.blueprint import RobotView, blueprint
from hsr8.recorder.log.camera_layer import CameraLayer
from hsr8.recorder.log.channel import APPLICATION, TIMELINE, BlockStream, Channel
from hsr8.recorder.log.geometry import Scene, sole_outline
from hsr8.recorder.log.plan_layer import PlanLayer
from hsr8.recorder.log.plot_layer import PlotLayer
from hsr8.recorder.log.robot_layer import RobotLayer, followed_entity
from hsr8.recorder.log.walk_layer import WalkLayer
from hsr8.recorder.log_level import RATES, LogLevel
from hsr8.recorder.recorder import Tables
from hsr8.recorder.table import Table
from hsr8.recorder.throttle import Throttle
from hsr8.robots.loaded import LoadedRobot
from hsr8.robots.scale import DEFAULT_ROBOT, DEFAULT_STATURE
from hsr8.robots.shown import stature, visual_model
from hsr8.scenario.schema import Scenario
from hsr8.world.field.layout import Layout

Array = NDArray[np.float64]

APRON = 1.0  # margin of the floor around the field, both sides together, at scale 1 [m]
SOLE_HEIGHT = 0.004  # height of drawn footsteps [m]
MAX_LABELS = 12  # more waypoints than this are shown without numbers
WRITE_TIMEOUT = 20.0  # wall time until a batch must be written [s]
TRAIL, TRAIL_PERIOD = 60.0, 0.12  # length of the path shown, interval between its points [s]
BATCHES = 10  # logged together: the cost of Rerun is by call
MAX_INDEXED = 600.0  # logs of longer runs have no index, which is held in memory [s]
LEVELS = {"fall": "ERROR", "diverged": "ERROR"} | dict.fromkeys(
    ("collision", "fault", "lost", "push"), "WARN"
)


class RerunLog:
    """Log of a run: pass each batch of tables to `add`, all of a finished run at once.

    Args:
        path: file to write.
        world: compiled world, robot in it, and layout.
        scenario: of the run.
        level: level of detail.
        live: address of a viewer that shows the log during the run; empty for none.
        name: of the recording; that of the folder by default.

    Raises:
        RecordingFailed: here and in every method, the file cannot be written.
    """

    def __init__(
        self,
        path: Path,
        world: tuple[mujoco.MjModel, LoadedRobot, Layout],
        scenario: Scenario,
        *,
        level: LogLevel = LogLevel.STANDARD,
        live: str = "",
        name: str = "",
    ) -> None:
        model, robot, layout = world
        rates = RATES[level]
        self._pose_throttle, self._frame_throttle = Throttle(rates.pose), Throttle(rates.frame)
        self._trail_throttle, self._path_throttle = Throttle(TRAIL_PERIOD), Throttle(1.0)
        # Without this call Rerun keeps the threads of streams that are no longer used.
        rr.init(APPLICATION, init_logging=False)
        self._stream = BlockStream(name or path.parent.name)
        self._stream.set_log_time_enabled(False)
        sinks = [rr.FileSink(str(path), write_footer=scenario.duration <= MAX_INDEXED)]
        sinks += [rr.GrpcSink(live)] if live else []
        self._folder = path.parent
        self._waits = not live  # for the file; a viewer may disconnect
        self._failed = False
        view = _view(robot)
        shown = blueprint(
            max(layout.field_size),
            robot=view,
            walking=len(layout.waypoints) == 0,
            images=rates.belief,
        )
        try:
            self._stream.begin(sinks, shown)
        except (OSError, RuntimeError) as error:
            raise failure(self._folder, f"the log: {error}") from error
        self._stream.send_recording_name(f"{scenario.name} {scenario.seed}")
        self._stream.log("/", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        self._n_movers = len(layout.movers)
        width, depth = (side + APRON * layout.scale for side in layout.field_size)
        self._scene = Scene(self._stream, model, (width, depth))
        self._robot = RobotLayer(self._stream, robot)
        self._sole = sole_outline(robot.model.sole)
        self._camera: CameraLayer | None = None
        self._belief: BeliefLayer | None = None
        self._plan: PlanLayer | None = None
        if rates.belief:
            size, gaze = (scenario.camera.width, scenario.camera.height), scenario.navigation.gaze
            self._camera = CameraLayer(self._stream, model, size, gaze, scale=view.size)
            self._belief = BeliefLayer(self._stream, layout.scale)
            self._plan = PlanLayer(self._stream, layout.scale)
        self._plots = PlotLayer(self._stream)
        self._walk = WalkLayer(self._stream, robot.model, view.size)
        self._footsteps = Channel(self._stream, "/world/footsteps", rr.LineStrips3D)
        self._path = Channel(self._stream, "/world/path", rr.LineStrips3D)
        self._trail: list[list[float]] = []
        self._log_waypoints(layout)
        self._time = 0.0
        self._batches: list[Tables] = []
        self._together = 1 if live else BATCHES

    def add(self, tables: Tables) -> None:
        """Log new rows of the tables, several batches at a time without a viewer."""
        self._batches.append(tables)
        if len(self._batches) >= self._together:
            self._flush()

    def _flush(self) -> None:
        batches, self._batches = self._batches, []
        names = {name for batch in batches for name in batch}
        self._add({name: Table.joined([b[name] for b in batches if name in b]) for name in names})

    def _add(self, tables: Tables) -> None:
        records, frames = tables.get("records"), tables.get("frames")
        if records is not None:
            self._time = float(records["time"][-1])
            self._add_records(records)
            if frames is not None:
                self._add_frames(records, frames, tables.get("images"))
        if "events" in tables:
            events = tables["events"]
            columns = (events["time"].tolist(), events["kind"], events["text"])
            for time, kind, text in zip(*columns, strict=True):
                self._log_event(time, kind, text)
        self._send()

    def close(self, exit_reason: str) -> None:
        """Log the end and close the file."""
        try:
            if self._batches:
                self._flush()
            self._wait()
            self._log_event(self._time, "end", exit_reason)
        finally:
            if self._failed:
                self._stream.abandon()
            else:
                self._stream.disconnect()

    def _log_event(self, time: float, kind: str, text: str) -> None:
        self._stream.set_time(TIMELINE, duration=time)
        level = LEVELS.get(kind, "INFO")
        self._stream.log("/events", rr.TextLog(f"{kind}: {text}", level=level))

    def _add_records(self, records: Table) -> None:
        self._walk.watch(records)
        shown = records.take(self._pose_throttle.select(records["time"]))
        if not len(shown):
            return
        times, qpos, obstacles = shown["time"].tolist(), shown["qpos"], shown["obstacle_positions"]
        self._robot.add(times, qpos)
        poses = self._scene.add(times, qpos, obstacles[:, obstacles.shape[1] - self._n_movers :])
        if self._camera is not None:
            self._camera.add_poses(times, *poses)
        self._plots.add(shown)
        self._walk.add(shown)

    def _add_frames(self, records: Table, frames: Table, images: Table | None) -> None:
        shown = frames.take(self._frame_throttle.select(frames["time"]))
        if self._camera is not None and self._belief is not None and self._plan is not None:
            self._camera.add_frames(frames, shown, images)
            self._belief.add(frames, shown)
            self._plan.add(frames)
        if not len(shown):
            return
        rows = records.at(shown["time"])
        truth = records["robot"][rows]
        self._plots.add_frames(shown, truth)
        self._add_path(shown["time"], truth)
        self._add_footsteps(records.take(rows), shown["time"].tolist())

    def _add_path(self, times: Array, truth: Array) -> None:
        """Extend the path by true poses (n, 3) and log it once per second."""
        for row in self._trail_throttle.select(times).tolist():
            x, y, _ = truth[row].tolist()
            self._trail.append([x, y, 0.003])
            if self._path_throttle.due(float(times[row])):
                del self._trail[: -round(TRAIL / TRAIL_PERIOD)]
                self._path.add(
                    float(times[row]),
                    strips=[np.array(self._trail)],
                    colors=palette.packed_all([palette.TRUTH]),
                    radii=np.array([0.006]),
                )

    def _add_footsteps(self, records: Table, times: list[float]) -> None:
        """Log planned footsteps, transformed with the true pose."""
        steps, frame = records["footsteps"], WorldFrame(records)
        rows, left = steps.parents, steps["left"]
        yaws = steps["yaw"] + frame.turn[rows]
        c, s = np.cos(yaws), np.sin(yaws)
        outlines = np.full((len(steps), len(self._sole), 3), SOLE_HEIGHT)
        outlines[..., :2] = self._sole @ np.moveaxis(np.array([[c, s], [-s, c]]), 2, 0)
        positions = frame.point(np.column_stack([steps["x"], steps["y"]]), rows)
        outlines[..., :2] += positions[:, None]
        colors = palette.packed_all((palette.RIGHT_FOOT, palette.LEFT_FOOT))
        self._footsteps.add_rows(
            times,
            steps.counts.tolist(),
            strips=outlines,
            colors=colors[left.astype(np.intp)],
            radii=np.full(len(steps), 0.004),
        )

    def _send(self) -> None:
        """Send all rows; Rerun's threads write them while the run goes on."""
        self._wait()
        self._stream.send()
        if self._waits:
            self._stream.flush(timeout_sec=0.0)

    def _wait(self) -> None:
        """Wait until the operating system has all rows sent so far."""
        if not self._waits:
            return
        try:
            self._stream.flush(timeout_sec=WRITE_TIMEOUT)
        except RuntimeError as error:
            self._waits, self._failed = False, True  # a second flush would time out, too
            reason = f"the log could not be written, is the disk full? ({error})"
            raise failure(self._folder, reason) from error

    def _log_waypoints(self, layout: Layout) -> None:
        points = np.asarray(layout.waypoints, float).reshape(-1, 2)
        if len(points) == 0:
            return
        has_goal = layout.goal_heading is not None and not layout.endless
        labels = [str(i + 1) for i in range(len(points))]
        if has_goal:
            labels[-1] = "goal"
        self._stream.log(
            "/world/waypoints",
            rr.Points3D(
                np.column_stack([points, np.full(len(points), 0.01)]),
                radii=layout.scale * (0.03 if len(points) <= MAX_LABELS else 0.012),
                colors=[palette.TARGET],
                labels=labels,
                show_labels=len(points) <= MAX_LABELS,
            ),
            static=True,
        )
        if has_goal and layout.goal_heading is not None:
            c, s = cos(layout.goal_heading), sin(layout.goal_heading)
            heading = rr.Arrows3D(
                origins=[[*points[-1].tolist(), 0.01]],
                vectors=[[0.25 * layout.scale * c, 0.25 * layout.scale * s, 0.0]],
                colors=[palette.TARGET],
                radii=0.01,
            )
            self._stream.log("/world/waypoints/heading", heading, static=True)


def _view(robot: LoadedRobot) -> RobotView:
    """Return a robot as the views need it."""
    name = "HSR-VIII" if robot.name == DEFAULT_ROBOT else robot.name
    entity = followed_entity(visual_model(robot), robot.roles.base)
    return RobotView(name, entity, stature(robot) / DEFAULT_STATURE)
