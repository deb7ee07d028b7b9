"""Catalogue of failures: runs up to their first contact or fall, and why it came.

    python scripts/failure_study.py course fast --seeds 0-19 --out docs/results/failures.md

A run is the whole loop, with a kinematic body and the analytic camera unless `--set` says
otherwise. The cause is the first rule of `KINDS` that holds. One picture of every kind goes
beside the page: the world from above, what is true outlined, what is believed filled.
"""

import argparse
from collections import deque
from dataclasses import dataclass
from math import degrees, hypot, pi
from pathlib import Path

from hsr8.evaluation.proportion import Proportion
from hsr8.loop import Simulation
from hsr8.recorder.frame_record import FrameRecord
from hsr8.recorder.record import Listener, TickRecord
from hsr8.recorder.run.frame_summary import from_line, to_line
from hsr8.render.png import write_png
from hsr8.render.top_down import TopDown
from hsr8.scenario.loader import load_scenario
from hsr8.world.truth.truth import Contact, Truth
from navigation.angles import wrap
from navigation.belief.belief import Motion, Track

import numpy as np
from numpy.typing import NDArray
from study_page import STAND_INS, add_seeds, command_line

Array = NDArray[np.float64]

NEAR = 0.30  # a track farther from the obstacle is of another one [m]
FORGOTTEN = 1.0  # what was seen longer ago counts as unseen [s]
PLACE_OFF, VELOCITY_OFF, RADIUS_OFF = 0.06, 0.08, 0.03  # tolerable errors [m, m/s, m]
BEFORE = 2.0  # freedom is judged so long before the contact [s]
HEADINGS, STRIDE, BODY = 24, 2.0, 0.14  # directions tried, for so long [s], of a body so wide [m]
SLOW = 0.5  # share of its forward speed below which the robot is slow [1]
PICTURE = (640, 640)
KINDS = {
    "fell": "the robot fell, and touched nothing before",
    "beacon": "it touched a beacon, whose place it knew",
    "unseen": "what it touched had no track, or was seen last more than a second ago",
    "misjudged": "seen, but its place, velocity, size or class was wrong",
    "trapped": "seen and right, but two seconds before no straight walk was free",
    "too slow": "seen and right, it came while the robot stood, turned or side-stepped",
    "grazed": "seen and right, the robot passed too close",
}


@dataclass
class Failure:
    """Why a run failed.

    Attributes:
        scenario, seed: of the run.
        kind: one of `KINDS`.
        time: when [s].
        what: in words.
    """

    scenario: str
    seed: int
    kind: str
    time: float
    what: str


class Watch(Listener):
    """Listener that keeps the last seconds and stops the run at its first contact or fall."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        layout = simulation.layout
        self.radii = np.array([o.radius for o in (*layout.obstacles, *layout.beacons)])
        self.beacons = np.array([b.position for b in layout.beacons]).reshape(-1, 2)
        self.forward = simulation.scenario.speed_limits().vx
        self.recent: deque[Truth] = deque()
        self.trail: list[list[float]] = []
        self.frame: FrameRecord | None = None
        self.seen: Truth | None = None
        self.end: Truth | None = None

    def on_record(self, record: TickRecord) -> None:
        """Keep it; stop once it shows a contact or a fall."""
        if self.end is not None:
            return
        self.recent.append(record.truth)
        while self.recent[0].time < record.time - BEFORE:
            self.recent.popleft()
        self.trail.append(record.truth.robot[:2].tolist())
        if record.frame is not None:
            self.frame, self.seen = record.frame, record.truth
        if record.truth.contacts or record.truth.fallen:
            self.end = record.truth
            self._simulation.interrupt()

    def solids(self, truth: Truth) -> tuple[Array, Array]:
        """Axes and velocities of obstacles and, after them, beacons (n, 2), (n, 2) [m, m/s]."""
        still = np.zeros_like(self.beacons)
        return (
            np.concatenate([truth.obstacle_positions, self.beacons]),
            np.concatenate([truth.obstacle_velocities, still]),
        )


def cause_of(watch: Watch, end: Truth) -> tuple[str, str]:
    """Kind of the failure that ended the watched run at `end`, and what it was in words."""
    then = watch.recent[0]
    if not end.contacts:
        return "fell", "no contact before"
    contact = end.contacts[0]
    place, velocity = (of_all[contact.obstacle] for of_all in watch.solids(end))
    walk = hypot(*(end.robot[:2] - then.robot[:2]).tolist()) / max(end.time - then.time, 1e-9)
    what = _words(contact, end, place, velocity, walk)
    if contact.obstacle >= len(end.obstacle_positions):
        return "beacon", what
    tracks = watch.frame.belief.tracks if watch.frame is not None else ()
    near = [t for t in tracks if float(np.hypot(*(t.position - place))) <= NEAR]
    if not near:
        return "unseen", f"{what}; no track of it"
    track = min(near, key=lambda t: float(np.hypot(*(t.position - place))))
    if track.age > FORGOTTEN:
        return "unseen", f"{what}; seen last {track.age:.1f} s ago"
    wrong = _wrong(track, place, velocity, float(watch.radii[contact.obstacle]))
    if wrong:
        return "misjudged", f"{what}; {wrong}"
    if not _is_free(watch, then):
        return "trapped", what
    if contact.moving and walk < SLOW * watch.forward:
        return "too slow", what
    return "grazed", what


def _words(contact: Contact, end: Truth, place: Array, velocity: Array, walk: float) -> str:
    x, y = (place - end.robot[:2]).tolist()
    bearing = degrees(wrap(float(np.arctan2(y, x)) - float(end.robot[2])))
    moving = f" at {hypot(*velocity.tolist()):.2f} m/s" if contact.moving else ""
    return (
        f"{contact.robot_geom} touches {contact.name}{moving}, bearing {bearing:.0f} deg, "
        f"walking {walk:.2f} m/s"
    )


def _wrong(track: Track, place: Array, velocity: Array, radius: float) -> str:
    """What of a track is wrong, in words; empty if nothing is."""
    off = float(np.hypot(*(track.position - place)))
    speed_off = float(np.hypot(*(track.velocity - velocity)))
    if hypot(*velocity.tolist()) > 0.0 and track.motion is Motion.STATIC:
        return "taken for static"
    if off > PLACE_OFF:
        return f"{off:.2f} m off"
    if speed_off > VELOCITY_OFF:
        return f"its velocity {speed_off:.2f} m/s off"
    if abs(track.radius - radius) > RADIUS_OFF:
        return f"its radius {track.radius - radius:+.2f} m off"
    return ""


def _is_free(watch: Watch, truth: Truth) -> bool:
    """Whether some straight walk touches nothing for a while, all going on as they do."""
    turns = 2.0 * pi * np.arange(HEADINGS) / HEADINGS
    times = np.linspace(0.0, STRIDE, 11)
    places, velocities = watch.solids(truth)
    offset = places - truth.robot[:2]
    for direction in turns.tolist():
        walk = watch.forward * np.array([np.cos(direction), np.sin(direction)])
        relative = offset[:, None] + times[:, None] * (velocities[:, None] - walk)
        if (np.hypot(relative[..., 0], relative[..., 1]).min(axis=1) > BODY + watch.radii).all():
            return True
    return False


def run(scenario: str, settings: list[str], seed: int, picture: Path) -> Failure | None:
    """One run; its failure, and the world at that moment as `picture`."""
    simulation = Simulation(load_scenario(scenario, settings, seed), seed)
    watch = Watch(simulation)
    simulation.listeners.append(watch)
    simulation.run()
    if watch.end is None:
        return None
    kind, what = cause_of(watch, watch.end)
    if watch.frame is not None and watch.seen is not None:
        view = TopDown(simulation.layout, PICTURE)
        movers = watch.end.obstacle_positions[len(simulation.layout.static) :]
        summary = from_line(to_line(watch.frame, watch.seen))
        write_png(picture, view.draw(summary, movers, np.array(watch.trail)[-1000::5]))
    return Failure(scenario, seed, kind, watch.end.time, what)


def page(failures: list[Failure], runs: int, pictures: dict[str, str], command: str) -> str:
    """Markdown of the catalogue."""
    interval = Proportion.counted(runs - len(failures), runs)
    lines = [
        "# Failures by cause",
        "",
        f"    {command}",
        "",
        f"{runs - len(failures)} of {runs} runs touched nothing and did not fall "
        f"(95 % interval {interval.low:.0%} to {interval.high:.0%}). "
        "Every other one ended at its first contact.",
        "",
        "| cause | rule | runs |",
        "|---|---|---|",
    ]
    lines += [
        f"| {k} | {rule} | {sum(f.kind == k for f in failures)} |" for k, rule in KINDS.items()
    ]
    for kind in KINDS:
        group = [f for f in failures if f.kind == kind]
        if not group:
            continue
        lines += ["", f"## {kind}", ""]
        if kind in pictures:
            lines += [f"![{kind}]({pictures[kind]})", ""]
        lines += [f"- `{f.scenario}` {f.seed}, {f.time:.1f} s: {f.what}" for f in group]
    return "\n".join(lines) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenarios", nargs="+")
    add_seeds(parser, range(10))
    parser.add_argument("--set", nargs="*", default=[], help="settings, key=value")
    parser.add_argument("--out", type=Path, required=True, help="Markdown file to write")
    arguments = parser.parse_args()
    settings = [*STAND_INS, *arguments.set]
    failures: list[Failure] = []
    pictures: dict[str, str] = {}
    folder = arguments.out.with_suffix("")
    folder.mkdir(parents=True, exist_ok=True)
    runs = 0
    for seed in arguments.seeds:
        for scenario in arguments.scenarios:
            draft = folder / "latest.png"
            failure = run(scenario, settings, seed, draft)
            runs += 1
            print(failure or f"{scenario} {seed}: nothing", flush=True)
            if failure is None:
                continue
            failures.append(failure)
            name = f"{failure.kind.replace(' ', '-')}.png"
            if draft.exists() and failure.kind not in pictures:
                draft.replace(folder / name)
                pictures[failure.kind] = f"{folder.name}/{name}"
            draft.unlink(missing_ok=True)
            arguments.out.write_text(page(failures, runs, pictures, command_line()))
    arguments.out.write_text(page(failures, runs, pictures, command_line()))


if __name__ == "__main__":
    main()
