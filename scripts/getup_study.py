"""Push a walking robot over in full physics; count how often it gets up and walks on.

    python scripts/getup_study.py --seeds 0-19
    python scripts/getup_study.py --seeds 1000-1099 --write

A push of 3 to 4 N s in 50 ms comes from a random side in a walk at a random velocity.
Tune on seeds 0-99, report on seeds from 1000.
"""

import argparse
from collections import Counter
from dataclasses import dataclass

from hsr8.robots.loaded import load_robot
from walking.body.robot_model import RobotModel
from walking.command import HeadTarget, VelocityCommand
from walking.get_up.get_up import Outcome
from walking.get_up.lying import lying_on, up_in_trunk
from walking.parameters import CONTROL_PERIOD, GetUpParameters, WalkingParameters
from walking.walker import Walker

import numpy as np
from study_page import RESULTS, add_seeds, command_line, environment
from walking_body import Body, Plant

RESULT = RESULTS / "getup.md"
LEAD = (2.0, 3.0)  # of walking before the push [s]
PUSH = 0.05  # duration [s]
IMPULSE = (3.0, 4.0)  # [N s]
FALL_TIME = 2.5  # time after the push within which a fall counts [s]
PATIENCE = 60.0  # limit for getting up [s]
AFTER = 5.0  # walking time after getting up in which a second fall counts [s]
BOX = ((-0.2, -0.1, -0.8), (0.4, 0.1, 0.8))  # velocity [m/s, m/s, rad/s]


@dataclass(frozen=True)
class Fall:
    """Result of one push.

    Attributes:
        side: side on which the robot lay first.
        time: from the fall to standing, None if it never stood [s].
        attempts: number of motions.
        again: whether the robot fell again within `AFTER`.
        drift: error of the odometry from the push to standing [m].
        turn: error of its heading [rad].
    """

    side: str
    time: float | None
    attempts: int
    again: bool
    drift: float = np.nan
    turn: float = np.nan


class Trial:
    """Walk with one push.

    Args:
        robot: model of the robot.
        plant: true body.
        seed: of all random numbers.
    """

    def __init__(self, robot: RobotModel, plant: Plant, seed: int) -> None:
        rng = np.random.default_rng([seed, 23])
        self._body = Body(rng, plant)
        parameters = WalkingParameters(get_up=GetUpParameters(enabled=True))
        self._walker = Walker(robot, parameters)
        self._lead, self._impulse = rng.uniform(*LEAD), rng.uniform(*IMPULSE)
        angle = rng.uniform(0.0, 2.0 * np.pi)
        self._direction = np.array([np.cos(angle), np.sin(angle)])
        self._command = VelocityCommand(*rng.uniform(*BOX).tolist())

    def run(self) -> Fall | None:
        """Walk, fall, get up, walk on; None if the push did not fell the robot."""
        body, walker = self._body, self._walker
        self._walk(self._lead)
        before = self._poses()
        body.data.xfrc_applied[body.torso, :2] = self._impulse / PUSH * self._direction
        self._walk(PUSH)
        body.data.xfrc_applied[body.torso, :2] = 0.0
        self._walk(FALL_TIME, until_down=True)
        if not walker.down:
            return None
        fallen_at = body.data.time
        side, attempts = "", 0
        while walker.down and body.data.time - fallen_at < PATIENCE:
            get_up = walker.get_up
            if get_up.attempts and not side:
                side = str(lying_on(up_in_trunk(body.data.qpos[3:7].tolist())))
            attempts = get_up.attempts
            if get_up.outcome is Outcome.GAVE_UP:
                break
            self._tick()
        if walker.down:
            return Fall(side, None, attempts, again=False)
        time = body.data.time - fallen_at
        drift, turn = missed(before, self._poses())
        self._walk(AFTER, until_down=True)
        return Fall(side, time, attempts, again=walker.down, drift=drift, turn=turn)

    def _poses(self) -> tuple[np.ndarray, np.ndarray]:
        odometry = self._walker.state().odometry
        return self._body.pose, np.array([odometry.x, odometry.y, odometry.yaw])

    def _walk(self, seconds: float, *, until_down: bool = False) -> None:
        for _ in range(round(seconds / CONTROL_PERIOD)):
            self._tick()
            if until_down and self._walker.down:
                return

    def _tick(self) -> None:
        targets = self._walker.step(self._body.sense(), self._command, HeadTarget())
        self._body.apply(targets.setpoint)


def missed(
    before: tuple[np.ndarray, np.ndarray], after: tuple[np.ndarray, np.ndarray]
) -> tuple[float, float]:
    """Return the odometry error between two pairs of true and believed pose [m, rad]."""
    moves = []
    for old, new in zip(before, after, strict=True):
        c, s = np.cos(old[2]), np.sin(old[2])
        moves.append(np.array([[c, s], [-s, c]]) @ (new - old)[:2])
    turn = (after[1] - before[1] - after[0] + before[0])[2]
    return float(np.linalg.norm(moves[1] - moves[0])), float(np.angle(np.exp(1j * turn)))


def table(name: str, falls: list[Fall]) -> list[str]:
    """Return the rows by the side on which the robot lay first."""
    rows = []
    sides = Counter(f.side for f in falls)
    for side in (*sorted(sides), "all"):
        these = [f for f in falls if side in ("all", f.side)]
        times = np.array([f.time for f in these if f.time is not None])
        first = sum(
            f.time is not None and f.attempts <= (1 if f.side == "front" else 2) for f in these
        )
        spread = "—"
        if len(times):
            low, high = np.percentile(times, [50, 95])
            spread = f"{low:.1f} / {high:.1f} / {times.max():.1f}"
        drift, turn = np.sqrt(np.nanmean([(f.drift**2, f.turn**2) for f in these], axis=0))
        rows.append(
            f"| {name} | {side} | {len(these)} | {len(times)} ({len(times) / len(these):.0%}) "
            f"| {first} | {spread} | {sum(f.again for f in these)} | {drift:.2f}, {turn:.3f} |"
        )
    return rows


HEAD = (
    "| body | first lain on | falls | got up | of them without a repeat "
    "| time p50 / p95 / max, s | fell again within 5 s | odometry off by, rms, m, rad |\n"
    "|---|---|---|---|---|---|---|---|"
)


def falls_study(robot: RobotModel, seeds: list[int], *, write: bool) -> None:
    """Print the table, and write it into the page if `write`."""
    lines = [HEAD]
    for name, plant in (
        ("as modelled", Plant()),
        ("touching itself", Plant(self_contact=True)),
    ):
        results = [Trial(robot, plant, seed).run() for seed in seeds]
        falls = [fall for fall in results if fall is not None]
        for seed, fall in zip(seeds, results, strict=True):
            if fall is not None and (fall.time is None or fall.again):
                print(seed, fall)
        lines += table(name, falls)
        print("\n".join(lines), flush=True)
    if write:
        text = RESULT.read_text(encoding="utf-8")
        before = text[: text.index("<!-- table -->")]
        body = "\n".join(lines)
        RESULT.write_text(
            f"{before}<!-- table -->\n`{command_line()}`, {environment()}.\n\n{body}\n", "utf-8"
        )


def main() -> None:
    """Run the study."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_seeds(parser, range(10))
    parser.add_argument("--write", action="store_true", help=f"into {RESULT.name}")
    options = parser.parse_args()
    falls_study(load_robot("hsr8").model, options.seeds, write=options.write)


if __name__ == "__main__":
    main()
