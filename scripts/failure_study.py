"""Catalogue of failures: runs up to their first contact or fall, by cause.

    python scripts/failure_study.py course fast --seeds 0-19 --out docs/results/failures.md

A run is the whole loop, with a kinematic body and the analytic camera unless `--set` changes
otherwise. The cause is the first rule of `KINDS` that holds. One image of every kind goes
next to the page: the world from above, what is true outlined, what is believed filled.
"""

import argparse
from collections import deque
from dataclasses import dataclass
from math import degrees, hypot, pi
from pathlib import Path

from hsr8.evaluation.proportion import Proportion
from hsr8.frame_record import FrameRecord
from hsr8.loop import Simulation
from hsr8.record import TickRecord
from hsr8.render.png import write_png
from hsr8.render.shown_frame import shown_frame
from hsr8.render.top_down import TopDown
from hsr8.scenario.loader import load_scenario
from hsr8.world.truth.truth import Contact, Truth
from navigation.angles import wrap
from navigation.belief.belief import Motion, Track

import numpy as np
from numpy.typing import NDArray
from study_page import STAND_INS, add_seeds, command_line

Array = NDArray[np.float64]

NEAR = 0.30  # max distance of a track from its obstacle [m]
FORGOTTEN = 1.0  # age from which an obstacle counts as unseen [s]
POSITION_ERROR, VELOCITY_ERROR, RADIUS_ERROR = 0.06, 0.08, 0.03  # tolerable errors [m, m/s, m]
BEFORE = 2.0  # time before the contact at which free directions are counted [s]
HEADINGS, STRIDE, BODY = 24, 2.0, 0.14  # directions tried, time [s], radius of the body [m]
SLOW = 0.5  # fraction of the max forward speed below which the robot is slow [1]
IMAGE_SIZE = (640, 640)
KINDS = {
    "fell": "the robot fell without a contact before",
    "beacon": "it hit a beacon, whose position is known",
    "unseen": "the obstacle it hit had no track, or was last seen more than a second ago",
    "misjudged": "seen, but with a wrong position, velocity, size or class",
    "trapped": "seen correctly, but two seconds before the contact no straight walk was free",
    "too slow": "seen correctly, the obstacle came while the robot stood, turned or side-stepped",
    "grazed": "seen correctly, the robot passed too close",
}


@dataclass
class Failure:
    """Failure of a run.

    Attributes:
        scenario, seed: of the run.
        kind: one of `KINDS`.
        time: when [s].
        text: description.
    """

    scenario: str
    seed: int
    kind: str
    time: float
    text: str


class Watch:
    """Records the last seconds and stops the run at its first contact or fall."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        layout = simulation.layout
        self.radii = np.array([o.radius for o in (*layout.obstacles, *layout.beacons)])
        self.beacons = np.array([b.position for b in layout.beacons]).reshape(-1, 2)
        self.forward = simulation.scenario.speed_limits().vx
        self.recent: deque[Truth] = deque()
        self.trail: list[list[float]] = []
        self.frame: FrameRecord | None = None
        self.frame_truth: Truth | None = None
        self.end: Truth | None = None

    def on_record(self, record: TickRecord) -> None:
        """Record it; stop at a contact or a fall."""
        if self.end is not None:
            return
        self.recent.append(record.truth)
        while self.recent[0].time < record.time - BEFORE:
            self.recent.popleft()
        self.trail.append(record.truth.robot[:2].tolist())
        if record.frame is not None:
            self.frame, self.frame_truth = record.frame, record.truth
        if record.truth.contacts or record.truth.fallen:
            self.end = record.truth
            self._simulation.interrupt()

    def solids(self, truth: Truth) -> tuple[Array, Array]:
        """Return positions and velocities of obstacles, then beacons (n, 2), (n, 2) [m, m/s]."""
        still = np.zeros_like(self.beacons)
        return (
            np.concatenate([truth.obstacle_positions, self.beacons]),
            np.concatenate([truth.obstacle_velocities, still]),
        )


def cause_of(watch: Watch, end: Truth) -> tuple[str, str]:
    """Return kind and description of the failure that ended the run at `end`."""
    then = watch.recent[0]
    if not end.contacts:
        return "fell", "no contact before"
    contact = end.contacts[0]
    position, velocity = (of_all[contact.obstacle] for of_all in watch.solids(end))
    walk = hypot(*(end.robot[:2] - then.robot[:2]).tolist()) / max(end.time - then.time, 1e-9)
    text = _words(contact, end, position, velocity, walk)
    if contact.obstacle >= len(end.obstacle_positions):
        return "beacon", text
    tracks = watch.frame.belief.tracks if watch.frame is not None else ()
    near = [t for t in tracks if float(np.hypot(*(t.position - position))) <= NEAR]
    if not near:
        return "unseen", f"{text}; no track of it"
    track = min(near, key=lambda t: float(np.hypot(*(t.position - position))))
    if track.age > FORGOTTEN:
        return "unseen", f"{text}; seen last {track.age:.1f} s ago"
    wrong = _wrong(track, position, velocity, float(watch.radii[contact.obstacle]))
    if wrong:
        return "misjudged", f"{text}; {wrong}"
    if not _is_free(watch, then):
        return "trapped", text
    if contact.moving and walk < SLOW * watch.forward:
        return "too slow", text
    return "grazed", text


def _words(contact: Contact, end: Truth, position: Array, velocity: Array, walk: float) -> str:
    x, y = (position - end.robot[:2]).tolist()
    bearing = degrees(wrap(float(np.arctan2(y, x)) - float(end.robot[2])))
    moving = f" at {hypot(*velocity.tolist()):.2f} m/s" if contact.moving else ""
    return (
        f"{contact.robot_geom} hits {contact.name}{moving}, bearing {bearing:.0f} deg, "
        f"walking {walk:.2f} m/s"
    )


def _wrong(track: Track, position: Array, velocity: Array, radius: float) -> str:
    """Return the error of a track in words; empty if it is within tolerance."""
    off = float(np.hypot(*(track.position - position)))
    speed_off = float(np.hypot(*(track.velocity - velocity)))
    if hypot(*velocity.tolist()) > 0.0 and track.motion is Motion.STATIC:
        return "taken for static"
    if off > POSITION_ERROR:
        return f"{off:.2f} m off"
    if speed_off > VELOCITY_ERROR:
        return f"its velocity {speed_off:.2f} m/s off"
    if abs(track.radius - radius) > RADIUS_ERROR:
        return f"its radius {track.radius - radius:+.2f} m off"
    return ""


def _is_free(watch: Watch, truth: Truth) -> bool:
    """Return whether a straight walk is free for `STRIDE`, with movers at constant velocity."""
    turns = 2.0 * pi * np.arange(HEADINGS) / HEADINGS
    times = np.linspace(0.0, STRIDE, 11)
    positions, velocities = watch.solids(truth)
    offset = positions - truth.robot[:2]
    for direction in turns.tolist():
        walk = watch.forward * np.array([np.cos(direction), np.sin(direction)])
        relative = offset[:, None] + times[:, None] * (velocities[:, None] - walk)
        if (np.hypot(relative[..., 0], relative[..., 1]).min(axis=1) > BODY + watch.radii).all():
            return True
    return False


def run(scenario: str, settings: list[str], seed: int, image: Path) -> Failure | None:
    """One run; its failure, and the world at that moment as `image`."""
    simulation = Simulation(load_scenario(scenario, settings, seed), seed)
    watch = Watch(simulation)
    with simulation:
        for tick in simulation:
            if tick.record is not None:
                watch.on_record(tick.record)
    if watch.end is None:
        return None
    kind, text = cause_of(watch, watch.end)
    if watch.frame is not None and watch.frame_truth is not None:
        view = TopDown(simulation.layout, IMAGE_SIZE)
        movers = watch.end.obstacle_positions[len(simulation.layout.static) :]
        summary = shown_frame(watch.frame, watch.frame_truth.robot)
        write_png(image, view.draw(summary, movers, np.array(watch.trail)[-1000::5]))
    return Failure(scenario, seed, kind, watch.end.time, text)


def page(failures: list[Failure], runs: int, images: dict[str, str], command: str) -> str:
    """Return the catalogue as Markdown."""
    interval = Proportion.counted(runs - len(failures), runs)
    lines = [
        "# Failures by cause",
        "",
        f"    {command}",
        "",
        f"{runs - len(failures)} of {runs} runs had no contact and no fall "
        f"(95 % interval {interval.low:.0%} to {interval.high:.0%}). "
        "Every other run ended at its first contact.",
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
        if kind in images:
            lines += [f"![{kind}]({images[kind]})", ""]
        lines += [f"- `{f.scenario}` {f.seed}, {f.time:.1f} s: {f.text}" for f in group]
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
    images: dict[str, str] = {}
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
            if draft.exists() and failure.kind not in images:
                draft.replace(folder / name)
                images[failure.kind] = f"{folder.name}/{name}"
            draft.unlink(missing_ok=True)
            arguments.out.write_text(page(failures, runs, images, command_line()))
    arguments.out.write_text(page(failures, runs, images, command_line()))


if __name__ == "__main__":
    main()
