from dataclasses import replace
from math import cos, pi, sin
from types import SimpleNamespace

import numpy as np
import pytest

from hsr8.measure.walking import walk_metrics
from hsr8.recording.rows import limit_bits
from hsr8.simulation.record import Second
from hsr8.world.truth.saturation import Saturation
from hsr8.world.truth.truth import ActivePush
from walking.body.tree import JOINT_NAMES
from walking.command import Limit, VelocityCommand
from walking.state import Phase

STEP = 0.34


def integrated(start, velocity, time):
    """Pose after a constant velocity in the robot frame, in small steps."""
    x, y, yaw = start
    vx, vy, wz = velocity
    n = 500
    yaws = yaw + wz * time * (np.arange(n) + 0.5) / n
    x += time / n * np.sum(np.cos(yaws) * vx - np.sin(yaws) * vy)
    y += time / n * np.sum(np.sin(yaws) * vx + np.cos(yaws) * vy)
    return np.array([x, y, yaw + wz * time])


def records(fake, velocity, duration, *, applied=None, steps=True):
    """An arc walked at `velocity`, the body swaying by 2 cm with the gait, over the wrap of yaw."""
    for k in range(round(duration * 50) + 1):
        time = 0.02 * k
        x, y, yaw = integrated(np.array([0.0, 0.0, 3.0]), velocity, max(time, 1e-9)).tolist()
        sway = 0.02 * sin(pi * time / STEP)
        yaw = (yaw + pi) % (2 * pi) - pi
        record = fake.record(time, (x - sway * sin(yaw), y + sway * cos(yaw), yaw))
        walking = replace(
            record.walking,
            step_count=int(time / STEP + 1e-9) if steps else 0,
            phase=Phase.DOUBLE_SUPPORT if steps else Phase.STANDING,
            applied_velocity=np.array(velocity if applied is None else applied),
        )
        yield replace(record, walking=walking, command=VelocityCommand(*velocity))


@pytest.fixture
def results_of(tables_of):
    return lambda *tables, **ticks: walk_metrics(SimpleNamespace(**tables_of(*tables, **ticks)))


@pytest.mark.parametrize("velocity", [(0.3, 0.0, 0.0), (0.1, 0.05, 0.6), (-0.1, 0.0, -0.8)])
def test_the_sway_of_the_gait_is_not_velocity(fake, results_of, velocity):
    results = results_of(records(fake, velocity, 8.0))
    assert list(results["mean_velocity"].values()) == pytest.approx(velocity, abs=0.004)
    assert list(results["velocity_error"]["commanded"].values()) == pytest.approx(
        [0] * 3, abs=0.004
    )
    assert results["steps"] == 23


def test_errors_are_signed_and_from_the_commanded_and_the_applied_velocity(fake, results_of):
    stream = records(fake, (0.2, 0.0, 0.0), 8.0, applied=(0.15, 0.0, 0.1))
    error = results_of(stream)["velocity_error"]["applied"]
    assert list(error.values()) == pytest.approx([0.05, 0.0, -0.1], abs=0.003)


def test_the_first_seconds_do_not_count(fake, results_of):
    def late(stream):
        for record in stream:
            yield replace(record, command=VelocityCommand(9.0 if record.time < 2.98 else 0.2))

    error = results_of(late(records(fake, (0.2, 0.0, 0.0), 8.0)))["velocity_error"]["commanded"]
    assert error["vx"] == pytest.approx(0.0, abs=0.003)


def test_a_fall_is_not_walking(fake, results_of):
    def thrown(stream):
        for record in stream:
            down = 4.0 <= record.time < 5.0
            x, y, yaw = record.truth.robot
            robot = np.array([x, y + (0.5 if record.time >= 4.0 else 0.0), yaw])
            truth = replace(record.truth, fallen=down, robot=robot)
            yield replace(record, truth=truth)

    results = results_of(thrown(records(fake, (0.2, 0.0, 0.0), 9.0)))
    assert list(results["mean_velocity"].values()) == pytest.approx((0.2, 0.0, 0.0), abs=0.004)


def test_a_standing_robot_has_no_velocity(fake, results_of):
    results = results_of(records(fake, (0.0, 0.0, 0.0), 6.0, steps=False))
    assert results["mean_velocity"]["wz"] == pytest.approx(0.0, abs=1e-9)
    assert results["steps"] == 0


def test_a_short_run_has_no_velocity(fake, results_of):
    assert results_of(records(fake, (0.2, 0.0, 0.0), 2.0))["mean_velocity"] is None


def ticks(*limits, depth=0.01):
    """Columns of ticks of the walking engine, 2 ms each, and of one on the floor."""
    n = len(limits)
    return {
        "limits": [*map(limit_bits, limits), limit_bits((Limit.SPEED,))],
        "zmp_depth": [depth] * n + [-1.0],
        "down": [False] * n + [True],
        "walking_time": [0.002] * n + [1.0],
    }


def test_limits_are_fractions_of_the_ticks_on_the_feet(fake, results_of):
    acceleration, region = Limit.ACCELERATION, Limit.ZMP_REGION
    limits = ((), (acceleration,), (region, acceleration), ())
    results = results_of([fake.record(0.0)], **ticks(*limits))
    assert results["limited_fraction"] == 0.5
    assert results["limited_by"] == {"acceleration": 0.5, "zmp_region": 0.25}
    assert results["zmp_outside_sole_ticks"] == 0
    assert results["zmp_min_margin_m"] == 0.01
    assert "walk_tick_mean_ms" not in results
    assert results_of(**ticks((), (), depth=-0.001))["zmp_outside_sole_ticks"] == 2
    assert "walk_ticks" not in results_of(**ticks())


def test_servos_and_times_need_a_body_with_dynamics(fake, results_of):
    none, saturated, peak = np.zeros(26, np.int64), np.zeros(26, np.int64), np.zeros(26)
    saturated[3], peak[3] = 7, 1.0
    push = ActivePush(4, 1.0, 0.05, "torso_link", 0.0, np.zeros(3), np.array([3.0, 4.0, 0.0]))
    seconds = [
        Second(0, 0.0, b"", b"", Saturation(JOINT_NAMES, 0, none, 0, none, 0.0 * peak, peak)),
        Second(9, 1.0, b"", b"", Saturation(JOINT_NAMES, 7, saturated, 0, none, peak, 5.0 * peak)),
    ]
    results = results_of([fake.record(0.0, pushes=(push,))], seconds, **ticks((), ()))
    assert results["torque_saturated_by"] == {"l_knee": 7}
    assert results["joint_stop_by"] == {}
    assert (results["peak_torque_joint"], results["peak_joint_speed_radps"]) == ("l_knee", 5.0)
    assert results["walk_tick_mean_ms"] == pytest.approx(2.0)
    assert results["pushes"] == 5
    assert push.impulse == pytest.approx(0.25)
