"""Listener that writes the log of a run for the Rerun viewer, ``log.rrd``."""

from collections.abc import Sequence
from math import cos, sin
from pathlib import Path

import mujoco
import numpy as np
import rerun as rr
import rerun_bindings
from numpy.typing import NDArray

from hsr8.record import TickRecord
from hsr8.recorder import palette
from hsr8.recorder.files.writing import failure
from hsr8.recorder.log.belief_layer import BeliefLayer
from hsr8.recorder.log.block_stream import BlockStream
from hsr8.recorder.log.blueprint import RobotView, blueprint
from hsr8.recorder.log.camera_layer import CameraLayer
from hsr8.recorder.log.channel import TIMELINE, Channel
from hsr8.recorder.log.geometry import Scene, sole_outline
from hsr8.recorder.log.plan_layer import PlanLayer
from hsr8.recorder.log.plot_layer import PlotLayer
from hsr8.recorder.log.record_frame import OdometryToWorld
from hsr8.recorder.log.robot_layer import RobotLayer, followed_entity
from hsr8.recorder.log.walk_layer import WalkLayer
from hsr8.recorder.log_level import RATES, LogLevel
from hsr8.recorder.record_buffer import PERIOD, RecordBuffer
from hsr8.recorder.throttle import Throttle
from hsr8.robots.loaded import LoadedRobot
from hsr8.robots.scale import DEFAULT_ROBOT, DEFAULT_STATURE
from hsr8.robots.shown import visual_model
from hsr8.world.field.layout import Layout
from navigation.parameters.gaze import GazeParameters

Array = NDArray[np.float64]

APRON = 1.0  # margin of the floor around the field, both sides together, at scale 1 [m]
LIVE_PERIOD = 0.5  # interval between two batches while a viewer is connected [s]
SOLE_HEIGHT = 0.004  # height of drawn footsteps [m]
MAX_LABELS = 12  # more waypoints than this are shown without numbers
WRITE_TIMEOUT = 20.0  # wall time until a batch must be written [s]
TRAIL, TRAIL_PERIOD = 60.0, 0.12  # length of the path shown, interval between its points [s]
MAX_INDEXED = 600.0  # logs of longer runs have no index, which is held in memory [s]
LEVELS = {"fall": "ERROR", "diverged": "ERROR"} | dict.fromkeys(
    ("collision", "fault", "lost", "push"), "WARN"
)


class RerunLog:
    """Listener that logs a run.

    Args:
        path: file to write.
        model: compiled world.
        robot: in it.
        layout: of the run's world.
        image_size: width and height of the head camera's image [pixel].
        name: name of the recording in the viewer.
        gaze: parameters of the gaze map.
        level: level of detail.
        live: address of a viewer that shows the log during the run; empty for none.
        duration: longest time of the run; the log of a run up to `MAX_INDEXED` ends with an index
            of its parts, for tools that read single parts [s].

    Raises:
        RecordingFailed: here and in every method, the file cannot be written.
    """

    def __init__(
        self,
        path: Path,
        world: tuple[mujoco.MjModel, LoadedRobot, Layout],
        image_size: tuple[int, int],
        name: str,
        *,
        gaze: GazeParameters,
        level: LogLevel = LogLevel.STANDARD,
        live: str = "",
        duration: float = 0.0,
    ) -> None:
        model, robot, layout = world
        rates = RATES[level]
        self._pose_throttle, self._frame_throttle = Throttle(rates.pose), Throttle(rates.frame)
        self._trail_throttle = Throttle(TRAIL_PERIOD)
        # Without this call Rerun keeps the threads of streams that are no longer used.
        rerun_bindings.flush_and_cleanup_orphaned_recordings()
        self._stream = BlockStream(path.parent.name)
        self._stream.set_log_time_enabled(False)
        sinks = [rr.FileSink(str(path), write_footer=duration <= MAX_INDEXED)]
        sinks += [rr.GrpcSink(live)] if live else []
        self._folder = path.parent
        self._waits = not live  # for the file; a viewer may disconnect
        self._failed = False
        view = _view(robot)
        shown = blueprint(
            max(layout.field_size),
            robot=view,
            walking=len(layout.waypoints) == 0,
            images=rates.jpeg > 0,
        )
        try:
            self._stream.begin(sinks, shown)
        except RuntimeError as error:
            raise failure(self._folder, f"the log: {error}") from error
        self._stream.send_recording_name(name)
        self._stream.log("/", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        self._n_movers = len(layout.movers)
        width, depth = (side + APRON * layout.scale for side in layout.field_size)
        self._scene = Scene(self._stream, model, (width, depth))
        self._robot = RobotLayer(self._stream, robot)
        self._soles = (sole_outline(robot.model.sole),) * 2
        self._camera: CameraLayer | None = None
        self._belief_layers: tuple[BeliefLayer | PlanLayer, ...] = ()
        if rates.jpeg:
            self._camera = CameraLayer(
                self._stream, model, image_size, rates.jpeg, gaze, scale=view.size
            )
            self._belief_layers = (
                BeliefLayer(self._stream, rates.map, layout.scale),
                PlanLayer(self._stream, rates.map, layout.scale),
            )
        self._plots = PlotLayer(self._stream)
        self._walk = WalkLayer(self._stream, robot.model, view.size)
        self._footsteps = Channel(self._stream, "/world/footsteps", rr.LineStrips3D)
        self._path = Channel(self._stream, "/world/path", rr.LineStrips3D)
        self._trail: list[list[float]] = []
        self._log_waypoints(layout)
        self._buffer = RecordBuffer(LIVE_PERIOD if live else PERIOD)
        self._time = 0.0

    def on_record(self, record: TickRecord) -> None:
        """Log one record."""
        if self._buffer.add(record):
            self._write_buffer()

    def on_event(self, time: float, kind: str, text: str) -> None:
        """Log one event."""
        self._stream.set_time(TIMELINE, duration=time)
        level = LEVELS.get(kind, "INFO")
        self._stream.log("/events", rr.TextLog(f"{kind}: {text}", level=level))

    def close(self, exit_reason: str) -> None:
        """Write the remaining records and close the file."""
        try:
            self._write_buffer()
            self._wait()
            self.on_event(self._time, "end", exit_reason)
        finally:
            if self._failed:
                self._stream.abandon()
            else:
                self._stream.disconnect()

    def _add(self, records: Sequence[TickRecord]) -> None:
        self._time = records[-1].time
        shown = [record for record in records if self._pose_throttle.due(record.time)]
        if shown:
            times, truths = [r.time for r in shown], [r.truth for r in shown]
            first = len(truths[0].obstacle_positions) - self._n_movers
            movers = [truth.obstacle_positions[first:] for truth in truths]
            qpos = [truth.qpos for truth in truths]
            self._robot.add(times, qpos)
            poses = self._scene.add(times, qpos, movers)
            if self._camera is not None:
                self._camera.add_poses(times, *poses)
            self._plots.add(shown)
            self._walk.add(shown)
        for record in records:
            self._walk.watch(record)
        with_frame = [record for record in records if record.frame is not None]
        selected = [record for record in with_frame if self._frame_throttle.due(record.time)]
        if selected:
            self._add_frames(selected)

    def _add_frames(self, records: Sequence[TickRecord]) -> None:
        pairs = [(r.frame, r.truth.robot) for r in records if r.frame is not None]
        frames = [frame for frame, _ in pairs]
        if self._camera is not None:
            self._camera.add_frames(frames)
        for layer in self._belief_layers:
            layer.add(frames)
        self._plots.add_frames(pairs)
        for record in records:
            if self._trail_throttle.due(record.time):
                x, y, _ = record.truth.robot.tolist()
                self._trail.append([x, y, 0.003])
        self._add_footsteps(records, [frame.time for frame in frames])

    def _add_footsteps(self, records: Sequence[TickRecord], times: list[float]) -> None:
        """Log planned footsteps, transformed with the true pose."""
        steps = [step for record in records for step in record.walking.footsteps]
        counts = [len(record.walking.footsteps) for record in records]
        rows = np.repeat(np.arange(len(records)), counts)
        transform = OdometryToWorld(records)
        positions = transform.point(np.reshape([(f.x, f.y) for f in steps], (-1, 2)), rows)
        yaws = np.array([f.yaw for f in steps]) + transform.turn[rows]
        self._footsteps.add_rows(
            times,
            counts,
            strips=[
                self._sole(step.left, position, yaw)
                for step, position, yaw in zip(steps, positions, yaws.tolist(), strict=True)
            ],
            colors=palette.packed_all(
                palette.LEFT_FOOT if step.left else palette.RIGHT_FOOT for step in steps
            ),
            radii=np.full(len(steps), 0.004),
        )

    def _sole(self, left: bool, position: Array, yaw: float) -> Array:
        """Return the outline of a foot on the floor (5, 3) [m]."""
        c, s = cos(yaw), sin(yaw)
        outline = np.full((5, 3), SOLE_HEIGHT)
        outline[:, :2] = self._soles[not left] @ np.array([[c, s], [-s, c]]) + position
        return outline

    def _write_buffer(self) -> None:
        """Send the buffered records; Rerun's threads write them while the run goes on."""
        records = self._buffer.take()
        if records:
            self._add(records)
        if self._trail:
            self._path.add(
                self._time,
                strips=[np.array(self._trail)],
                colors=palette.packed_all([palette.TRUTH]),
                radii=np.array([0.006]),
            )
            del self._trail[: -round(TRAIL / TRAIL_PERIOD)]
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
    return RobotView(name, entity, robot.stature / DEFAULT_STATURE)
