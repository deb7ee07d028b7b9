from math import asin

import numpy as np
import pytest

from vision.cylinder_fit import OUTER, fit
from vision.detector import parameter_record
from vision.parameters import VisionParameters
from vision.tables import ANY, Candidate, Rim, Side, add_rim, copy_side
from vision.view import View

HEIGHT, TILT_VARIANCE = 0.47, 8e-7
OPTIONS = VisionParameters(roundness_sigma=0.008, edge_correlation=0.02, edge_sigma=0.3125)


def rim_run(x, azimuth, sign):
    """Distance of the near or far half of a circle in a direction."""
    theta, d, r = x
    sine = np.clip(d * np.sin(azimuth - theta) / r, -OUTER, OUTER) * r
    return d * np.cos(azimuth - theta) - sign * np.sqrt(r * r - sine * sine)


def candidates(seed, n, share=0.7):
    """Edges of random cylinders, with pixel noise; a fraction of them is visible."""
    rng = np.random.default_rng(seed)
    made = []
    for _ in range(n):
        x = np.array([rng.uniform(-0.5, 0.5), rng.uniform(0.6, 3.0), rng.uniform(0.05, 0.12)])
        half, observed = asin(x[2] / x[1]), rng.random(3) < share
        span = (-HEIGHT / (x[1] - x[2]), (0.3 - HEIGHT) / (x[1] + x[2]))
        sides = [
            (x[0] + sign * half + 5e-4 * rng.standard_normal(), 1e-3, rng.uniform(1, 9), *span, ok)
            for sign, ok in ((1.0, observed[0] or not observed[1]), (-1.0, observed[1]))
        ]
        rims = []
        for height, sign in ((0.0, 1.0), (0.3, -1.0)):
            if sign > 0.0 or observed[2]:
                azimuth = x[0] + half * np.linspace(-0.9, 0.9, rng.integers(5, 40))
                slope = (height - HEIGHT) / rim_run(x, azimuth, sign)
                slope += 1e-3 * rng.standard_normal(len(slope))
                rims.append((height, sign, 1e-3, azimuth, slope))
        made.append({"sides": sides, "known": (0.085, 0.02, 0.3), "rims": rims, "truth": x})
    return made


def fitted(made):
    """Fits of candidates: azimuth, distance, radius, misfit and outlier fraction; covariances."""
    rows, view = np.zeros(len(made), Candidate), np.zeros(1, View)[0]
    view.clearance, view.variance = HEIGHT, (TILT_VARIANCE, 6e-7, 2.5e-7, 9e-8)
    rims = [rim for candidate in made for rim in candidate["rims"]]
    azimuth, slope = (np.concatenate([np.empty(0), *(rim[k] for rim in rims)]) for k in (3, 4))
    points = azimuth, slope, np.zeros(len(slope), np.uint8)
    used = 0
    for row, candidate in zip(rows, made, strict=True):
        *row.prior, row.height = candidate["known"]
        for side, values in zip(row.sides, candidate["sides"], strict=True):
            copy_side(side, np.array([(*values, False)], Side)[0])
        for height, half, sigma, edge, _ in candidate["rims"]:
            rim = np.zeros(1, Rim)[0]
            rim.first, rim.last, rim.sigma = used, used + len(edge), sigma
            used += len(edge)
            add_rim(row, rim, ANY, points, height, half)
    fit(rows, points, view, parameter_record(OPTIONS)[0])
    return np.column_stack([rows["cylinder"], rows["misfit"], rows["outlier_fraction"]]), rows[
        "covariance"
    ]


def test_estimates_are_consistent():
    made = candidates(5, 200, share=1.0)
    results, covariances = fitted(made)
    errors = results[:, :3] - [candidate["truth"] for candidate in made]
    assert np.all(np.abs(errors) < 4.5 * np.sqrt(np.diagonal(covariances, axis1=1, axis2=2)))
    nees = np.einsum("ni,nij,nj->n", errors, np.linalg.inv(covariances), errors) / 3
    assert 0.1 < nees.mean() < 1.2
    assert results[:, 3].max() < 30.0


def cut(seed, n):
    """Foot and one side of close cylinders, whose other side is outside the image."""
    rng = np.random.default_rng(seed)
    made = []
    for _ in range(n):
        x = np.array([rng.uniform(-0.5, 0.5), rng.uniform(0.35, 0.8), rng.uniform(0.05, 0.12)])
        half, sign = asin(x[2] / x[1]), rng.choice([1.0, -1.0])
        border = rng.uniform(-0.6, 0.3)  # where the image ends, from the axis
        azimuth = x[0] + sign * half * np.linspace(border, 0.9, 60)
        # The outline is a polygon, as that of a rendered cylinder.
        rough = 0.008 * 2**0.5 * np.sin(16.0 * azimuth * x[1] / x[2] + rng.uniform(0.0, 6.0))
        slope = -HEIGHT / rim_run(x, azimuth, 1.0) * (1.0 + rough * x[2] / x[1])
        slope += 1e-3 * rng.standard_normal(60)
        slope += TILT_VARIANCE**0.5 * rng.standard_normal() * (1.0 + slope**2)
        span = (-HEIGHT / (x[1] - x[2]), (0.3 - HEIGHT) / (x[1] + x[2]))
        seen = (x[0] + sign * half + 5e-4 * rng.standard_normal(), 1e-3, 9.0, *span, 1.0)
        hidden = (x[0] + sign * half * border, 1e-3, 1.0, *span, 0.0)
        sides = [seen, hidden] if sign > 0.0 else [hidden, seen]
        rims = [(0.0, 1.0, 1e-3, azimuth, slope)]
        made.append({"sides": sides, "known": (0.085, 0.02, 0.3), "rims": rims, "truth": x})
    return made


def test_the_foot_of_a_cut_cylinder_measures_its_axis_and_radius():
    made = cut(6, 300)
    results, covariances = fitted(made)
    errors = results[:, :3] - [candidate["truth"] for candidate in made]
    nees = np.einsum("ni,nij,nj->n", errors, np.linalg.inv(covariances), errors) / 3
    assert 0.1 < nees.mean() < 1.5
    radius_sigma = np.sqrt(covariances[:, 2, 2])
    assert np.median(radius_sigma) < 0.2 * 0.02  # of the prior
    assert np.mean(results[:, 4] < 0.2) > 0.9


def one_side(seed, n, least):
    """The only edge of each of n cylinders: at least a fraction of one side, left or right."""
    rng = np.random.default_rng(seed)
    made = []
    for _ in range(n):
        x = np.array([rng.uniform(-0.9, 0.9), rng.uniform(0.35, 1.2), rng.uniform(0.05, 0.12)])
        half, reach = asin(x[2] / x[1]), np.sqrt(x[1] ** 2 - x[2] ** 2)
        observed, start = rng.uniform(least, 1.0), rng.random()
        foot, head = -HEIGHT / reach, (0.3 - HEIGHT) / reach
        low = foot + (1.0 - observed) * start * (head - foot)
        span = (low, low + observed * (head - foot))
        left = bool(rng.random() < 0.5)
        inner = x[0] - half * rng.uniform(-0.9, 0.9)  # where the border of the image cuts it
        azimuths = (x[0] + half, inner) if left else (inner, x[0] - half)
        sides = [
            (azimuth, 1e-3, 9.0, *(span if ok else (0.0, 0.0)), ok)
            for azimuth, ok in zip(azimuths, (left, not left), strict=True)
        ]
        made.append({"sides": sides, "known": (0.085, 0.02, 0.3), "rims": [], "truth": x})
    return made


@pytest.mark.parametrize("least", [0.3, 0.6, 0.9])
def test_the_distance_from_a_single_side_is_consistent(least):
    made = one_side(3, 200, least)
    results, covariances = fitted(made)
    error = results[:, 1] - [c["truth"][1] for c in made]
    sigma = np.sqrt(covariances[:, 1, 1])
    assert np.abs(error / sigma).max() < 3.5
    assert 0.3 < np.mean((error / sigma) ** 2) < 1.5
    azimuth = results[:, 0] - [c["truth"][0] for c in made]
    assert np.abs(azimuth / np.sqrt(covariances[:, 0, 0])).max() < 4.5


def test_edges_of_no_cylinder_have_a_covariance_all_the_same():
    """One side, and an upper rim that does not belong to it."""
    rng = np.random.default_rng(33)
    made = one_side(33, 300, 0.1)
    for candidate in made:
        right, left = sorted(side[0] for side in candidate["sides"])
        low, high = next(side[3:5] for side in candidate["sides"] if side[5])
        azimuth = np.linspace(right, left, 28)[1:-1]
        slope = np.linspace(*rng.uniform(low, max(high, low + 0.05), 2), len(azimuth))
        candidate["rims"] = [(0.3, -1.0, 1e-3, azimuth, slope)]
    _, covariances = fitted(made)
    assert np.isfinite(covariances).all()
    np.linalg.cholesky(covariances)
