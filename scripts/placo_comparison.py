"""The walk pattern replanned by placo and by this package under the same commands, side by side.

    python -m venv placo-venv
    placo-venv/bin/python -m pip install placo scipy annotated-types
    PYTHONPATH=. placo-venv/bin/python scripts/placo_comparison.py --seeds 1000 1001

placo brings its own release of Pinocchio, hence an environment of its own. A new random
velocity is asked for in every control tick of 5 ms; placo takes it whenever it can, which is in
single support. Same pendulum, soles, margin, stance and times of the footsteps for both.
"""

import argparse
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from walking.body.sole import Sole
from walking.command import VelocityCommand
from walking.parameters import CONTROL_PERIOD, WalkingParameters

import numpy as np
from pattern_study import OUTSIDE, Walker
from study_page import add_seeds

try:
    import placo
except ImportError:
    print(
        "placo is not installed: python -m pip install placo (see the docstring)", file=sys.stderr
    )
    raise SystemExit(2) from None

SOLE = Sole(centre=0.01, half_length=0.0525, half_width=0.03)
BOX = (0.3, 0.1, 0.8)  # vx, vy [m/s], wz [rad/s]
STEPS = 4  # footsteps planned ahead
TOLERANCE = 1e-4  # of a ZMP outside the sole [m]


@dataclass
class Account:
    """What a planner did: ticks, replans and ZMP outside the sole."""

    ticks: int = 0
    failed: int = 0
    outside: int = 0
    worst: float = 0.0
    cost: list[float] = field(default_factory=list)

    def check(self, distance: float, tolerance: float) -> None:
        """Count a tick by how far its ZMP is outside [m]."""
        self.ticks += 1
        self.outside += distance > tolerance
        self.worst = max(self.worst, distance)

    def line(self, name: str) -> str:
        """A row of the table."""
        cost = 1e3 * np.array(self.cost)
        return (
            f"| {name} | {self.ticks} | {cost.size} | {cost.mean():.3f} / "
            f"{np.percentile(cost, 99):.3f} / {cost.max():.3f} ms | {self.failed} | "
            f"{self.outside} ({100.0 * self.outside / self.ticks:.1f} %), "
            f"{1e3 * self.worst:.1f} mm |"
        )


def velocities(seed: int, duration: float) -> list[list[float]]:
    """A velocity for every control tick."""
    rng = np.random.default_rng([seed, 29])
    drawn: list[list[float]] = (
        rng.uniform(-1.0, 1.0, (round(duration / CONTROL_PERIOD), 3)) * BOX
    ).tolist()
    return drawn


def ours(account: Account, seed: int, duration: float) -> None:
    """The robust generator."""
    walker = Walker("robust", SOLE)
    for velocity in velocities(seed, duration):
        points = walker.tick(VelocityCommand(*velocity))
        account.cost.append(walker.cost)
        account.check(walker.outside(points), OUTSIDE)


def urdf() -> str:
    """Two legs with the robot's dimensions; placo asks for a whole robot, the pattern for none."""
    mass = (
        '<inertial><origin xyz="0 0 0"/><mass value="0.4"/>'
        '<inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial>'
    )
    parts = [f'<robot name="legs"><link name="trunk">{mass}</link>']
    chain = (
        ("hip_yaw", "0 0 1", ""),
        ("hip_roll", "1 0 0", "0 0 0"),
        ("hip_pitch", "0 1 0", "0 0 0"),
        ("knee", "0 1 0", "0 0 -0.105"),
        ("ankle_pitch", "0 1 0", "0 0 -0.105"),
        ("ankle_roll", "1 0 0", "0 0 0"),
    )
    for side, y in (("left", 0.035), ("right", -0.035)):
        parent = "trunk"
        for name, axis, place in chain:
            child = f"{side}_{name}_link"
            parts.append(
                f'<link name="{child}">{mass}</link><joint name="{side}_{name}" type="revolute">'
                f'<parent link="{parent}"/><child link="{child}"/>'
                f'<origin xyz="{place or f"0 {y} 0"}" rpy="0 0 0"/><axis xyz="{axis}"/>'
                '<limit lower="-3" upper="3" effort="10" velocity="20"/></joint>'
            )
            parent = child
        parts.append(
            f'<link name="{side}_foot">{mass}</link><joint name="{side}_sole" type="fixed">'
            f'<parent link="{parent}"/><child link="{side}_foot"/>'
            '<origin xyz="0 0 -0.035" rpy="0 0 0"/></joint>'
        )
    return "".join([*parts, "</robot>"])


def settings() -> Any:
    """Parameters of placo equal to ours."""
    gait, pattern = WalkingParameters().gait, WalkingParameters().pattern
    limits = WalkingParameters().limits
    ticks = round(gait.footstep_time / CONTROL_PERIOD)
    double = max(1, round(gait.double_support * ticks))
    p = placo.HumanoidParameters()
    p.single_support_duration = (ticks - double) * CONTROL_PERIOD
    p.single_support_timesteps = 10
    p.double_support_ratio = double / (ticks - double)
    p.startend_double_support_ratio = 1.0
    p.planned_timesteps = 48
    p.zmp_margin = pattern.sole_margin
    p.walk_com_height = pattern.lipm_height
    p.walk_foot_height = gait.swing_height
    p.feet_spacing = 2.0 * gait.half_stance
    p.foot_length, p.foot_width = 2.0 * SOLE.half_length, 2.0 * SOLE.half_width
    p.foot_zmp_target_x = p.foot_zmp_target_y = 0.0
    p.walk_max_dx_forward = p.walk_max_dx_backward = limits.step_forward
    p.walk_max_dy, p.walk_max_dtheta = limits.step_side, limits.step_turn
    return p


def beyond(polygon: np.ndarray, point: np.ndarray) -> float:
    """How far a point is outside a convex polygon (n, 2), its edges in either sense [m]."""
    edges = np.roll(polygon, -1, axis=0) - polygon
    normals = np.stack([edges[:, 1], -edges[:, 0]], axis=1)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    middle = polygon.mean(axis=0)
    normals *= np.sign(((polygon - middle) * normals).sum(axis=1))[:, None]
    return float(((point - polygon) * normals).sum(axis=1).max())


def theirs(account: Account, seed: int, duration: float) -> None:
    """Replan by placo, checked at the ticks and in the middle between them, without its margin."""
    p = settings()
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "robot.urdf").write_text(urdf(), encoding="utf-8")
        robot = placo.HumanoidRobot(folder)
    robot.update_kinematics()
    planner = placo.FootstepsPlannerRepetitive(p)
    pattern = placo.WalkPatternGenerator(robot, p)
    omega = float(np.sqrt(9.81 / p.walk_com_height))
    footstep = p.single_support_duration * (1.0 + p.double_support_ratio)
    left, right = np.eye(4), np.eye(4)
    left[1, 3], right[1, 3] = 0.5 * p.feet_spacing, -0.5 * p.feet_spacing
    planner.configure(0.0, 0.0, 0.0, STEPS)
    steps = planner.plan(placo.HumanoidRobot_Side.left, left, right)
    supports = placo.FootstepsPlanner.make_supports(steps, 0.0, True, p.has_double_support(), True)
    plan = pattern.plan(supports, np.array([0.0, 0.0, p.walk_com_height]), 0.0)
    last = 0.0
    for tick, velocity in enumerate(velocities(seed, duration)):
        now = tick * CONTROL_PERIOD
        if pattern.can_replan_supports(plan, now):
            begin = time.process_time()
            planner.configure(*(v * footstep for v in velocity), STEPS)
            supports = pattern.replan_supports(planner, plan, now, last)
            found = pattern.replan(supports, plan, now)
            account.cost.append(time.process_time() - begin)
            account.failed += not found.replan_success
            if found.replan_success:
                plan, last = found, now
        worst = -np.inf
        for at in (now, now + 0.5 * CONTROL_PERIOD):
            polygon = np.array([np.ravel(q) for q in plan.get_support(at).support_polygon()])
            zmp = np.ravel(plan.get_p_world_ZMP(at, omega))[:2]
            worst = max(worst, beyond(polygon, zmp))
        account.check(worst, TOLERANCE)


def main() -> None:
    """Run both and print a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_seeds(parser, (1000, 1001))
    parser.add_argument("--duration", type=float, default=20.0)
    options = parser.parse_args()
    mine, other = Account(), Account()
    for seed in options.seeds:
        ours(mine, seed, options.duration)
        theirs(other, seed, options.duration)
    ratio = np.mean(other.cost) / np.mean(mine.cost)
    print("| planner | ticks | replans | replan mean / p99 / max | failed | ZMP outside, worst |")
    print("|---|---|---|---|---|---|")
    print(mine.line("robust"))
    print(other.line("placo"))
    print(f"\nA replan takes placo {ratio:.0f} times as long.")


if __name__ == "__main__":
    main()
