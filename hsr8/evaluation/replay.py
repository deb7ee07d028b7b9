"""Replay: physics, belief and decisions of a recorded run computed again, bit for bit."""

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass

from hsr8.body_builder import build_body, build_model
from hsr8.errors import SimulationDiverged
from hsr8.recorder.fingerprints import CHANNELS, DECISIONS, decision_fingerprints, fingerprints
from hsr8.recorder.run.measurements import Measurement
from hsr8.recorder.run.run_reader import Run
from hsr8.recorder.run.tape import HASH, Block
from hsr8.robot_builder import build_decisions, build_estimator, build_schedule
from hsr8.seeds import named_rng
from hsr8.world.field.generator import draw_layout
from walking.parameters import CONTROL_PERIOD
from walking.targets import JointTargets


@dataclass(frozen=True, slots=True)
class Replayed:
    """Result of the replay of one stage.

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


def replay(run: Run) -> tuple[Replayed, ...]:
    """Compute all stages of a run again from its records.

    Raises:
        UsageError: a record is missing or damaged, or the scenario cannot be read.
    """
    if run.ended:
        for read in (run.trajectory, run.walking, run.frame_summaries, run.event_lines):
            read()  # refuses a record that is cut off
    tape, measurements = run.tape(), run.measurements()
    return replay_physics(run, tape), *replay_decisions(run, measurements)


def replay_physics(run: Run, tape: list[Block]) -> Replayed:
    """Apply the recorded setpoints in the same world and compare the hash every second."""
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
                body.apply(JointTargets(setpoints, setpoints))
                ticks += 1
        except SimulationDiverged:
            time = ticks * CONTROL_PERIOD
            return Replayed("physics", "ticks", ticks, ticks, time, "the physics diverged")
    return Replayed("physics", "ticks", ticks)


def replay_decisions(run: Run, measurements: list[Measurement]) -> tuple[Replayed, Replayed]:
    """Give estimator and decisions the recorded inputs and compare the fingerprints."""
    count = len(measurements)
    estimator, decisions = Replayed("estimator", "frames", count), None
    for stage, index, channel in _differences(run, measurements):
        time = measurements[index].frame.time
        different = Replayed(stage, "frames", count, index, time, channel)
        if stage == "estimator":
            estimator = different
            break
        decisions = decisions or different
    return estimator, decisions or Replayed("decisions", "frames", count)


def _differences(run: Run, measurements: list[Measurement]) -> Iterator[tuple[str, int, str]]:
    """Yield stage, frame and channel of every difference; stop at one of the estimator."""
    scenario = run.scenario()
    layout = draw_layout(scenario, run.seed)
    estimator = build_estimator(scenario, layout, named_rng(run.seed, "belief"))
    schedule = build_schedule(scenario, named_rng(run.seed, "command"))
    decisions = build_decisions(scenario, layout, run.seed, schedule)
    for index, recorded in enumerate(measurements):
        try:
            estimate = estimator.update(recorded.frame)
        except ValueError:  # the frames are not in order
            yield "estimator", index, "order"
            return
        for channel, a, b in zip(
            CHANNELS, fingerprints(estimate), recorded.fingerprints, strict=True
        ):
            if a != b:
                yield "estimator", index, channel
                return
        if recorded.fresh:
            decisions.forget()
        decided = decisions.make(estimate, recorded.frame, recorded.context)
        for channel, a, b in zip(
            DECISIONS, decision_fingerprints(decided), recorded.decision, strict=True
        ):
            if a != b:
                yield "decisions", index, channel
                break
