"""Load curve: success and SPT of gazes over four cameras, from the rows of `gaze_study.py`.

    python scripts/camera_figure.py --rows ideal=ideal.jsonl narrow=narrow.jsonl --out load.png

Every file holds the same arms on the same worlds under one camera; the order of the files is that
of the axis. Bars are 95 % intervals: Wilson's for successes, of the mean for SPT.
"""

import argparse
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from hsr8.evaluation.proportion import Proportion

import numpy as np
from figure_style import CONFIDENT, MOVER, ROBOT, STILL, VIRTUAL, figure, styled
from gaze_study import Row, read, weights
from matplotlib.axes import Axes
from matplotlib.figure import Figure

COLORS = (ROBOT, MOVER, VIRTUAL, CONFIDENT, STILL)
APART = 0.06  # distance of the bars of two arms [cameras]

Runs = Mapping[str, Sequence[Row]]
Measure = Callable[[Sequence[Row]], tuple[float, float, float]]


def draw(cameras: Mapping[str, Runs]) -> Figure:
    """Draw successes and SPT of every arm [%] over the cameras.

    Args:
        cameras: rows of every arm under every camera.
    """
    with styled():
        made = figure(8.0, 3.6, "Gazes over four cameras")
        left, right = made.subplots(1, 2, sharey=True)
        _curves(left, cameras, "success [%]", _success)
        _curves(right, cameras, "SPT [%]", _weighted)
        left.set_ylim(0.0, 103.0)
        left.legend(loc="lower left", frameon=False, fontsize=7.5)
    return made


def _curves(axes: Axes, cameras: Mapping[str, Runs], title: str, measure: Measure) -> None:
    arms = list(next(iter(cameras.values())))
    for k, (arm, color) in enumerate(zip(arms, COLORS, strict=False)):
        at = np.arange(len(cameras)) + APART * (k - 0.5 * (len(arms) - 1))
        low, middle, high = 100.0 * np.array([measure(runs[arm]) for runs in cameras.values()]).T
        axes.errorbar(at, middle, (middle - low, high - middle), color=color, marker="o",
                      markersize=3.5, linewidth=1.2, capsize=2.0, label=arm)  # fmt: skip
    axes.set_title(title)
    axes.set_xticks(range(len(cameras)), list(cameras))


def _success(runs: Sequence[Row]) -> tuple[float, float, float]:
    good = sum(bool(run["success"]) for run in runs)
    interval = Proportion.counted(good, len(runs))
    return interval.low, good / len(runs), interval.high


def _weighted(runs: Sequence[Row]) -> tuple[float, float, float]:
    values = weights(runs)
    mean, half = float(values.mean()), 1.96 * float(values.std()) / len(values) ** 0.5
    return mean - half, mean, mean + half


def common(rows: Sequence[Row]) -> dict[str, list[Row]]:
    """Return the rows of every arm on the worlds that all arms walked."""
    done: dict[str, dict[tuple[str, int], Row]] = {}
    for row in rows:
        done.setdefault(str(row["arm"]), {})[str(row["family"]), int(str(row["seed"]))] = row
    worlds = sorted(set.intersection(*(set(runs) for runs in done.values())))
    return {arm: [runs[world] for world in worlds] for arm, runs in done.items()}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rows", nargs="+", required=True, help="CAMERA=FILE.jsonl, in order")
    parser.add_argument("--out", type=Path, required=True, help="PNG file to write")
    options = parser.parse_args()
    pairs = (word.split("=", 1) for word in options.rows)
    made = draw({camera: common(read(Path(file))) for camera, file in pairs})
    made.savefig(options.out, dpi=160)


if __name__ == "__main__":
    main()
