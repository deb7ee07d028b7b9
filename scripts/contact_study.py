"""Why the robot touches things: what it believed in the seconds before every contact.

    python scripts/contact_study.py paper --seeds 0-9 --body kinematic --camera analytic

Every contact gets one cause, the first that holds in the `BEFORE` seconds ahead of it:

    static      an obstacle that stands still
    reversed    the mover turned back less than `REVERSED` seconds before
    untracked   no track within `ASTRAY` of the mover half of the time
    unseen      tracked, but not detected for more than a second
    velocity    tracked, its velocity wrong by more than half
    planner     seen and tracked rightly

Near misses (less than `NEAR` between the bodies) are counted beside the contacts, for there
are more of them.
"""

import argparse
import json
import sys
import time
from collections import Counter, deque
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hsr8.loop import Simulation
from hsr8.recorder.record import FrameRecord, TickRecord
from hsr8.scenario.loader import load
from hsr8.world.layout import Layout
from navigation.belief import Track

BEFORE = 4.0  # [s]
REVERSED = 1.5  # [s]
ASTRAY = 0.15  # [m]
NEAR = 0.03  # [m]
GAP = 0.5  # a touch after a pause as long as this is a new one [s]


@dataclass(frozen=True, slots=True)
class Moment:
    """Belief and truth of one camera frame."""

    frame: FrameRecord
    robot: np.ndarray
    position: np.ndarray
    velocity: np.ndarray


class ContactWatch:
    """Listens to a run, keeps the last seconds and explains every contact."""

    def __init__(self, layout: Layout, verbose: bool) -> None:
        self.colours = [o.colour for o in layout.obstacles]
        self.verbose = verbose
        self.moments: deque[Moment] = deque()
        self.touched: dict[int, float] = {}
        self.near_until = -np.inf
        self.near = 0
        self.contacts: list[dict] = []
        self.tour = 0
        self.done: float | None = None
        self.time = 0.0

    def on_record(self, record: TickRecord) -> None:
        """Keep the last seconds; explain every new contact."""
        truth = record.truth
        self.time = truth.time
        if record.frame is not None:
            self.moments.append(
                Moment(
                    record.frame, truth.robot, truth.obstacle_positions, truth.obstacle_velocities
                )
            )
            while self.moments[0].frame.time < truth.time - BEFORE:
                self.moments.popleft()
            self.tour = record.frame.task.index
            if record.frame.task.done and self.done is None:
                self.done = truth.time
        if truth.clearance < NEAR:
            if truth.time > self.near_until:
                self.near += 1
            self.near_until = truth.time + 2.0
        for obstacle in sorted({c.obstacle for c in truth.contacts}):
            before = self.touched.get(obstacle, -np.inf)
            self.touched[obstacle] = truth.time
            if truth.time - before >= GAP:
                moving = any(c.moving for c in truth.contacts if c.obstacle == obstacle)
                geoms = [c.robot_geom for c in truth.contacts if c.obstacle == obstacle]
                self.contacts.append(self._explain(obstacle, moving, geoms[0], truth.robot))

    def on_event(self, time: float, kind: str, text: str) -> None:
        """Events say nothing that records do not."""

    def close(self, exit_reason: str) -> None:
        """Note how the run ended."""
        self.exit_reason = exit_reason

    def _track(self, moment: Moment, obstacle: int) -> tuple[Track | None, float]:
        """The track nearest to an obstacle, and how far off it is."""
        best, least = None, np.inf
        place = moment.position[obstacle]
        for track in moment.frame.belief.tracks:
            if track.label != self.colours[obstacle]:
                continue
            off = float(np.hypot(*(track.position - place)))
            if track.particles is not None:
                off = min(off, float(np.hypot(*(track.particles.positions - place).T).min()) + 0.05)
            if off < least:
                best, least = track, off
        return best, least

    def _explain(self, obstacle: int, moving: bool, geom: str, robot: np.ndarray) -> dict:
        moments = list(self.moments)
        tracks = [self._track(moment, obstacle) for moment in moments]
        true = [moment.velocity[obstacle] for moment in moments]
        turns = [
            self.time - moment.frame.time
            for moment, before, now in zip(moments[1:], true, true[1:], strict=False)
            if float(before @ now) < 0.0
        ]
        early = [m.frame.time < self.time - 0.4 for m in moments]
        astray = np.mean([off > ASTRAY for (_, off), k in zip(tracks, early, strict=True) if k])
        found = [(track, v) for (track, _), v in zip(tracks, true, strict=True) if track]
        wrong = [np.hypot(*(track.velocity - v)) > 0.5 * np.hypot(*v) for track, v in found]
        if not moving:
            cause = "static"
        elif turns and turns[-1] < REVERSED:
            cause = "reversed"
        elif astray > 0.4:
            cause = "untracked"
        elif any(track.age > 1.0 for track, _ in found[-12:]):
            cause = "unseen"
        elif wrong and np.mean(wrong) > 0.3:
            cause = "velocity"
        else:
            cause = "planner"
        _, bearing = polar(moments[-1].position[obstacle], robot)
        if self.verbose:
            print(f"  {self.time:.2f} {cause} {geom}")
            for moment in moments[::3]:
                print("    " + self._line(moment, obstacle))
        return {
            "t": round(self.time, 2),
            "cause": cause,
            "geom": geom,
            "bearing": round(bearing),
            "speed": round(float(np.hypot(*moments[-1].frame.motion.velocity[:2])), 3),
        }

    def _line(self, moment: Moment, obstacle: int) -> str:
        """What was true, done, believed and seen of an obstacle at one moment."""
        frame, place, true = moment.frame, moment.position[obstacle], moment.velocity[obstacle]
        distance, bearing = polar(place, moment.robot)
        pan, tilt = np.degrees([frame.belief.view.pan, frame.belief.view.tilt])
        line = (
            f"{frame.time:7.2f} d={distance:.2f} b={bearing:4.0f}"
            f" v=({true[0]:+.2f},{true[1]:+.2f}) go={frame.motion.velocity.round(2)}"
            f" look={pan:3.0f},{tilt:3.0f} {frame.motion.situation}"
        )
        track, astray = self._track(moment, obstacle)
        if track is not None and astray < 1.0:
            kind = "lost" if track.particles is not None else track.motion.name
            line += (
                f" #{track.id} {kind} off={astray:.2f} age={track.age:.2f} "
                f"v=({track.velocity[0]:+.2f},{track.velocity[1]:+.2f})"
            )
        pose = frame.belief.pose
        for d in frame.detections:
            way = pose[2] + d.bearing
            seen = pose[:2] + d.distance * np.array([np.cos(way), np.sin(way)])
            miss = float(np.hypot(*(seen - place)))
            if d.label == self.colours[obstacle] and miss < 0.6:
                sigma = np.sqrt(d.covariance[0, 0])
                line += f" SEEN off={miss:.2f} sd={sigma:.2f}{'C' * d.cut}{'O' * d.occluded}"
        return line


def polar(place: np.ndarray, robot: np.ndarray) -> tuple[float, float]:
    """Distance [m] and bearing [degree] of a place from the robot (3,)."""
    x, y = (place - robot[:2]).tolist()
    bearing = float(np.degrees(np.arctan2(y, x) - robot[2]))
    return float(np.hypot(x, y)), (bearing + 180.0) % 360.0 - 180.0


def run(scenario: str, seed: int, settings: list[str], verbose: bool) -> dict:
    """One run and its contacts."""
    loaded = load(scenario, tuple(settings), seed)
    simulation = Simulation(loaded, seed)
    watch = ContactWatch(simulation.layout, verbose)
    simulation.listeners.append(watch)
    started = time.perf_counter()
    outcome = simulation.run()
    return {
        "seed": seed,
        "exit": outcome.exit_reason,
        "success": outcome.exit_reason == "goal" and not watch.contacts,
        "time": round(outcome.time, 1),
        "passed": watch.tour,
        "near": watch.near,
        "contacts": watch.contacts,
        "factor": round(outcome.time / (time.perf_counter() - started), 2),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenario")
    parser.add_argument("--seeds", default="0-9", help="first-last, both included")
    parser.add_argument("--body", default="kinematic")
    parser.add_argument("--camera", default="analytic")
    parser.add_argument("--set", action="append", default=[], help="key=value of the scenario")
    parser.add_argument("--verbose", action="store_true", help="print belief before contacts")
    parser.add_argument("--out", type=Path, help="JSON lines to write")
    arguments = parser.parse_args()
    settings = [f"robot.body={arguments.body}", f"camera.source={arguments.camera}"]
    settings += arguments.set
    first, last = (int(part) for part in arguments.seeds.split("-"))
    rows = []
    for seed in range(first, last + 1):
        row = run(arguments.scenario, seed, settings, arguments.verbose)
        rows.append(row)
        print(json.dumps(row), flush=True)
        if arguments.out:
            arguments.out.write_text("".join(json.dumps(r) + "\n" for r in rows))
    causes = Counter(c["cause"] for r in rows for c in r["contacts"])
    simulated = sum(r["time"] for r in rows)
    print(
        f"{sum(r['success'] for r in rows)} of {len(rows)} succeed; "
        f"{sum(causes.values())} contacts, {sum(r['near'] for r in rows)} near misses "
        f"in {simulated:.0f} s: {dict(causes)}; {sum(r['passed'] for r in rows)} via points",
        file=sys.stderr,
    )


if __name__ == "__main__":
    main()
