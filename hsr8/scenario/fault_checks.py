"""Consistency of the faults of a scenario, also with its robot."""

from collections.abc import Iterator, Sequence
from math import ceil, isfinite

from hsr8.keys import Path
from hsr8.mistakes import Mistake
from hsr8.robots.file.description import TRUNK
from hsr8.robots.scale import DEFAULT_ROBOT
from hsr8.scenario.fault import (
    JOINT_GROUPS,
    Bump,
    CameraLatency,
    JointFault,
    Lighting,
    LowFriction,
    MoverAppears,
    Push,
    ServoWeak,
    WorldFault,
    ticks,
)
from hsr8.scenario.schema import Scenario
from hsr8.scenario.section import CONTROL_PERIOD_MS
from hsr8.scenario.track import n_placed
from hsr8.suggestion import suggestion
from walking.body.tree import JOINT_NAMES

MAX_LATENCY_MS = 500
"""Maximum latency of an image [ms]."""


def fault_problems(scenario: Scenario) -> Iterator[Mistake]:
    """Yield every fault that contradicts the rest of the scenario."""
    world, camera = scenario.world, scenario.camera
    movers = n_placed(scenario) + world.n_moving + world.encounters.n
    latency_ticks = 0
    appearing: set[int] = set()
    for i, fault in enumerate(scenario.fault):
        if fault.start >= scenario.duration:
            yield Mistake(
                ("fault", i, "start"),
                f"must be before the end of the run at {scenario.duration:g} s, "
                f"got {fault.start:g}",
            )
        if isinstance(fault, WorldFault) and scenario.robot.body != "full":
            yield Mistake(("fault", i, "kind"), f'"{fault.kind}" requires robot.body = "full"')
        if isinstance(fault, Lighting) and camera.source != "rendered":
            yield Mistake(
                ("fault", i, "kind"), f'"{fault.kind}" requires camera.source = "rendered"'
            )
        if isinstance(fault, CameraLatency):
            latency_ticks += ticks(fault.magnitude)
            periods = ceil(latency_ticks * CONTROL_PERIOD_MS / camera.period_ms)
            latency = camera.latency_ms + periods * camera.period_ms
            if latency > MAX_LATENCY_MS:
                yield Mistake(
                    ("fault", i, "magnitude"),
                    f"total latency with camera.latency_ms, in whole camera periods, must be at "
                    f"most {MAX_LATENCY_MS} ms, got {latency}",
                )
        if isinstance(fault, MoverAppears):
            if fault.mover >= movers:
                expected = f"0 to {movers - 1}" if movers else "a world with moving obstacles"
                yield Mistake(
                    ("fault", i, "mover"),
                    f"unknown mover {fault.mover}; expected {expected}",
                )
            if fault.mover in appearing:
                yield Mistake(("fault", i, "mover"), f"mover {fault.mover} appears twice")
            appearing.add(fault.mover)
        if isinstance(fault, Bump | LowFriction) and fault.position is not None:
            x, y = (0.5 * side for side in world.size)
            if abs(fault.position[0]) > x or abs(fault.position[1]) > y:
                yield Mistake(
                    ("fault", i, "position"),
                    f"{list(fault.position)} is outside the field from {[-x, -y]} to {[x, y]}",
                )


def robot_problems(scenario: Scenario) -> Iterator[Mistake]:
    """Yield every joint, body or torque limit of a fault or push that the robot does not have."""
    joints: list[tuple[Path, str]] = [
        (("fault", i, "joint"), f.joint)
        for i, f in enumerate(scenario.fault)
        if isinstance(f, JointFault) and f.joint not in JOINT_GROUPS
    ]
    bodies: list[tuple[Path, str]] = [
        (("fault", i, "body"), f.body) for i, f in enumerate(scenario.fault) if isinstance(f, Push)
    ]
    if scenario.disturbance.random is not None:
        bodies.append((("disturbance", "random", "body"), scenario.disturbance.random.body))
    bodies = [(path, body) for path, body in bodies if body != TRUNK]
    gets_up = scenario.walking.get_up.enabled and scenario.robot.model != DEFAULT_ROBOT
    weak = scenario.robot.model != DEFAULT_ROBOT and any(
        isinstance(f, ServoWeak) for f in scenario.fault
    )
    if not (joints or bodies or gets_up or weak):
        return
    from hsr8.robots.loaded import load_robot  # noqa: PLC0415 (MuJoCo loads slowly)

    robot = load_robot(scenario.robot.model)
    for given, names in (
        (joints, (*JOINT_GROUPS, *robot.model.names)),
        (bodies, (TRUNK, *robot.body_names())),
    ):
        for path, name in given:
            if name not in names:
                yield _unknown(path, name, names)
    for i, fault in enumerate(scenario.fault):
        if isinstance(fault, ServoWeak) and fault.joint in (*JOINT_GROUPS, *robot.model.names):
            limits = [robot.model.tree.effort[k] for k in fault.joints(robot.model.names)]
            if not isfinite(max(limits)):
                yield Mistake(
                    ("fault", i, "joint"),
                    f"{fault.joint!r} has servos without a maximum torque; expected stated ones: "
                    "add effort to the description of the robot",
                )
    if gets_up and robot.model.names != JOINT_NAMES:
        yield Mistake(
            ("walking", "get_up", "enabled"),
            f'the motions are for robot.model = "{DEFAULT_ROBOT}" only, got "{robot.name}"',
        )


def _unknown(path: Path, name: str, names: Sequence[str]) -> Mistake:
    hint, part = suggestion(name, names), path[-1]
    expected = f"expected one of {', '.join(names)}"
    return Mistake(path, f"the robot has no {part} {name!r}{hint}{'' if hint else ';'} {expected}")
