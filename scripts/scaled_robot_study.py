"""Robots of other sizes and proportions walk without a change of code or parameters.

Each robot is written to an MJCF file, the only source of the walking library. Every robot gets
the same commands in units of its limits and its time scale; the sensor noise is equal for all.

    python scripts/scaled_robot_study.py --seeds 1000 1001 1002

Tune on seeds 0-99, report on seeds from 1000.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import cos, pi, sin, sqrt
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from walking.body.joints import LEG_JOINTS
from walking.body.leg_kinematics import FootPose, leg_angles
from walking.body.robot_model import READY, RobotModel
from walking.command import HeadTarget, VelocityCommand
from walking.engine import WalkingEngine
from walking.parameters import CONTROL_PERIOD, GRAVITY, WalkingParameters
from walking.robot_measures import HSR_VIII
from walking.scaling import parameters_for, scale_parameters

import mujoco
import numpy as np
import tyro
from scaled_model import scale_robot
from walk_study import mean_velocity
from walking_body import ROBOT, Body, Plant
from walking_trial import Script, Trace, random_script, steady_script, walk

STEADY = {
    "forward": VelocityCommand(0.25, 0.0, 0.0),
    "back": VelocityCommand(-0.15, 0.0, 0.0),
    "side": VelocityCommand(0.0, 0.08, 0.0),
    "turn": VelocityCommand(0.0, 0.0, 0.8),
}
"""Command of HSR-VIII."""
PUSH_TIME = 0.05  # [s], of HSR-VIII


def leggy(spec: mujoco.MjSpec) -> None:
    """Thighs longer by 10 %, shanks by 20 %, hips wider by 20 %, the torso heavier by 20 %."""
    for side in "lr":
        hip = spec.body(f"{side}_hip_yaw_link")
        hip.pos = [hip.pos[0], 1.2 * hip.pos[1], hip.pos[2]]
        _stretch(spec, side, thigh=1.1, shank=1.2)
    _load(spec, 1.2)


def stocky(spec: mujoco.MjSpec) -> None:
    """Legs shorter by 15 %, hips and soles wider by 15 %, the torso heavier by 40 %."""
    for side in "lr":
        hip, foot = spec.body(f"{side}_hip_yaw_link"), spec.body(f"{side}_foot_link")
        hip.pos = [hip.pos[0], 1.15 * hip.pos[1], hip.pos[2]]
        _stretch(spec, side, thigh=0.85, shank=0.85)
        broad = np.array([1.0, 1.15, 1.0])
        for part in (*foot.geoms, *foot.sites):
            part.pos = broad * part.pos
            part.size = broad * part.size
    _load(spec, 1.4)


def soft(spec: mujoco.MjSpec) -> None:
    """Leg servos of 60 % of the stiffness."""
    for actuator in spec.actuators:
        if actuator.target.removeprefix("l_").removeprefix("r_") in LEG_JOINTS:
            actuator.gainprm[0] *= 0.6
            actuator.biasprm[1] *= 0.6


def _stretch(spec: mujoco.MjSpec, side: str, *, thigh: float, shank: float) -> None:
    """Make thigh and shank longer, and heavier by as much."""
    for part, below, longer in (("hip_pitch", "knee", thigh), ("knee", "ankle_pitch", shank)):
        link, end = spec.body(f"{side}_{part}_link"), spec.body(f"{side}_{below}_link")
        stretch = np.array([1.0, 1.0, longer])
        end.pos = stretch * end.pos
        link.ipos = stretch * link.ipos
        link.mass *= longer
        link.inertia = np.array([longer**3, longer**3, longer]) * link.inertia
        for geom in link.geoms:
            if geom.name.endswith("_collision"):
                geom.fromto = np.tile(stretch, 2) * geom.fromto


def _load(spec: mujoco.MjSpec, heavier: float) -> None:
    torso = spec.body("torso_link")
    torso.mass *= heavier
    torso.inertia = heavier * torso.inertia


PROPORTIONS: dict[str, Callable[[mujoco.MjSpec], None]] = {
    "leggy": leggy,
    "stocky": stocky,
    "soft": soft,
}


@dataclass
class Options:
    """Options of the study."""

    seeds: tuple[int, ...] = (0,)
    """Random seeds, each for every walk of every robot."""
    robots: tuple[str, ...] = ("1.0", "0.8", "1.3", "0.5", "2.0", *PROPORTIONS)
    """Sizes, or a name of `PROPORTIONS`."""
    walks: tuple[str, ...] = (*STEADY, "random", "push")
    """Parts of the study."""
    duration: float = 60.0
    """Of the random walk; a third of it for a steady one [s, of HSR-VIII]."""
    impulse: float = 0.15
    """Of a push, divided by mass and √(g leg) [1]."""
    derived: bool = True
    """Whether a robot has scaled parameters, or those of HSR-VIII."""


class Push(NamedTuple):
    """A horizontal force (2,) [N] on the torso for some time [s]."""

    begin: float
    end: float
    force: np.ndarray


class PushedBody(Body):
    """A body that is pushed once."""

    def __init__(self, rng: np.random.Generator, plant: Plant, push: Push) -> None:
        super().__init__(rng, plant)
        self._push = push

    def apply(self, ctrl: np.ndarray) -> None:
        """Advance one control tick."""
        push = self._push
        on = push.begin <= self.data.time < push.end
        self.data.xfrc_applied[self.torso, :2] = push.force if on else 0.0
        super().apply(ctrl)


@dataclass(frozen=True)
class Walker:
    """A robot that can walk.

    Attributes:
        path: its MJCF file.
        model: what the walking library makes of it.
        parameters: derived from that.
        time: of its walk, in units of HSR-VIII's.
    """

    path: Path
    model: RobotModel
    parameters: WalkingParameters
    time: float

    def body(self, rng: np.random.Generator) -> Body:
        """It, standing ready."""
        return Body(rng, Plant(robot=self.path))

    def engine(self) -> WalkingEngine:
        """Its walking engine."""
        return WalkingEngine(self.model, self.parameters)

    def similar(self, script: Script) -> Script:
        """Return its command that corresponds to `script` of HSR-VIII."""

        def scaled(now: float) -> tuple[VelocityCommand, HeadTarget]:
            command, head = script(now / self.time)
            return scale_parameters(command, HSR_VIII, self.model.measures()), head

        return scaled


def build(name: str, folder: Path, *, derived: bool = True) -> Walker:
    """The robot of a name, written to a file and read from there.

    Args:
        name: a size, or one of `PROPORTIONS`.
        folder: for the file.
        derived: whether to derive the parameters, or to take those of HSR-VIII.
    """
    spec = mujoco.MjSpec.from_file(str(ROBOT))
    if name in PROPORTIONS:
        PROPORTIONS[name](spec)
    else:
        scale_robot(spec, float(name))
    path = folder / f"{name}.xml"
    _write(spec, path)
    model = RobotModel.from_mjcf(path)
    parameters = parameters_for(model)
    _stand_ready(spec, model, parameters.pattern.pelvis_height)
    _write(spec, path)
    model = RobotModel.from_mjcf(path)
    return Walker(
        path=path,
        model=model,
        parameters=parameters if derived else WalkingParameters(),
        time=model.measures().time / HSR_VIII.time,
    )


def _write(spec: mujoco.MjSpec, path: Path) -> None:
    spec.compile()
    path.write_text(spec.to_xml(), encoding="utf-8")


def _stand_ready(spec: mujoco.MjSpec, robot: RobotModel, height: float) -> None:
    """Let the keyframe have the legs of the walk's height."""
    key = next(key for key in spec.keys if key.name == READY)
    compiled = spec.compile()
    key.qpos[2] = height - robot.legs[0].hip_z
    for leg, side in zip(robot.legs, "lr", strict=True):
        foot = FootPose(leg.hip_x, leg.hip_y, leg.hip_z - height, 0.0, 0.0, 0.0)
        for joint, angle in zip(LEG_JOINTS, leg_angles(leg, foot)[0], strict=True):
            key.qpos[int(compiled.joint(f"{side}_{joint}").qposadr[0])] = angle
            key.ctrl[compiled.actuator(f"{side}_{joint}_act").id] = angle


@dataclass(frozen=True)
class Outcome:
    """Result of one walk.

    Attributes:
        falls: how often it fell.
        steps: how many it made.
        tilt: 99th percentile of the trunk's tilt [deg].
        share: achieved part of the speed asked for, if that was steady [1].
        number: that speed over √(g leg), or over √(g / leg) if it is a turn [1].
    """

    falls: int
    steps: int
    tilt: float
    share: float = np.nan
    number: float = np.nan


def steady(walker: Walker, asked: VelocityCommand, seed: int, duration: float) -> Outcome:
    """One command for some time [s, of HSR-VIII]."""
    rng = np.random.default_rng([seed, 3])
    script = walker.similar(steady_script(asked))
    trace = walk(walker.engine, lambda: walker.body(rng), script, duration * walker.time)
    # Four footsteps are a whole number of samples whatever the ticks of one.
    stride = round(walker.parameters.gait.footstep_time / CONTROL_PERIOD)
    velocity = mean_velocity(trace, 3.0 * walker.time, stride)
    command, _ = script(0.0)
    given = np.array(command.velocity)
    main, leg = int(np.argmax(np.abs(given))), walker.model.measures().leg
    unit = sqrt(GRAVITY * leg) if main < 2 else sqrt(GRAVITY / leg)
    reached = float(velocity[main])
    return replace(summary(trace), share=reached / given[main], number=reached / unit)


def at_random(walker: Walker, seed: int, duration: float) -> Outcome:
    """Commands and head at random for some time [s, of HSR-VIII]."""
    rng = np.random.default_rng([seed, 3])
    script = walker.similar(random_script(seed))
    return summary(walk(walker.engine, lambda: walker.body(rng), script, duration * walker.time))


def pushed(walker: Walker, seed: int, impulse: float) -> Outcome:
    """Eight pushes from all sides, one walk each.

    Args:
        walker: the robot.
        seed: of the noise and the phase.
        impulse: divided by mass and √(g leg) [1].
    """
    rng = np.random.default_rng([seed, 3])
    script = walker.similar(steady_script(VelocityCommand(0.1, 0.0, 0.0)))
    strength = impulse * walker.model.mass * sqrt(GRAVITY * walker.model.measures().leg)
    length, tilts, falls, steps = PUSH_TIME * walker.time, [], 0, 0
    for direction, phase in enumerate(np.random.default_rng([seed, 5]).uniform(size=8)):
        angle = 0.25 * pi * direction
        force = strength / length * np.array([cos(angle), sin(angle)])
        begin = 4.0 * walker.time + 2.0 * phase * walker.parameters.gait.footstep_time
        push = Push(begin, begin + length, force)

        def body(push: Push = push) -> Body:
            return PushedBody(rng, Plant(robot=walker.path), push)

        end = begin + 2.5 * walker.time
        outcome = summary(walk(walker.engine, body, script, end))
        tilts.append(outcome.tilt)
        falls += min(1, outcome.falls)
        steps += outcome.steps
    return Outcome(falls, steps, max(tilts))


def summary(trace: Trace) -> Outcome:
    """Falls, steps and tilt."""
    steps = trace.steps[-1] if not trace.falls else int(np.maximum(np.diff(trace.steps), 0).sum())
    return Outcome(len(trace.falls), steps, float(np.percentile(trace.tilt, 99)))


def study(walker: Walker, kind: str, options: Options) -> str:
    """Row of the table: one walk with every seed."""
    outcomes = []
    for seed in options.seeds:
        if kind in STEADY:
            outcomes.append(steady(walker, STEADY[kind], seed, options.duration / 3.0))
        elif kind == "random":
            outcomes.append(at_random(walker, seed, options.duration))
        else:
            outcomes.append(pushed(walker, seed, options.impulse))
    falls, steps = sum(o.falls for o in outcomes), sum(o.steps for o in outcomes)
    row = f"{falls} | {steps} | {max(o.tilt for o in outcomes):.2f} |"
    if kind not in STEADY:
        return f"{row} | |"
    share, number = (float(np.mean([getattr(o, n) for o in outcomes])) for n in ("share", "number"))
    return f"{row} | |" if np.isnan(share) else f"{row} {share:.3f} | {number:+.3f} |"


def main(options: Options) -> None:
    """Run the study and print its table."""
    print("| robot | walk | falls | steps | tilt p99 [deg] | achieved / asked | normalised speed |")
    print("|---|---|---|---|---|---|---|")
    with TemporaryDirectory() as folder:
        for name in options.robots:
            walker = build(name, Path(folder), derived=options.derived)
            for kind in options.walks:
                print(f"| {name} | {kind} | {study(walker, kind, options)}", flush=True)


if __name__ == "__main__":
    main(tyro.cli(Options))
