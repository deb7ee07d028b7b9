"""Verification: physics, belief and decisions of a recorded run recomputed, bit for bit."""

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from hsr8.errors import SimulationDiverged
from hsr8.recording.columns import attributes
from hsr8.recording.difference import first_cell
from hsr8.recording.frame_row import CONTEXT, DETECTION, FRAME, MEASURED
from hsr8.recording.recorded import FrameSampler, RecordedFrame
from hsr8.recording.rows import TABLES
from hsr8.recording.run import Run
from hsr8.recording.table import Table
from hsr8.seeds import named_rng
from hsr8.simulation.decisions import DecisionContext, DriveCommand, FrameRecord
from hsr8.simulation.drive import Drive
from hsr8.simulation.loop import HASH
from hsr8.simulation.robot_builder import (
    build_body,
    build_decisions,
    build_estimator,
    build_model,
    build_schedule,
    camera_model,
)
from hsr8.world.field.generator import draw_layout
from navigation.observation import CameraModel, CameraView, Frame
from vision.detection import Detection
from walking.parameters import CONTROL_PERIOD
from walking.state import JointTargets

BELIEF = (
    *("pose", "pose_covariance", "lost", "filter_faults", "seen_beacons", "tracks"),
    *("local_map", "map_hash", "map_origin", "map_cell", "particles"),
)
"""Columns of the belief."""
CHUNK = 200  # frames computed between two comparisons


@dataclass(frozen=True, slots=True)
class Recomputed:
    """Comparison of one recomputed stage with its records.

    Attributes:
        stage: physics, estimator or decisions.
        unit: unit of the comparison: ticks or frames.
        count: number of compared units.
        index: number of the first different unit, None if all are equal.
        time: simulated time there [s].
        channel: channel that differs there.
    """

    stage: str
    unit: str
    count: int
    index: int | None = None
    time: float | None = None
    channel: str | None = None

    @property
    def equal(self) -> bool:
        """Whether nothing differs."""
        return self.index is None


def recompute(run: Run) -> tuple[Recomputed, ...]:
    """Recompute all stages of a run from its tables.

    Raises:
        UsageError: a table is damaged or cut off, or the scenario cannot be read.
    """
    for name in TABLES:
        getattr(run, name)  # refuses a damaged table
    return recompute_physics(run), *recompute_decisions(run)


def recompute_physics(run: Run) -> Recomputed:
    """Apply the recorded setpoints in the same world and compare the hash every second."""
    scenario = run.scenario()
    layout = draw_layout(scenario, run.seed)
    body = build_body(scenario, run.seed, layout, build_model(scenario, layout))
    setpoints = run.ticks["setpoint"]
    if len(setpoints) and np.isnan(setpoints[-1]).all():
        setpoints = setpoints[:-1]  # a run that ends before a tick is applied
    due = run.seconds["tick"].tolist()
    diverged = run.manifest.get("exit_reason") == "diverged"
    if diverged and due:
        due[-1] += 1  # the hash follows the tick that diverged, which is not counted
    ticks = 0

    def different(tick: int, channel: str) -> Recomputed:
        return Recomputed("physics", "ticks", ticks, tick, tick * CONTROL_PERIOD, channel)

    for tick, world in zip([*due, len(setpoints)], [*run.seconds["world"], None], strict=True):
        if tick > len(setpoints) and not run.ended:
            continue
        for setpoint in setpoints[ticks:tick]:
            try:
                body.apply(JointTargets(setpoint, setpoint))
            except SimulationDiverged:
                if not diverged or ticks + 1 < len(setpoints):
                    return different(ticks, "the physics diverged")
            ticks += 1
        digest = hashlib.blake2b(body.state_bytes(), digest_size=HASH).digest()
        if tick != ticks or world not in (None, digest):
            return different(tick, "world")
    return Recomputed("physics", "ticks", ticks)


def recompute_decisions(run: Run) -> tuple[Recomputed, Recomputed]:
    """Give estimator and decisions the recorded inputs and compare all columns of the frames.

    The decisions are compared up to the first difference of the estimator.
    """
    frames, computed = run.frames, _computed(run)
    stages = {name: Recomputed(name, "frames", len(frames)) for name in ("estimator", "decisions")}
    for first in range(0, len(frames), CHUNK):
        recorded = frames.rows(first, first + CHUNK)
        again = list(islice(computed, len(recorded)))
        row, stage, channel = len(again), "estimator", "order"
        cell = first_cell(recorded, Table.from_objects("frames", FRAME, again))
        if cell is not None:
            row, channel = cell.row, cell.channel
            stage = "estimator" if cell.column in BELIEF else "decisions"
        if row < len(recorded):
            time = float(recorded["time"][row])
            stages[stage] = Recomputed(stage, "frames", len(frames), first + row, time, channel)
            break
    return stages["estimator"], stages["decisions"]


def _computed(run: Run) -> Iterator[RecordedFrame]:
    """Yield the frames that follow from the inputs, up to one out of order."""
    scenario = run.scenario()
    layout = draw_layout(scenario, run.seed)
    estimator = build_estimator(scenario, layout, named_rng(run.seed, "belief"))
    schedule = build_schedule(scenario, named_rng(run.seed, "command"))
    decisions = build_decisions(scenario, layout, run.seed, schedule, drive=_drive(run.commands))
    sampler = FrameSampler(layout.scale)
    inputs = _inputs(run.frames, camera_model(scenario, layout.sizes))
    for index, ((detections, measured, context), first_plan) in enumerate(
        zip(inputs, run.frames["first_plan"], strict=True)
    ):
        try:
            estimate = estimator.update(measured)
        except ValueError:  # the frames are not in order
            return
        if first_plan:
            decisions.forget()
        decision = decisions.make(estimate, measured, context)
        yield sampler.sample(
            FrameRecord(
                index=index,
                time=context.time,
                image=None,
                detections=detections,
                measured=measured,
                estimate=estimate,
                context=context,
                decision=decision,
            )
        )


def _drive(commands: Table) -> Drive | None:
    """Return the commands of a driven run; None without any."""
    rows = zip(*(commands[name].tolist() for name in ("time", "velocity", "gaze")), strict=True)
    recorded = [DriveCommand(time, tuple(v), tuple(gaze)) for time, v, gaze in rows]
    return Drive(recorded) if recorded else None


def _inputs(
    frames: Table, camera: CameraModel
) -> Iterator[tuple[tuple[Detection, ...], Frame, DecisionContext]]:
    """Yield the inputs of estimator and decisions of every frame."""
    items = frames["detections"]
    detections = (Detection(**parts) for parts in attributes(DETECTION, items))
    objects = (attributes(FRAME, frames, path) for path in (MEASURED, CONTEXT))
    views = (attributes(FRAME, frames, f"{path}.view") for path in (MEASURED, CONTEXT))
    for count, measured, context, capture, now in zip(
        items.counts.tolist(), *objects, *views, strict=True
    ):
        detected = tuple(islice(detections, count))
        view = CameraView(**now, model=camera)
        frame = Frame(
            **measured,
            view=replace(view, **capture),
            observations=detected,
        )
        yield detected, frame, DecisionContext(**context, view=view)
