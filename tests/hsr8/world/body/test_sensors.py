from dataclasses import replace

import mujoco
import numpy as np
import pytest

from hsr8.robots.loaded import load_robot
from hsr8.scenario.sensors import SensorNoise
from hsr8.world.body.sensors import SensorSuite
from hsr8.world.model.index import ModelIndex
from hsr8.world.rotation import heading

PERIOD = 0.005


@pytest.fixture
def reader(world):
    """Build a sensor suite and return a function that reads the same state each time."""
    _, model = world()
    index, data = ModelIndex.of(model, load_robot("hsr8"), 0, 0), mujoco.MjData(model)
    root, dof = index.root_qpos, index.root_dof
    data.qpos[root + 3 : root + 7] = 1.0, 0.0, 0.0, 0.0
    data.qpos[index.joint_qpos] = np.linspace(-1.0, 1.0, 26)
    data.qvel[dof + 3 : dof + 6] = 0.1, 0.2, 0.3
    data.sensordata[index.accelerometer] = 0.0, 0.0, 9.81
    data.sensordata[index.foot_force] = 6.7

    def build(noise, seed=0):
        suite = SensorSuite(noise, np.random.default_rng(seed), PERIOD, index)
        return lambda: suite.read(data)

    return build


SILENT = SensorNoise(**dict.fromkeys(SensorNoise.__dataclass_fields__, 0.0))


def test_without_noise_the_reading_is_the_truth(reader):
    sensed = reader(SILENT)()
    assert np.array_equal(sensed.joint_position, np.linspace(-1.0, 1.0, 26))
    assert np.array_equal(sensed.gyro, [0.1, 0.2, 0.3])
    assert np.allclose(sensed.orientation, [1, 0, 0, 0], atol=1e-15)
    assert np.array_equal(sensed.foot_force, np.full((2, 4), 6.7))


@pytest.mark.parametrize(
    ("name", "field", "sigma"),
    [
        ("encoder", "joint_position", 0.0005),
        ("gyro", "gyro", 0.01),
        ("accelerometer", "accelerometer", 0.1),
    ],
)
def test_white_noise_has_the_size_asked_for(reader, name, field, sigma):
    read = reader(SensorNoise(), seed=1)
    truth = getattr(reader(SILENT)(), field)
    errors = np.concatenate([getattr(read(), field) - truth for _ in range(2000)])
    assert np.isclose(errors.std(), sigma, rtol=0.05), name
    assert abs(errors.mean()) < 4 * sigma / np.sqrt(errors.size)


def test_yaw_drifts_as_a_random_walk(reader):
    noise = SensorNoise(yaw_drift=0.01, tilt=0.0)
    ends = []
    for seed in range(200):
        read = reader(noise, seed)
        for _ in range(50):
            sensed = read()
        ends.append(heading(sensed.orientation))
    assert np.isclose(np.std(ends), 0.01 * np.sqrt(50 * PERIOD), rtol=0.2)


def test_every_pad_has_a_constant_gain(reader):
    read = reader(replace(SILENT, foot_force_gain=0.1), seed=2)
    gain = read().foot_force / 6.7
    assert 0.02 < np.std(gain) < 0.3
    assert np.array_equal(read().foot_force, 6.7 * gain)


def test_a_pad_never_pulls(reader):
    assert (reader(SensorNoise(foot_force=50.0), seed=2)().foot_force >= 0.0).all()


def test_constant_errors_of_the_imu(reader):
    biased = replace(SILENT, pitch_bias=0.02, roll_bias=-0.01, gyro_bias=0.1)
    read = reader(biased)
    sensed = [read() for _ in range(100)][-1]
    assert np.allclose(sensed.gyro, [0.2, 0.3, 0.4])
    assert heading(sensed.orientation) == pytest.approx(0.1 * 100 * PERIOD, abs=1e-3)
    w, x, y, _ = reader(biased)().orientation
    assert (2 * x / w, 2 * y / w) == pytest.approx((-0.01, 0.02), abs=1e-3)
