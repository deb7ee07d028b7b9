"""The log of a run for the Rerun viewer: a listener that writes ``log.rrd``, also as it happens."""

from collections.abc import Sequence
from math import cos, sin
from pathlib import Path

import mujoco
import numpy as np
import rerun as rr
import rerun_bindings
from numpy.typing import NDArray

from hsr8.recorder import palette
from hsr8.recorder.files.writing import refusal
from hsr8.recorder.log.belief_layer import BeliefLayer
from hsr8.recorder.log.block_stream import BlockStream
from hsr8.recorder.log.blueprint import blueprint
from hsr8.recorder.log.camera_layer import CameraLayer
from hsr8.recorder.log.channel import TIMELINE, Channel
from hsr8.recorder.log.geometry import Scene, sole_outline
from hsr8.recorder.log.plan_layer import PlanLayer
from hsr8.recorder.log.plot_layer import PlotLayer
from hsr8.recorder.log.throttle import Throttle
from hsr8.recorder.log.walk_layer import WalkLayer
from hsr8.recorder.log_level import RATES, LogLevel
from hsr8.recorder.record import TickRecord
from hsr8.recorder.record_buffer import PERIOD, RecordBuffer
from hsr8.recorder.run.walking_table import OdometryToWorld
from hsr8.world.field.layout import Layout
from navigation.parameters.gaze import GazeParameters

Array = NDArray[np.float64]

APRON = 1.0  # the floor shown is larger than the field by this [m]
LIVE_BLOCK = 0.5  # rows are sent in shorter blocks while somebody watches [s]
SOLE_HEIGHT = 0.004  # at which footsteps are drawn [m]
LABELLED = 12  # more way points than this are shown without their numbers
PATIENCE = 20.0  # a block must be with the operating system within this wall time [s]
TRAIL, TRAIL_PERIOD = 60.0, 0.12  # the path shown behind the robot, and of its points [s]
LEVELS = {"fall": "ERROR", "diverged": "ERROR"} | dict.fromkeys(
    ("collision", "fault", "lost", "push"), "WARN"
)


class RerunLog:
    """Listener that logs a run.

    Args:
        path: file to write.
        model: compiled world.
        layout: what stands where.
        image_size: width and height of the head camera's image [pixel].
        name: of the recording, shown by the viewer.
        gaze: of the run; spans its gaze map.
        level: how much is logged.
        live: address of a viewer that is shown everything too; empty for none.
        index: end the file with a list of its parts, for tools that read some of them only; until
            then the list is held in memory, some 0.2 MB for each second.
    """

    def __init__(
        self,
        path: Path,
        model: mujoco.MjModel,
        layout: Layout,
        image_size: tuple[int, int],
        name: str,
        *,
        gaze: GazeParameters,
        level: LogLevel = LogLevel.STANDARD,
        live: str = "",
        index: bool = True,
    ) -> None:
        rates = RATES[level]
        self._pose_throttle, self._frame_throttle = Throttle(rates.pose), Throttle(rates.frame)
        self._trail_throttle = Throttle(TRAIL_PERIOD)
        # Rerun keeps the threads of a stream that nobody holds any more until it is asked.
        rerun_bindings.flush_and_cleanup_orphaned_recordings()
        self._stream = BlockStream(path.parent.name)
        self._stream.set_log_time_enabled(False)
        sinks = [rr.FileSink(str(path), write_footer=index), *([rr.GrpcSink(live)] if live else [])]
        self._folder = path.parent
        self._waits = not live  # for the file; a viewer may leave
        self._full = False
        shown = blueprint(
            max(layout.field_size), walking=len(layout.waypoints) == 0, pictures=rates.pictures
        )
        try:
            self._stream.begin(sinks, shown)
        except RuntimeError as error:
            raise refusal(self._folder, f"the log: {error}") from error
        self._stream.send_recording_name(name)
        self._stream.log("/", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        self._n_movers = len(layout.movers)
        width, depth = layout.field_size
        self._scene = Scene(self._stream, model, (width + APRON, depth + APRON))
        self._soles = tuple(sole_outline(model, side) for side in "lr")
        self._camera: CameraLayer | None = None
        self._minds: tuple[BeliefLayer | PlanLayer, ...] = ()
        if rates.pictures:
            self._camera = CameraLayer(self._stream, model, image_size, rates.jpeg, gaze)
            self._minds = (
                BeliefLayer(self._stream, rates.map),
                PlanLayer(self._stream, rates.map),
            )
        self._plots = PlotLayer(self._stream)
        self._walk = WalkLayer(self._stream)
        self._footsteps = Channel(self._stream, "/world/footsteps", rr.LineStrips3D.columns)
        self._path = Channel(self._stream, "/world/path", rr.LineStrips3D.columns)
        self._trail: list[list[float]] = []
        self._log_way_points(layout)
        self._waiting = RecordBuffer(LIVE_BLOCK if live else PERIOD)
        self._time = 0.0

    def on_record(self, record: TickRecord) -> None:
        """Log one record."""
        if self._waiting.add(record):
            self._write_pending()

    def on_event(self, time: float, kind: str, text: str) -> None:
        """Log one event."""
        self._stream.set_time(TIMELINE, duration=time)
        level = LEVELS.get(kind, "INFO")
        self._stream.log("/events", rr.TextLog(f"{kind}: {text}", level=level))

    def flush(self) -> None:
        """Hand everything to the operating system."""
        self._write_pending()
        self._wait()

    def close(self, exit_reason: str) -> None:
        """Write what is left and finish the file, unless it takes no more."""
        try:
            self.flush()
            self.on_event(self._time, "end", exit_reason)
        finally:
            if self._full:
                self._stream.abandon()
            else:
                self._stream.disconnect()

    def _add(self, records: Sequence[TickRecord]) -> None:
        self._time = records[-1].time
        shown = [record for record in records if self._pose_throttle.due(record.time)]
        for record in shown:
            truth = record.truth
            movers = truth.obstacle_positions[len(truth.obstacle_positions) - self._n_movers :]
            self._scene.add(record.time, truth.qpos, movers)
            if self._camera is not None:
                self._camera.add_pose(record.time, self._scene.data)
        if shown:
            self._plots.add(shown)
            self._walk.add(shown)
        for record in records:
            self._walk.watch(record)
        with_frame = [record for record in records if record.frame is not None]
        seen = [record for record in with_frame if self._frame_throttle.due(record.time)]
        if seen:
            self._add_frames(seen)

    def _add_frames(self, records: Sequence[TickRecord]) -> None:
        pairs = [(r.frame, r.truth.robot) for r in records if r.frame is not None]
        frames = [frame for frame, _ in pairs]
        if self._camera is not None:
            self._camera.add_frames(frames)
        for layer in self._minds:
            layer.add(frames)
        self._plots.add_frames(pairs)
        for record in records:
            if self._trail_throttle.due(record.time):
                x, y, _ = record.truth.robot.tolist()
                self._trail.append([x, y, 0.003])
        self._add_footsteps(records, [frame.time for frame in frames])

    def _add_footsteps(self, records: Sequence[TickRecord], times: list[float]) -> None:
        """Planned footholds, known in the odometry frame, as seen from the true pose."""
        steps = [step for record in records for step in record.walking.footsteps]
        counts = [len(record.walking.footsteps) for record in records]
        moments = np.repeat(np.arange(len(records)), counts)
        there = OdometryToWorld(records)
        places = there.point(np.reshape([(f.x, f.y) for f in steps], (-1, 2)), moments)
        yaws = np.array([f.yaw for f in steps]) + there.turn[moments]
        self._footsteps.add_rows(
            times,
            counts,
            strips=[
                self._sole(step.left, place, yaw)
                for step, place, yaw in zip(steps, places, yaws.tolist(), strict=True)
            ],
            colors=palette.packed_all(
                palette.LEFT_FOOT if step.left else palette.RIGHT_FOOT for step in steps
            ),
            radii=np.full(len(steps), 0.004),
        )

    def _sole(self, left: bool, place: Array, yaw: float) -> Array:
        """Outline of a foot on the floor (5, 3) [m]."""
        c, s = cos(yaw), sin(yaw)
        outline = np.full((5, 3), SOLE_HEIGHT)
        outline[:, :2] = self._soles[not left] @ np.array([[c, s], [-s, c]]) + place
        return outline

    def _write_pending(self) -> None:
        """Send the records that wait."""
        records = self._waiting.take()
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
        if self._camera is not None:
            self._camera.flush()
        for part in (self._scene, *self._minds, self._plots, self._walk):
            part.flush()
        self._footsteps.flush()
        self._path.flush()
        self._hand_over()

    def _hand_over(self) -> None:
        """Send everything; Rerun's own threads write it while the run goes on."""
        self._wait()
        self._stream.send()
        if self._waits:
            self._stream.flush(timeout_sec=0.0)

    def _wait(self) -> None:
        """Wait until what was sent is with the operating system."""
        if not self._waits:
            return
        try:
            self._stream.flush(timeout_sec=PATIENCE)
        except RuntimeError as error:
            self._waits, self._full = False, True  # the library would wait in vain again
            raise refusal(self._folder, f"the log: {error}") from error

    def _log_way_points(self, layout: Layout) -> None:
        points = np.asarray(layout.waypoints, float).reshape(-1, 2)
        if len(points) == 0:
            return
        has_goal = layout.goal_heading is not None and not layout.endless
        labels = [str(i + 1) for i in range(len(points))]
        if has_goal:
            labels[-1] = "goal"
        self._stream.log(
            "/world/way_points",
            rr.Points3D(
                np.column_stack([points, np.full(len(points), 0.01)]),
                radii=0.03 if len(points) <= LABELLED else 0.012,
                colors=[palette.TARGET],
                labels=labels,
                show_labels=len(points) <= LABELLED,
            ),
            static=True,
        )
        if has_goal and layout.goal_heading is not None:
            direction = [cos(layout.goal_heading), sin(layout.goal_heading), 0.0]
            self._stream.log(
                "/world/way_points/heading",
                rr.Arrows3D(
                    origins=[[*points[-1].tolist(), 0.01]],
                    vectors=[0.25 * np.array(direction)],
                    colors=[palette.TARGET],
                    radii=0.01,
                ),
                static=True,
            )
