import numpy as np
import pytest

from hsr8.robot import camera_pose
from vision.parameters import PoseParameters
from walking.state import HeadCameraPose

SIGMA = PoseParameters()


@pytest.mark.parametrize(("pan_rate", "tilt_rate"), [(0.0, 0.0), (-4.0, 0.5), (6.0, -1.0)])
def test_what_the_head_turns_smears_an_image_while_it_is_exposed(pan_rate, tilt_rate):
    head = HeadCameraPose(np.eye(3), np.array([0.0, 0.0, 0.47]), 0.3, -0.2, pan_rate, tilt_rate)
    pose = camera_pose(head, SIGMA, shutter=0.02)
    assert pose.pan_smear == pytest.approx(0.02 * abs(pan_rate))
    assert pose.tilt_smear == pytest.approx(0.02 * abs(tilt_rate))
    sharp = camera_pose(head, SIGMA, shutter=0.0)
    assert (sharp.pan_smear, sharp.tilt_smear) == (0.0, 0.0)
    assert pose.yaw_sigma == sharp.yaw_sigma == SIGMA.yaw_sigma
