"""What the faults of a scenario must satisfy beyond the type and range of each key."""

from collections.abc import Iterator
from math import ceil

from hsr8.scenario.fault import (
    Bump,
    CameraLatency,
    Lighting,
    LowFriction,
    MoverAppears,
    WorldFault,
    ticks,
)
from hsr8.scenario.problem import Problem
from hsr8.scenario.schema import Scenario
from hsr8.scenario.section import CONTROL_PERIOD_MS

LATEST_MS = 500
"""Images that arrive later than this are not understood [ms]."""


def fault_problems(scenario: Scenario) -> Iterator[Problem]:
    """Every fault that does not fit the rest of the scenario."""
    world, body = scenario.world, scenario.robot.body
    movers = len(world.mover) + world.n_moving + world.encounters.n
    period_ms, late_ticks = scenario.camera.period_ms, 0
    appear: set[int] = set()
    for i, fault in enumerate(scenario.fault):
        if fault.start >= scenario.duration:
            yield Problem(
                ("fault", i, "start"),
                f"{fault.start:g} s is not before the end of the run at {scenario.duration:g} s",
            )
        if isinstance(fault, WorldFault) and body != "full":
            yield Problem(
                ("fault", i, "kind"),
                f'"{fault.kind}" needs dynamics, which a {body} body has not; '
                'robot.body = "full" has',
            )
        if isinstance(fault, Lighting) and scenario.camera.source != "rendered":
            yield Problem(
                ("fault", i, "kind"),
                f'"{fault.kind}" needs rendered images, which camera.source = '
                f'"{scenario.camera.source}" has not; camera.source = "rendered" has',
            )
        if isinstance(fault, CameraLatency):
            late_ticks += ticks(fault.magnitude)
            periods = ceil(late_ticks * CONTROL_PERIOD_MS / period_ms)
            late = scenario.camera.latency_ms + periods * period_ms
            if late > LATEST_MS:
                yield Problem(
                    ("fault", i, "magnitude"),
                    f"with camera.latency_ms and all such faults together, in whole camera "
                    f"periods, images come {late} ms late; at most {LATEST_MS}",
                )
        if isinstance(fault, MoverAppears) and fault.mover >= movers:
            has = f"0 to {movers - 1}" if movers else "none"
            yield Problem(("fault", i, "mover"), f"there is no mover {fault.mover} ({has})")
        if isinstance(fault, MoverAppears):
            if fault.mover in appear:
                yield Problem(("fault", i, "mover"), f"mover {fault.mover} appears twice")
            appear.add(fault.mover)
        if isinstance(fault, Bump | LowFriction) and fault.place is not None:
            x, y = (0.5 * side for side in world.size)
            if abs(fault.place[0]) > x or abs(fault.place[1]) > y:
                yield Problem(
                    ("fault", i, "place"),
                    f"{list(fault.place)} is outside the field, which reaches from "
                    f"{[-x, -y]} to {[x, y]}",
                )
