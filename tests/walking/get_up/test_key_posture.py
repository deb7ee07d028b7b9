"""Key postures and their mirror images."""

import numpy as np
import pytest

from walking.get_up_motions import MOTIONS, STRAIGHT

POSTURES = (*MOTIONS.rise, *MOTIONS.roll, STRAIGHT)


@pytest.mark.parametrize("posture", POSTURES, ids=lambda p: p.name)
def test_the_mirror_image_swaps_the_sides_and_turns_roll_and_yaw(posture, mirrored_joints):
    angles, mirrored = np.array(posture.angles()), np.array(posture.mirrored().angles())
    assert mirrored == pytest.approx(mirrored_joints(angles))
    assert posture.mirrored().mirrored() == posture


@pytest.mark.parametrize("posture", [*MOTIONS.rise, STRAIGHT], ids=lambda p: p.name)
def test_rising_is_symmetric(posture):
    assert posture.mirrored() == posture


@pytest.mark.parametrize("posture", POSTURES, ids=lambda p: p.name)
def test_every_posture_is_within_the_joints_limits(robot, posture):
    angles = np.array(posture.angles())
    assert (angles >= robot.lower).all()
    assert (angles <= robot.upper).all()
