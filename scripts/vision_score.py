"""Detections against the truth: recall, false detections, and consistency of the errors."""

import itertools
from dataclasses import dataclass, field
from math import atan2, cos, degrees, sin, sqrt

from vision.detection import Detection

import numpy as np
from numpy.typing import NDArray
from vision_truth import Sight

Array = NDArray[np.float64]

MAX_MATCH = 0.25  # a detection farther than this from every visible object is false [m]
SURPRISE = 20.0  # NEES of two degrees of freedom that one in 20 000 should exceed
FEW = 20  # bins of fewer sightings are not shown


@dataclass
class Study:
    """Everything counted.

    Attributes:
        visible, detected: objects that are visible and those detected, by kind;
            obstacles also by whether they are clear.
        errors: errors by group: true distance, errors of distance, bearing and radius, and their
            claimed standard deviations; NEES of distance and bearing together.
    """

    visible: dict[str, int] = field(default_factory=dict)
    detected: dict[str, int] = field(default_factory=dict)
    errors: dict[str, list[tuple[float, ...]]] = field(default_factory=dict)
    reported: int = 0
    false: int = 0
    reported_clean: int = 0
    false_clean: int = 0
    false_beacons: int = 0

    def judge(self, detections: tuple[Detection, ...], truth: list[Sight]) -> list[str]:
        """Count one frame; return its mistakes in words."""
        mistakes = []
        used: set[int] = set()
        for sight in truth:
            best = match(sight, detections, used)
            self._count(sight, best is not None)
            if best is None:
                if sight.counted and sight.clear:
                    mistakes.append(f"missed {sight.target.label} at {sight.distance:.2f} m")
                continue
            used.add(best)
            nees = self._measure(detections[best], sight)
            if nees > SURPRISE:
                d = detections[best]
                mistakes.append(
                    f"{d.label} at {sight.distance:.2f} m: NEES {nees:.0f}, "
                    f"off by {d.distance - sight.distance:.3f} m, "
                    f"{degrees(d.bearing - sight.bearing):.2f} deg, {d.cut=} {d.occluded=}"
                )
        for i, d in enumerate(detections):
            false = i not in used
            clean = d.kind == "obstacle" and not (d.cut or d.occluded)
            self.reported += 1
            self.false += false
            self.reported_clean += clean
            self.false_clean += clean and false
            self.false_beacons += false and d.kind == "beacon"
            if false:
                mistakes.append(f"false {d.label} at {d.distance:.2f} m, {d.box}, {clean=}")
        return mistakes

    def _count(self, sight: Sight, detected: bool) -> None:
        if not sight.counted:
            return
        name = sight.target.kind
        if name == "obstacle":
            name = "clear obstacle" if sight.clear else "hidden or cut obstacle"
        self.visible[name] = self.visible.get(name, 0) + 1
        self.detected[name] = self.detected.get(name, 0) + detected

    def _measure(self, d: Detection, sight: Sight) -> float:
        """Keep the errors of a detection; returns its NEES."""
        turn = d.bearing - sight.bearing
        error = np.array([d.distance - sight.distance, atan2(sin(turn), cos(turn))])
        nees = float(error @ np.linalg.solve(d.covariance, error))
        flagged = d.cut or d.occluded
        group = f"{'flagged' if flagged else 'clean'} {d.kind}s"
        sigma = np.sqrt(np.diag(d.covariance)).tolist()
        radius = d.radius - sight.target.radius
        row = (sight.distance, *error.tolist(), radius, *sigma, d.radius_sigma, nees)
        self.errors.setdefault(group, []).append(row)
        return nees

    def report(self) -> None:
        """Print the tables."""
        for name, visible in sorted(self.visible.items()):
            detected = self.detected[name]
            print(f"{name}s: detected {detected} of {visible} = {100.0 * detected / visible:.2f} %")
        print(
            f"reported {self.reported}, false {self.false}: precision "
            f"{_precision(self.reported, self.false):.2f} %\n"
            f"clean obstacles reported {self.reported_clean}, false {self.false_clean}: precision "
            f"{_precision(self.reported_clean, self.false_clean):.2f} %; "
            f"false beacons {self.false_beacons}"
        )
        for name, rows in sorted(self.errors.items()):
            print(f"{name}:")
            _table(np.array(rows))


def _precision(reported: int, false: int) -> float:
    return 100.0 * (1.0 - false / max(reported, 1))


def _table(rows: Array) -> None:
    print(
        "    range      n |range error| %    range cm      bearing deg    NEES per dof"
        "         radius mm"
        "\n    [m]            p50    p95    rms  sigma    rms  sigma   both range bearing"
        "   rms sigma"
    )
    edges = np.array([0.3, 0.75, 1.25, 1.75, 2.25, 2.75, 3.5, 4.5, 5.5])
    for low, high in itertools.pairwise(edges):
        a = rows[(rows[:, 0] >= low) & (rows[:, 0] < high)]
        if len(a) < FEW:
            continue
        distance, ed, eb, er, sd, sb, sr, nees = a.T
        relative = 100.0 * np.abs(ed) / distance
        print(
            f"    {low:4.2f}-{high:4.2f}{len(a):6d}{np.median(relative):7.2f}"
            f"{np.percentile(relative, 95):7.2f}"
            f"{100 * _rms(ed):7.2f}{100 * _rms(sd):7.2f}"
            f"{degrees(_rms(eb)):7.2f}{degrees(_rms(sb)):7.2f}"
            f"{nees.mean() / 2:7.2f}{np.mean((ed / sd) ** 2):6.2f}{np.mean((eb / sb) ** 2):8.2f}"
            f"{1e3 * _rms(er):6.1f}{1e3 * _rms(sr):6.1f}"
        )


def _rms(values: Array) -> float:
    return sqrt(float(np.mean(values**2)))


def match(sight: Sight, detections: tuple[Detection, ...], used: set[int]) -> int | None:
    """The detection nearest to an object within `MAX_MATCH`."""
    options = []
    for i, d in enumerate(detections):
        turn = d.bearing - sight.bearing
        gap = abs(d.distance - sight.distance)
        limit = max(MAX_MATCH, 0.2 * sight.distance, 3.0 * float(d.covariance[0, 0]) ** 0.5)
        aside = abs(atan2(sin(turn), cos(turn))) * sight.distance
        same = d.label == sight.target.label and i not in used
        if same and gap < limit and aside < 0.08 * sight.distance + 0.08:
            options.append((gap + aside, i))
    return min(options)[1] if options else None
