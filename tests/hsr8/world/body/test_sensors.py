from dataclasses import replace

import numpy as np
import pytest

from hsr8.scenario.sensor_noise import SensorNoise
from hsr8.world.body.sensors import SensorSuite
from hsr8.world.rotation import heading

PERIOD = 0.005


def reading(suite):
    return suite.read(
        joint_position=np.linspace(-1.0, 1.0, 26),
        joint_velocity=np.zeros(26),
        gyro=np.array([0.1, 0.2, 0.3]),
        accelerometer=np.array([0.0, 0.0, 9.81]),
        orientation=np.array([1.0, 0.0, 0.0, 0.0]),
        foot_force=np.full((2, 4), 6.7),
    )


SILENT = SensorNoise(**dict.fromkeys(SensorNoise.__dataclass_fields__, 0.0))


def test_without_noise_the_reading_is_the_truth():
    sensed = reading(SensorSuite(SILENT, np.random.default_rng(0), PERIOD, 26))
    assert np.array_equal(sensed.joint_position, np.linspace(-1.0, 1.0, 26))
    assert np.array_equal(sensed.gyro, [0.1, 0.2, 0.3])
    assert np.allclose(sensed.orientation, [1, 0, 0, 0], atol=1e-15)
    assert np.array_equal(sensed.foot_force, np.full((2, 4), 6.7))


def test_the_same_seed_reads_the_same():
    first, second = (SensorSuite(SensorNoise(), np.random.default_rng(3), PERIOD, 26) for _ in "ab")
    for _ in range(5):
        a, b = reading(first), reading(second)
    assert np.array_equal(a.joint_position, b.joint_position)
    assert np.array_equal(a.orientation, b.orientation)


@pytest.mark.parametrize(
    ("name", "field", "sigma"),
    [
        ("encoder", "joint_position", 0.0005),
        ("gyro", "gyro", 0.01),
        ("accelerometer", "accelerometer", 0.1),
    ],
)
def test_white_noise_has_the_size_asked_for(name, field, sigma):
    suite = SensorSuite(SensorNoise(), np.random.default_rng(1), PERIOD, 26)
    truth = getattr(reading(SensorSuite(SILENT, np.random.default_rng(0), PERIOD, 26)), field)
    errors = np.concatenate([getattr(reading(suite), field) - truth for _ in range(2000)])
    assert np.isclose(errors.std(), sigma, rtol=0.05), name
    assert abs(errors.mean()) < 4 * sigma / np.sqrt(errors.size)


def test_yaw_drifts_as_a_random_walk():
    noise = SensorNoise(yaw_drift=0.01, tilt=0.0)
    ends = []
    for seed in range(200):
        suite = SensorSuite(noise, np.random.default_rng(seed), PERIOD, 26)
        for _ in range(50):
            sensed = reading(suite)
        ends.append(heading(sensed.orientation))
    assert np.isclose(np.std(ends), 0.01 * np.sqrt(50 * PERIOD), rtol=0.2)


def test_every_pad_has_a_constant_gain():
    suite = SensorSuite(replace(SILENT, foot_force_gain=0.1), np.random.default_rng(2), PERIOD, 26)
    gain = reading(suite).foot_force / 6.7
    assert 0.02 < np.std(gain) < 0.3
    assert np.array_equal(reading(suite).foot_force, 6.7 * gain)


def test_a_pad_never_pulls():
    suite = SensorSuite(SensorNoise(foot_force=50.0), np.random.default_rng(2), PERIOD, 26)
    assert (reading(suite).foot_force >= 0.0).all()


def test_constant_errors_of_the_imu():
    biased = replace(SILENT, pitch_bias=0.02, roll_bias=-0.01, gyro_bias=0.1)
    suite = SensorSuite(biased, np.random.default_rng(0), PERIOD, 26)
    sensed = [reading(suite) for _ in range(100)][-1]
    assert np.allclose(sensed.gyro, [0.2, 0.3, 0.4])
    assert heading(sensed.orientation) == pytest.approx(0.1 * 100 * PERIOD, abs=1e-3)
    w, x, y, _ = reading(SensorSuite(biased, np.random.default_rng(0), PERIOD, 26)).orientation
    assert (2 * x / w, 2 * y / w) == pytest.approx((-0.01, 0.02), abs=1e-3)
