import numpy as np
import pytest

from hsr8.world.body.sensor_kernel import ATTITUDE, ERRORS, PADS, WIDTH, reading
from hsr8.world.rotation import quaternion_from_yaw, quaternion_product, small_rotation

BIAS = 0.01


def readings(seed):
    """Random arguments of `reading`."""
    rng = np.random.default_rng(seed)
    orientation = rng.normal(size=4)
    return (
        rng.normal(size=26),
        rng.normal(size=26),
        rng.normal(size=3),
        rng.normal(size=3),
        orientation / np.linalg.norm(orientation),
        rng.uniform(-5.0, 5.0, (2, 4)),
        0.1 * rng.normal(size=ERRORS),
        rng.uniform(0.9, 1.1, (2, 4)),
        BIAS,
    )


@pytest.mark.parametrize("seed", range(10))
def test_errors_are_added_and_the_attitude_is_turned(seed):
    angles, rates, gyro, acceleration, attitude, force, error, gain, _ = readings(seed)
    read = reading(*readings(seed))
    true = np.concatenate([angles, rates, gyro + BIAS, acceleration, (gain * force).ravel()])
    expected = true + error[:ATTITUDE]
    expected[PADS:] = np.maximum(expected[PADS:], 0.0)
    assert len(read) == WIDTH
    assert np.array_equal(read[:ATTITUDE], expected)
    roll, pitch, drift = error[ATTITUDE:]
    tilted = quaternion_product(attitude, small_rotation(roll, pitch))
    turned = quaternion_product(quaternion_from_yaw(drift), tilted)
    assert np.allclose(read[ATTITUDE:], turned, rtol=0.0, atol=1e-15)
    assert (read[PADS:ATTITUDE] >= 0.0).all()
