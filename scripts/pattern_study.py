"""What the pattern generators make of a new command in every tick: the pendulum alone.

    python scripts/pattern_study.py every-tick --seeds 1000 1001 --duration 60
    python scripts/pattern_study.py landing
    python scripts/pattern_study.py all --write

The ZMP is taken from the calls that move the pendulum, so it is checked as it was walked,
between the ticks too: the ends of every stretch of constant or linear ZMP against the
polygon of the feet on the floor, which is convex.
"""

import argparse
import time
from dataclasses import dataclass, field
from math import cos, hypot, sin
from pathlib import Path
from unittest import mock

from walking.body.robot_model import RobotModel
from walking.body.sole import Sole
from walking.command import Command, CommandState, VelocityCommand
from walking.foothold import Foothold
from walking.footsteps.planner import FootstepPlanner
from walking.footsteps.steering import Steering
from walking.footsteps.stride import STILL
from walking.gait.gait import Gait
from walking.gait.transition import Transition
from walking.parameters import CONTROL_PERIOD, PatternParameters, WalkingParameters
from walking.pattern import zmp_kernel
from walking.pattern.dcm_pattern import dcm_reference
from walking.pattern.generator import make_generator
from walking.pattern.lipm import Lipm
from walking.pattern.pendulum import PendulumState
from walking.pattern.support import SupportRegion, support_region

import numpy as np
from scipy.spatial import ConvexHull
from study_page import RESULTS, add_seeds, command_line, environment

ROBOT = Path(__file__).resolve().parents[1] / "models" / "hsr8" / "hsr8.xml"
PAGE = RESULTS / "pattern.md"
GENERATORS = ("dcm", "preview", "paper", "robust")
OUTSIDE = 1e-9  # [m]
CLIPPED = 0.001  # more clipping than in the steady walk [m]
LOST = 0.1  # distance of the DCM from that of the footholds at which a walk is given up [m]
LOW = (0.18, 0.03, -0.08, 0.07, -0.3, 0.015)
HIGH = (0.45, 0.15, 0.12, 0.14, 0.3, 0.035)

BOX = (0.4, 0.15, 2.0)

Point = tuple[float, float]


class TracedLipm(Lipm):
    """A pendulum that notes the ZMP of everything that moves it."""

    def __init__(self, height: float) -> None:
        super().__init__(height)
        self.calls: list[Point] = []

    def step(self, position: float, velocity: float, zmp: float) -> Point:
        """As the pendulum."""
        self.calls.append((zmp, zmp))
        return super().step(position, velocity, zmp)

    def hold(self, position: float, velocity: float, zmp: float, time: float) -> Point:
        """As the pendulum."""
        self.calls.append((zmp, zmp))
        return super().hold(position, velocity, zmp, time)

    def walked(self) -> list[Point]:
        """Ends of all stretches of the ZMP since the last call."""
        calls, self.calls = self.calls, []
        points = []
        for x, y in zip(calls[::2], calls[1::2], strict=True):
            points += [(x[0], y[0]), (x[1], y[1])]
        return points


class CountingRegion:
    """A support region that notes by how much it had to clip."""

    def __init__(self, region: SupportRegion) -> None:
        self._region = region
        self.clipped = 0.0

    def __getattr__(self, name: str) -> object:
        return getattr(self._region, name)

    def clip(self, x: float, y: float) -> Point:
        """As the region."""
        inside = self._region.clip(x, y)
        self.clipped = max(self.clipped, hypot(inside[0] - x, inside[1] - y))
        return inside


class CountingPlan:
    """Makes plans as the kernel does, and notes how often their programs' gradients were needed."""

    def __init__(self) -> None:
        self._plan = zmp_kernel.plan
        self.evaluations = 0

    def __call__(self, *asked: object) -> tuple[bool, Point, int, np.ndarray]:
        """As the kernel."""
        made = self._plan(*asked)
        self.evaluations += made[2]
        return made


class Walker:
    """Steering, gait and generator without a body."""

    def __init__(self, name: str, sole: Sole) -> None:
        self.parameters = WalkingParameters(pattern=PatternParameters(generator=name))
        pattern, gait = self.parameters.pattern, self.parameters.gait
        self.sole = sole
        self.lipm = TracedLipm(pattern.lipm_height)
        self.generator = make_generator(self.lipm, pattern, sole)
        self.lipm.calls.clear()
        self.planner = FootstepPlanner(gait, self.parameters.limits, sole)
        h = gait.half_stance
        stance = (Foothold(True, 0.0, h, 0.0), Foothold(False, 0.0, -h, 0.0))
        self.gait = Gait(self.parameters, self.planner, stance)
        self.steering = Steering(
            self.planner, self.parameters.limits, selective=self.generator.selective
        )
        self.transition = Transition(self.gait, self.generator)
        start = self.gait.plan(stance[1], self.planner.still, moving=False)[-1]
        self.state = PendulumState(start.bx, start.by, zmp_x=start.bx, zmp_y=start.by)
        self.clipped = self.cost = self.late = self.missed = 0.0
        self.feet: tuple[Foothold, ...] = stance

    def tick(self, command: Command) -> list[Point]:
        """One control tick; the ZMP walked in it."""
        gait = self.gait
        self.transition.remember()
        self.steering.follow(command, 1.0, settled=True, balanced=True)
        gait.retime(self.steering.next_timing(gait.timing, stepping=gait.stepping))
        if not gait.stepping and self.steering.moving:
            gait.start(0)
        begin = time.process_time()
        region = CountingRegion(support_region(self.sole, *gait.support_feet, self._margin))
        wanted, moving = self.steering.strides(STILL), self.steering.moving
        if self.generator.selective:
            ramps = self.transition.admit(self.state, region, wanted, moving=moving)
            moving, gait.landing = self.transition.moving, self.transition.landing
        else:
            if gait.adjustable:
                gait.aim(gait.nominal(wanted))
            ramps = gait.plan(gait.landing, wanted, moving=moving)
        x, y = dcm_reference(self.lipm, ramps)
        p, w = self.state, self.lipm.omega
        own = (p.x + p.vx / w, p.y + p.vy / w)
        self.late = hypot(own[0] - x, own[1] - y)
        planned = self.generator.planned_dcm(p, ramps)
        self.missed = hypot(own[0] - planned[0], own[1] - planned[1])
        before = (p.zmp_x, p.zmp_y)
        self.generator.advance(p, ramps, region)
        self.cost = time.process_time() - begin
        self.clipped = region.clipped
        self.feet = gait.support_feet if gait.double else (gait.support_feet[1],)
        gait.advance(moving=moving)
        # Along a plan the ZMP is linear.
        return self.lipm.walked() or [before, (p.zmp_x, p.zmp_y)]

    def landed(self, axis: str) -> float:
        """Forward or side length of the last footstep [m]."""
        new, old = self.gait.footholds[self.gait.support], self.gait.footholds[self.gait.swing]
        dx, dy = new.x - old.x, new.y - old.y
        c, s = cos(old.yaw), sin(old.yaw)
        return c * dx + s * dy if axis == "forward" else abs(c * dy - s * dx)

    def outside(self, points: list[Point]) -> float:
        """Largest distance of points from the polygon of the feet, margin taken off [m]."""
        half = (self.sole.half_length - self._margin, self.sole.half_width - self._margin)
        if len(self.feet) == 1:
            foot = self.feet[0]
            c, s = cos(foot.yaw), sin(foot.yaw)
            distances = []
            for x, y in points:
                dx, dy = x - foot.x, y - foot.y
                along, across = c * dx + s * dy - self.sole.centre, c * dy - s * dx
                distances += [abs(along) - half[0], abs(across) - half[1]]
            return max(distances)
        corners = []
        for foot in self.feet:
            c, s = cos(foot.yaw), sin(foot.yaw)
            for a in (-half[0], half[0]):
                for b in (-half[1], half[1]):
                    u = self.sole.centre + a
                    corners.append((foot.x + c * u - s * b, foot.y + s * u + c * b))
        equations = ConvexHull(np.array(corners)).equations
        return float((np.array(points) @ equations[:, :2].T + equations[:, 2]).max())

    @property
    def _margin(self) -> float:
        return self.parameters.pattern.sole_margin


@dataclass
class Tally:
    """What a generator did with a new command in every tick."""

    ticks: int = 0
    steps: int = 0
    outside: int = 0
    worst: float = 0.0
    clipped: int = 0
    altered: int = 0
    refused: int = 0
    lost: int = 0
    missed: float = 0.0
    late: list[float] = field(default_factory=list)
    cost: list[float] = field(default_factory=list)
    evaluations: list[int] = field(default_factory=list)


def commands_of(seed: int, duration: float) -> list[Command]:
    """A velocity or a command state for every tick."""
    rng = np.random.default_rng([seed, 23])
    ticks = round(duration / CONTROL_PERIOD)
    states = rng.uniform(LOW, HIGH, (ticks, 6)).tolist()
    velocities = (rng.uniform(-1.0, 1.0, (ticks, 3)) * BOX).tolist()
    explicit = rng.uniform(size=ticks) < 0.5
    return [
        CommandState(*state) if choice else VelocityCommand(*velocity)
        for state, velocity, choice in zip(states, velocities, explicit, strict=True)
    ]


def every_tick(name: str, sole: Sole, seeds: list[int], duration: float) -> Tally:
    """A new command in every tick, checked between the ticks, too."""
    tally, plans = Tally(), CountingPlan()
    for seed in seeds:
        walker = Walker(name, sole)
        for command in commands_of(seed, duration):
            before, plans.evaluations = walker.gait.completed, 0
            with mock.patch.object(zmp_kernel, "plan", plans):
                points = walker.tick(command)
            tally.evaluations.append(plans.evaluations)
            distance = walker.outside(points)
            tally.ticks += 1
            tally.outside += distance > OUTSIDE
            tally.worst = max(tally.worst, distance)
            tally.clipped += walker.clipped > OUTSIDE
            tally.altered += walker.transition.fraction < 1.0
            tally.refused += walker.transition.fraction == 0.0
            tally.missed = max(tally.missed, walker.missed)
            tally.cost.append(walker.cost)
            if walker.gait.completed > before:
                tally.steps += 1
                tally.late.append(walker.late)
                if walker.late > LOST:
                    tally.lost += 1
                    walker = Walker(name, sole)
    return tally


def largest_change(name: str, sole: Sole, left: float, axis: str) -> tuple[float, float]:
    """Largest later and shorter, or wider and narrower, landing with the ZMP in the sole [m]."""
    found = []
    for sign in (1.0, -1.0):
        best = 0.0
        for change in np.arange(0.005, 0.0801, 0.005).tolist():
            walker = Walker(name, sole)
            base = CommandState(forward=0.03, side=0.10)
            while walker.gait.completed < 6 or walker.gait.double:
                walker.tick(base)
            steady = 0.0
            for _ in range(136):
                walker.tick(base)
                steady = max(steady, walker.clipped)
            while walker.gait.ticks_left > round(left / CONTROL_PERIOD) or walker.gait.double:
                walker.tick(base)
            moved = {axis: getattr(base, axis) + sign * change}
            command = CommandState(**({"forward": base.forward, "side": base.side} | moved))
            support, kept = walker.gait.support, True
            while kept and walker.gait.support == support:
                walker.tick(command)
                kept = walker.clipped <= steady + CLIPPED and walker.transition.fraction == 1.0
            if not kept or abs(walker.landed(axis) - moved[axis]) > CLIPPED:
                break
            best = change
        found.append(best)
    return found[0], found[1]


def every_tick_table(
    sole: Sole, seeds: list[int], duration: float, generators: list[str]
) -> list[str]:
    lines = [
        "| generator | ticks | steps | ZMP outside, ticks (worst) | wanted outside, clipped | "
        "command altered / refused | DCM off the footholds' at landing p50 / p99 / max | "
        "off its plan, max | lost | "
        "replan mean / p99 / p99.9 / max | gradients of a tick mean / p99 / max |",
        "|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for name in generators:
        t = every_tick(name, sole, seeds, duration)
        effort = np.array(t.evaluations)
        late, cost = 1e3 * np.array(t.late), 1e6 * np.array(t.cost)
        lines.append(
            f"| {name} | {t.ticks} | {t.steps} | {t.outside} ({1e3 * max(0.0, t.worst):.1f} mm) | "
            f"{100.0 * t.clipped / t.ticks:.1f} % | "
            f"{100.0 * t.altered / t.ticks:.1f} / {100.0 * t.refused / t.ticks:.1f} % | "
            f"{np.median(late):.1f} / {np.percentile(late, 99):.1f} / {late.max():.1f} mm | "
            f"{1e3 * t.missed:.2f} mm | {t.lost} | "
            f"{cost.mean():.0f} / {np.percentile(cost, 99):.0f} / "
            f"{np.percentile(cost, 99.9):.0f} / {cost.max():.0f} us | "
            f"{effort.mean():.1f} / {np.percentile(effort, 99):.0f} / {effort.max()} |"
        )
        print(lines[-1], flush=True)
    return lines


def landing_table(sole: Sole) -> list[str]:
    lefts = (0.25, 0.20, 0.15, 0.10, 0.075)
    lines = []
    for axis, names in (("forward", "longer / shorter"), ("side", "wider / narrower")):
        lines += [
            f"| {names}, mm | " + " | ".join(f"{left:.3f} s left" for left in lefts) + " |",
            "|---" * (len(lefts) + 1) + "|",
        ]
        for name in GENERATORS:
            cells = []
            for left in lefts:
                more, less = largest_change(name, sole, left, axis)
                cells.append(f"{1e3 * more:.1f} / {1e3 * less:.1f}")
            lines.append(f"| {name} | " + " | ".join(cells) + " |")
            print(lines[-1], flush=True)
        lines.append("")
    return lines


def main() -> None:
    """Run the studies."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("study", choices=("every-tick", "landing", "all"))
    add_seeds(parser, range(1000, 1005))
    parser.add_argument("--duration", type=float, default=60.0)
    parser.add_argument("--write", action="store_true", help=f"write {PAGE.name}")
    parser.add_argument("--generators", nargs="+", choices=GENERATORS, default=GENERATORS)
    options = parser.parse_args()
    sole = RobotModel.from_mjcf(ROBOT).sole
    first = second = [""]
    if options.study in ("every-tick", "all"):
        first = every_tick_table(sole, options.seeds, options.duration, options.generators)
    if options.study in ("landing", "all"):
        second = landing_table(sole)
    if options.write:
        PAGE.parent.mkdir(parents=True, exist_ok=True)
        PAGE.write_text(page(options, first, second), encoding="utf-8")


def page(options: argparse.Namespace, first: list[str], second: list[str]) -> str:
    """The page of results."""
    seeds = f"{options.seeds[0]}-{options.seeds[-1]}"
    return "\n".join(
        [
            "# Pattern generators under a new command in every tick",
            "",
            f"Pendulum alone, no body: `{command_line()}`, {environment(('hsr8', 'numpy'))}.",
            "",
            f"## A new command in every tick (seeds {seeds}, {options.duration:g} s each)",
            "",
            "Every 5 ms a new command is drawn: with even chances a velocity (±0.4 m/s, ±0.15 m/s, "
            "±2 rad/s) or a command state with single and double support times, forward and side "
            "length, direction and swing height all random. The ZMP is checked against the polygon "
            "of the feet less the margin at both ends of every stretch of constant or linear ZMP, "
            "so between the ticks too. `dcm` and `preview` clip: they keep the ZMP inside and the "
            "footholds, and are late; `paper` and `robust` alter the command instead. A walk is "
            f"lost when the DCM is {1e3 * LOST:g} mm off that of its footholds at a landing. In "
            "`paper` the ZMP may be clipped in double support, which its ZMP functions leave "
            "out; `robust` plans to use the next sole, too, so it is off the footholds' DCM "
            "without being off its plan. `preview` has no plan of its DCM. Replan: "
            "CPU time of plan, transition and pendulum in one tick, one core of a shared machine.",
            "",
            *first,
            "",
            "## Largest change of one landing that needs no clipping and no alteration",
            "",
            "From a steady walk of 30 mm footsteps, feet 100 mm apart; searched in steps of "
            "5 mm up to 80 mm. The foot has to land there within 1 mm, unaltered and with no "
            "more clipping than in the steady walk until it has. Landings freeze 70 ms before "
            "the end of single support, and a foot in the air is re-aimed at 4 m/s at most: 20 mm "
            "at 0.075 s left. `preview` clips in the steady walk already, which flatters its "
            "rows; what it does to the walk is in the table above.",
            "",
            *second,
        ]
    )


if __name__ == "__main__":
    main()
