"""Picture of the deadline gaze: one moment, its votes, its gaze map and the choice.

python scripts/gaze_figure.py
"""

import argparse
from math import cos, sin
from pathlib import Path

from navigation.belief.belief import Belief, Motion, Particles, Track
from navigation.decision import SpeedLimits, Task
from navigation.gaze.deadline import deadline_votes
from navigation.gaze.planner import GazePlanner
from navigation.gaze.scene import gaze_scene
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import SamplePoints

import numpy as np
from belief_world import HFOV, VFOV, view
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle, Wedge
from numpy.typing import NDArray

Array = NDArray[np.float64]

PICTURE = Path(__file__).parents[1] / "docs" / "images" / "deadline-gaze.png"
LIMITS = SpeedLimits(0.20, 0.10, 0.08, 0.8, 0.3, 0.34)
BEACONS = {"yellow/cyan": (2.2, 1.6), "cyan/magenta": (1.9, -1.9)}
COLOR = {Motion.STATIC: "#8a8a8a", Motion.MOVING: "#c0392b", Motion.UNKNOWN: "#d68910"}


class GroundMap:
    """Ground to the left was not seen for a while."""

    def age_at(self, points: Array) -> Array:
        """Time since each point was seen [s]."""
        return np.where(points[:, 1] > 0.3, 2.0, 0.2)

    def confidence_at(self, points: Array) -> Array:
        """Confidence of each point [1]."""
        return np.where(points[:, 1] > 0.3, 0.6, 0.97)


def track(
    number: int, place: tuple[float, float], motion: Motion, age: float, **details: object
) -> Track:
    """A track with what matters here."""
    position = np.array(place)
    velocity = np.array(details.get("velocity", (0.0, 0.0)), dtype=float)
    cloud = details.get("cloud")
    assert cloud is None or isinstance(cloud, Particles)
    return Track(
        id=number,
        label="red",
        position=position,
        velocity=velocity,
        covariance=np.diag([2e-3, 2e-3, 4e-4, 4e-4]),
        radius=0.09,
        radius_sigma=0.005,
        motion=motion,
        hits=20,
        age=age,
        last_seen=position,
        visible=age == 0.0,
        particles=cloud,
    )


def moment() -> Belief:
    """A robot that walks ahead, a mover lost on its right, one new thing on its left."""
    rng = np.random.default_rng(4)
    places = np.array([0.15, -0.85]) + rng.normal(0.0, (0.20, 0.08), (16, 2))
    cloud = Particles(places, np.zeros((16, 2)), np.zeros(16), np.full(16, 1.0 / 16))
    tracks = (
        track(0, (1.15, 0.25), Motion.STATIC, 0.0),
        track(1, (1.5, -0.5), Motion.STATIC, 1.5),
        track(2, (0.9, 0.75), Motion.UNKNOWN, 0.8, velocity=(0.02, -0.03)),
        track(3, (1.4, -0.05), Motion.MOVING, 0.0, velocity=(-0.08, 0.03)),
        track(4, (0.3, -0.9), Motion.MOVING, 2.2, velocity=(-0.07, 0.02), cloud=cloud),
    )
    covariance = np.diag([4e-4, 4e-4, 4e-4])
    return Belief(5.0, np.zeros(3), covariance, tracks, GroundMap(), view(0.1, -0.4), (), False, 0)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=PICTURE, help="picture to write")
    draw(parser.parse_args().out)


def draw(out: Path) -> None:
    """Draw the moment into `out`."""
    parameters = NavigationParameters.extended()
    belief, task = moment(), Task(np.array([2.0, 0.0]), 0.0, False, 0, False, False)
    gaze = GazePlanner(parameters, LIMITS, BEACONS, HFOV, VFOV)
    decision = gaze.choose(belief, task, None)
    samples = SamplePoints.polar(parameters.evaluation, parameters.gaze.max_pan)
    beacons = np.array([BEACONS[name] for name in sorted(BEACONS)])
    scene = gaze_scene(belief, None, samples, beacons, parameters)
    votes = deadline_votes(scene, 0.0, LIMITS.vx, parameters)
    figure = Figure(figsize=(10.5, 4.4), layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.25))
    _draw_world(left, belief, decision.pan, votes.pan, votes.value)
    extent = np.degrees(
        [gaze.grid.pan[-1], gaze.grid.pan[0], gaze.grid.tilt[0], gaze.grid.tilt[-1]]
    )
    image = right.imshow(
        decision.gaze_map[:, ::-1],
        origin="lower",
        extent=extent.tolist(),
        aspect="auto",
        cmap="YlGnBu",
    )
    figure.colorbar(image, ax=right, label="gaze map")
    right.scatter(
        np.degrees(votes.pan), np.degrees(votes.tilt), 25.0 * votes.value, "#c0392b", alpha=0.6
    )
    half = np.degrees([0.5 * HFOV, 0.5 * VFOV])
    pan, tilt = np.degrees([decision.pan, decision.tilt]).tolist()
    box = Rectangle((pan - half[0], tilt - half[1]), 2 * half[0], 2 * half[1], fill=False, lw=2)
    right.add_patch(box)
    right.plot(pan, tilt, "k+", ms=14, mew=2)
    right.set(
        xlim=(130, -130), ylim=(-75, 40), xlabel="pan, left positive [deg]", ylabel="tilt [deg]"
    )
    right.set_title("votes (dots), their map, the view it chooses", fontsize=10)
    figure.savefig(out, dpi=110)


def _draw_world(axes: Axes, belief: Belief, pan: float, bearings: Array, values: Array) -> None:
    """Seen from above, x ahead drawn upwards; rays as long as the votes on them."""
    half = np.degrees(0.5 * HFOV)
    middle = 90.0 + np.degrees(pan)
    axes.add_patch(Wedge((0, 0), 1.6, middle - half, middle + half, color="#2e86c1", alpha=0.15))
    for t in belief.tracks:
        x, y = t.position.tolist()
        color = COLOR[t.motion]
        if t.particles is not None:
            axes.plot(-t.particles.positions[:, 1], t.particles.positions[:, 0], ".", color=color)
        axes.add_patch(Circle((-y, x), t.radius, color=color, alpha=0.3 if t.age > 0.0 else 0.9))
        axes.annotate(f"{t.motion}, {t.age:.1f} s", (-y + 0.12, x), fontsize=8)
    sectors = np.round(bearings / np.radians(15.0))
    for sector in np.unique(sectors):
        angle, length = sector * np.radians(15.0), 0.30 * float(values[sectors == sector].sum())
        axes.plot([0, -length * sin(angle)], [0, length * cos(angle)], color="#1b4f72", lw=2)
    axes.add_patch(Circle((0, 0), 0.12, color="black"))
    axes.set(xlim=(-1.5, 1.5), ylim=(-0.7, 1.9), aspect="equal", xticks=[], yticks=[])
    axes.set_title("a moment: class and age of tracks; votes by direction", fontsize=10)


if __name__ == "__main__":
    main()
