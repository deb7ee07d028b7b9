"""Write hsr8/scenarios/pedestrians.csv: people who cross a square in four streams.

    python scripts/make_pedestrians.py

A social-force model in the metres and seconds of people: each person accelerates towards a constant
preferred velocity and away from others nearby, more from those ahead (Helbing & Molnar, "Social
force model for pedestrian dynamics", Phys. Rev. E 51, 1995; the parameters are rounded). Positions
are sampled every 0.4 s, as in common recordings, from one edge of the recorded area to another.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FILE = Path(__file__).resolve().parents[1] / "hsr8" / "scenarios" / "pedestrians.csv"
SEED = 20
DURATION = 60.0  # in which people enter [s]
INTERVAL = 6.5  # mean time between two people of a stream [s]
HEADWAY = 1.5  # minimum time between two people of a stream [s]
EDGE = 9.0  # half side of the recorded area [m]
BAND = 2.2  # half width of a stream [m]
SPEED, SPEED_SIGMA = 1.3, 0.15  # preferred speed [m/s]
MAX_RATIO = 1.3  # maximum speed, relative to the preferred one [1]
RELAXATION = 0.5  # time to reach the preferred velocity [s]
STRENGTH, REACH = 6.0, 0.45  # of the repulsion at the distance `CONTACT` [m/s², m]
CONTACT = 0.6  # [m]
ANISOTROPY = 0.3  # weight of people behind [1]
SIDESTEP = 0.3  # sideways fraction of the repulsion, to the right [1]
TICK, SAMPLE = 0.05, 0.4  # of the model and the file [s]
STREAMS = ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))  # directions


def arrivals(rng: np.random.Generator) -> list[tuple[float, Array, Array]]:
    """Return time [s], position [m] and preferred velocity [m/s] of everyone who enters."""
    people = []
    for direction in np.array(STREAMS):
        side = np.array([-direction[1], direction[0]])
        time = rng.uniform(0.0, INTERVAL)
        while time < DURATION:
            # People keep to their right, so that opposite streams use their own half.
            offset = -rng.uniform(0.2, 1.0) * BAND
            speed = np.clip(rng.normal(SPEED, SPEED_SIGMA), 0.9, 1.7)
            people.append((time, -EDGE * direction + offset * side, speed * direction))
            time += HEADWAY + rng.exponential(INTERVAL - HEADWAY)
    return sorted(people, key=lambda person: person[0])


def acceleration(position: Array, velocity: Array, preferred: Array) -> Array:
    """Return the accelerations of all people (n, 2) [m/s²]."""
    towards = (preferred - velocity) / RELAXATION
    offset = position[:, None] - position[None]
    distance = np.maximum(np.hypot(offset[..., 0], offset[..., 1]), 1e-6)
    away = offset / distance[..., None]
    heading = preferred / np.hypot(*preferred.T)[:, None]
    ahead = -(away * heading[:, None]).sum(axis=-1)
    weight = ANISOTROPY + (1.0 - ANISOTROPY) * 0.5 * (1.0 + ahead)
    force = weight * STRENGTH * np.exp((CONTACT - distance) / REACH)
    np.fill_diagonal(force, 0.0)
    right = np.stack([away[..., 1], -away[..., 0]], axis=-1)
    away = away - SIDESTEP * right
    return towards + (force[..., None] * away).sum(axis=1)


def rows(rng: np.random.Generator) -> list[str]:
    """Return the lines of the file."""
    waiting, present, lines, tick = arrivals(rng), [], [], 0
    states = np.zeros((0, 3, 2))  # position, velocity, preferred velocity
    number, every = 0, round(SAMPLE / TICK)
    while waiting or present:
        time = tick * TICK
        if tick % every == 0:
            while waiting and waiting[0][0] <= time:
                _, position, velocity = waiting.pop(0)
                number += 1
                present.append(number)
                states = np.concatenate([states, [[position, velocity, velocity]]])
            for person, (position, _, _) in zip(present, states, strict=True):
                lines.append(f"{time:.1f},{position[0]:.3f},{position[1]:.3f},{person}")
            stay = np.abs(states[:, 0]).max(axis=1, initial=0.0) <= EDGE
            present = [p for p, inside in zip(present, stay, strict=True) if inside]
            states = states[stay]
        position, velocity, preferred = states[:, 0], states[:, 1], states[:, 2]
        velocity = velocity + TICK * acceleration(position, velocity, preferred)
        limit = MAX_RATIO * np.hypot(*preferred.T) / np.maximum(np.hypot(*velocity.T), 1e-6)
        states[:, 1] = velocity * np.minimum(limit, 1.0)[:, None]
        states[:, 0] += TICK * states[:, 1]
        tick += 1
    return ["t,x,y,id", *lines]


if __name__ == "__main__":
    FILE.write_text("\n".join(rows(np.random.default_rng(SEED))) + "\n", encoding="utf-8")
    print(f"{FILE.stat().st_size} bytes")
