import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from hsr8.world.rotation import (
    heading,
    quaternion_from_yaw,
    quaternion_product,
    small_rotation,
    up_component,
)

angles = st.floats(-3.1, 3.1)


def scipy_rotation(q):
    return Rotation.from_quat(np.asarray(q)[[1, 2, 3, 0]])


@given(angles)
def test_heading_returns_the_yaw_of_a_yaw_rotation(yaw):
    assert np.isclose(heading(quaternion_from_yaw(yaw)), yaw, atol=1e-12)


@given(angles, angles, angles)
def test_product_agrees_with_scipy(a, b, c):
    p, q = quaternion_from_yaw(a), small_rotation(0.3 * b, 0.3 * c)
    expected = scipy_rotation(p) * scipy_rotation(q)
    got = scipy_rotation(quaternion_product(p, q))
    assert np.allclose(got.as_matrix(), expected.as_matrix(), atol=1e-12)


@given(angles, st.floats(-0.2, 0.2))
def test_a_tilt_does_not_depend_on_heading(yaw, tilt):
    q = small_rotation(tilt, 0.0)
    turned = quaternion_product(quaternion_from_yaw(yaw), q)
    assert np.isclose(up_component(turned), up_component(q), atol=1e-12)
    assert np.isclose(up_component(q), np.cos(2 * np.arctan(0.5 * tilt)), atol=1e-9)
