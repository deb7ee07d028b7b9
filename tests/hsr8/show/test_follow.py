import numpy as np
import pytest

from hsr8.show.follow import SIDE_ANGLE, FollowCamera


def _walk(n, yaw):
    qpos = np.zeros((n, 7))
    qpos[:, 0] = np.linspace(0.0, 2.0, n)
    qpos[:, 3], qpos[:, 6] = np.cos(yaw / 2), np.sin(yaw / 2)
    return qpos


def test_a_standing_robot_is_seen_from_behind_and_from_the_side():
    qpos = _walk(50, np.full(50, 0.7))
    qpos[:, 0] = 1.0
    camera = FollowCamera(qpos, 25, 1.0).at(30)
    np.testing.assert_allclose(camera.lookat[:2], [1.0, 0.0], atol=1e-9)
    assert np.isclose(camera.azimuth, np.degrees(0.7) + SIDE_ANGLE)


def test_sway_does_not_shake_the_image():
    n = 200
    qpos = _walk(n, 0.2 * np.sin(np.arange(n) * 2 * np.pi / 8))
    qpos[:, 1] = 0.03 * np.sin(np.arange(n) * 2 * np.pi / 8)
    follow = FollowCamera(qpos, 25, 1.0)
    azimuth = [follow.at(i).azimuth for i in range(50, 150)]
    aside = [follow.at(i).lookat[1] for i in range(50, 150)]
    assert np.ptp(azimuth) < 0.5
    assert np.ptp(aside) < 0.01


def test_a_turn_through_180_degrees_takes_the_shorter_direction():
    n = 400
    follow = FollowCamera(_walk(n, np.linspace(3.0, 3.4, n)), 25, 1.0)
    azimuth = np.array([follow.at(i).azimuth for i in range(n)])
    assert np.abs(np.diff(azimuth)).max() < 1.0


def test_the_camera_does_not_lag_behind():
    follow = FollowCamera(_walk(500, np.zeros(500)), 25, 1.0)
    middle = follow.at(250).lookat[0]
    assert abs(middle - 2.0 * 250 / 499) < 0.01


def test_a_robot_that_turns_back_stays_in_a_fast_video():
    """Ten times as fast: 0.2 m/s for 15 s and back again, seen from less than 2 m away."""
    qpos = _walk(150, np.zeros(150))
    time = np.arange(150) * 10 / 25
    qpos[:, 0] = 0.2 * np.abs((time % 30.0) - 15.0)
    follow = FollowCamera(qpos, 25, speed=10.0)
    away = [abs(follow.at(i).lookat[0] - qpos[i, 0]) for i in range(150)]
    assert max(away) < 0.3


@pytest.mark.parametrize("size", [0.5, 1.0, 3.0])
def test_a_robot_of_any_size_has_the_same_size_in_the_image(size):
    qpos = _walk(20, np.zeros(20))
    usual, camera = FollowCamera(qpos, 25, 1.0).at(7), FollowCamera(qpos, 25, 1.0, size).at(7)
    assert camera.distance == pytest.approx(size * usual.distance)
    assert camera.lookat[2] == pytest.approx(size * usual.lookat[2])
    assert (camera.azimuth, camera.elevation) == (usual.azimuth, usual.elevation)
