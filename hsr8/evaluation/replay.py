"""A recorded run computed again: physics, belief and decisions, bit for bit."""

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from hsr8.body_builder import build_body, build_model
from hsr8.errors import SimulationDiverged
from hsr8.recorder.run.exact_records import measurements_of, require_whole, tape_of
from hsr8.recorder.run.fingerprints import CHANNELS, DECISIONS, decision_fingerprints, fingerprints
from hsr8.recorder.run.measurements import Measured
from hsr8.recorder.run.run_reader import Run
from hsr8.recorder.run.tape import HASH, Block
from hsr8.robot_builder import build_decisions, build_estimator, build_schedule
from hsr8.seeds import named_rng
from hsr8.world.field.generator import draw_layout
from walking.body.joints import JOINT_NAMES
from walking.parameters import CONTROL_PERIOD
from walking.targets import JointTargets

STAND_STILL = np.zeros(len(JOINT_NAMES))


@dataclass(frozen=True, slots=True)
class Replayed:
    """What came of computing one stage again.

    Attributes:
        stage: physics, estimator or decisions.
        unit: what was compared: ticks or frames.
        count: how many of them.
        place: of the first difference, None if everything was equal.
        time: simulated time there [s].
        channel: what differed there.
    """

    stage: str
    unit: str
    count: int
    place: int | None = None
    time: float | None = None
    channel: str | None = None

    @property
    def equal(self) -> bool:
        """Whether nothing differed."""
        return self.place is None


def replay(run: Run) -> tuple[Replayed, ...]:
    """Compute a run again from what it recorded.

    Raises:
        UsageError: its records are missing or damaged, or its scenario cannot be read.
    """
    require_whole(run)
    tape, measured = tape_of(run), measurements_of(run)
    return replay_physics(run, tape), *replay_mind(run, measured)


def replay_physics(run: Run, tape: list[Block]) -> Replayed:
    """Give a body in the same world the same set-points, and compare the hash each second."""
    scenario = run.scenario()
    layout = draw_layout(scenario, run.seed)
    body = build_body(scenario, run.seed, layout, build_model(scenario, layout))
    ticks = 0
    for block in tape:
        world = hashlib.blake2b(body.state_bytes(), digest_size=HASH).hexdigest()
        if world != block.world or block.tick != ticks:
            return Replayed(
                "physics", "ticks", ticks, block.tick, block.tick * CONTROL_PERIOD, "world"
            )
        try:
            for setpoints in block.setpoints:
                body.apply(JointTargets(setpoints, STAND_STILL))
                ticks += 1
        except SimulationDiverged:
            time = ticks * CONTROL_PERIOD
            return Replayed("physics", "ticks", ticks, ticks, time, "the physics diverged")
    return Replayed("physics", "ticks", ticks)


def replay_mind(run: Run, measured: list[Measured]) -> tuple[Replayed, Replayed]:
    """Give the estimator the same frames, and the decisions what it made of them."""
    estimator, decisions = Replayed("estimator", "frames", len(measured)), None
    for stage, index, channel in _differences(run, measured):
        found = Replayed(stage, "frames", len(measured), index, measured[index].frame.time, channel)
        if stage == "estimator":
            estimator = found
            break
        decisions = decisions or found
    return estimator, decisions or Replayed("decisions", "frames", len(measured))


def _differences(run: Run, measured: list[Measured]) -> Iterator[tuple[str, int, str]]:
    """Stage, frame and channel of everything that comes out differently."""
    scenario = run.scenario()
    layout = draw_layout(scenario, run.seed)
    estimator = build_estimator(scenario, layout, named_rng(run.seed, "belief"))
    schedule = build_schedule(scenario, named_rng(run.seed, "command"))
    decisions = build_decisions(scenario, layout, run.seed, schedule)
    for index, recorded in enumerate(measured):
        try:
            estimate = estimator.update(recorded.frame)
        except ValueError:  # the frames are not in their order
            yield "estimator", index, "order"
            return
        found = fingerprints(estimate)
        for channel, a, b in zip(CHANNELS, found, recorded.fingerprints, strict=True):
            if a != b:
                yield "estimator", index, channel
                return
        if recorded.fresh:
            decisions.forget()
        decided = decisions.make(estimate, recorded.frame, recorded.context)
        found = decision_fingerprints(decided)
        for channel, a, b in zip(DECISIONS, found, recorded.decision, strict=True):
            if a != b:
                yield "decisions", index, channel
                break
