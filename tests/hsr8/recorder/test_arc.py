import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.recorder.arc import mean_velocity

speeds = st.floats(-0.5, 0.5)


def integrated(start, velocity, time):
    """Pose after a constant velocity in the robot frame, in small steps."""
    x, y, yaw = start
    vx, vy, wz = velocity
    n = 20000
    yaws = yaw + wz * time * (np.arange(n) + 0.5) / n
    x += time / n * np.sum(np.cos(yaws) * vx - np.sin(yaws) * vy)
    y += time / n * np.sum(np.sin(yaws) * vx + np.cos(yaws) * vy)
    return np.array([x, y, yaw + wz * time])


@given(speeds, speeds, st.floats(-2.0, 2.0), st.floats(-3.0, 3.0))
def test_the_velocity_of_an_arc_is_recovered(vx, vy, wz, yaw):
    start = np.array([0.3, -1.0, yaw])
    end = integrated(start, (vx, vy, wz), 0.7)
    assert mean_velocity(start, end, 0.7) == pytest.approx([vx, vy, wz], abs=1e-6)
