import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from hsr8.recorder import ellipse

lengths = st.floats(1e-3, 3.0)


@given(a=lengths, b=lengths, turn=st.floats(-1.5, 1.5))
def test_the_axes_reproduce_the_covariance(a, b, turn):
    c, s = np.cos(turn), np.sin(turn)
    rotation = np.array([[c, -s], [s, c]])
    covariance = rotation @ np.diag([a * a, b * b]) @ rotation.T
    half, direction = ellipse.axes(covariance[None])
    assert half[0, 0] >= half[0, 1]
    c, s = np.cos(direction[0]), np.sin(direction[0])
    back = np.array([[c, -s], [s, c]])
    np.testing.assert_allclose(back @ np.diag(half[0] ** 2) @ back.T, covariance, atol=1e-9)


def test_no_covariance_gives_no_ellipse():
    half, direction = ellipse.axes(np.zeros((0, 2, 2)))
    assert half.shape == (0, 2)
    assert direction.shape == (0,)
