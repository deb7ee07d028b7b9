import numpy as np
import pytest

from vision.least_squares_kernel import positive, step, whiten


def problem(seed, rows=7):
    rng = np.random.default_rng(seed)
    root = rng.standard_normal((rows, rows))
    R = root @ root.T + 0.1 * np.eye(rows)
    return R, rng.standard_normal((rows, 3)), rng.standard_normal(rows)


@pytest.mark.parametrize("seed", range(5))
def test_a_step_is_that_of_the_normal_equations(seed):
    R, H, residual = problem(seed)
    W = np.linalg.inv(R)
    expected = np.linalg.inv(H.T @ W @ H)
    x, P = np.ones(3), np.empty((3, 3))
    moved = x + expected @ H.T @ W @ residual
    square = residual @ W @ residual
    whiten(R, H, residual)
    assert residual @ residual == pytest.approx(square)
    step(x, P, H, residual)
    assert x == pytest.approx(moved)
    np.testing.assert_allclose(P, expected)
    assert positive(P)


def test_positive_is_what_the_eigenvalues_say():
    rng = np.random.default_rng(0)
    found = set()
    for _ in range(200):
        root = rng.standard_normal((3, 3))
        P = root @ np.diag(rng.uniform(-0.3, 1.0, 3)) @ root.T
        told = bool(np.linalg.eigvalsh(P).min() > 0.0)
        assert positive(P) == told
        found.add(told)
    assert found == {True, False}
