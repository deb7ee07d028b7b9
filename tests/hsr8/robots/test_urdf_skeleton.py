import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from hsr8.robots.guess import guess_roles
from hsr8.robots.skeleton import skeleton_of
from hsr8.robots.urdf import convert
from hsr8.robots.urdf_file import read_urdf
from hsr8.robots.urdf_skeleton import skeleton_of_urdf
from tests.hsr8.robots.small_urdf import SmallUrdf, describe, joint, write

TURNS = [Rotation.identity(), Rotation.from_euler("z", 90, degrees=True)]


@pytest.mark.parametrize("root", TURNS)
@pytest.mark.parametrize("seed", [None, 1, 2])
def test_the_skeleton_is_that_of_the_converted_model(root, seed, tmp_path):
    """Up to the turn and the origin of the base."""
    file = write(SmallUrdf(seed=seed, root=root).element(), tmp_path)
    raw = skeleton_of_urdf(read_urdf(file))
    model = convert(file, describe(), tmp_path).spec.compile()
    other = skeleton_of(model, 1).turned(root.inv().as_matrix())
    assert sorted(raw.joints) == sorted(other.joints)
    order = [other.joints.index(name) for name in raw.joints]
    assert raw.axes == pytest.approx(other.axes[order], abs=1e-9)
    assert raw.anchors == pytest.approx(other.anchors[order], abs=1e-9)
    assert raw.coms == pytest.approx(other.coms[order], abs=1e-9)
    assert raw.masses == pytest.approx(other.masses[order])
    assert raw.ranges == pytest.approx(other.ranges[order])
    assert raw.total_mass == pytest.approx(other.total_mass)
    parents = [other.joints[k] if k >= 0 else "" for k in np.array(other.parents)[order]]
    assert [raw.joints[k] if k >= 0 else "" for k in raw.parents] == parents


@pytest.mark.parametrize("seed", [None, 4])
def test_the_roles_are_guessed(seed, tmp_path):
    file = write(SmallUrdf(seed=seed, root=TURNS[1]).element(), tmp_path)
    roles = guess_roles(skeleton_of_urdf(read_urdf(file)))
    assert roles.feet == ("l_ankle_roll_link", "r_ankle_roll_link")
    assert roles.legs == SmallUrdf().legs()
    assert roles.head == ("head_yaw", "head_pitch")
    assert roles.shoulders == ("l_shoulder", "r_shoulder")


def test_joints_that_cannot_move_are_rigid(tmp_path):
    robot = SmallUrdf().element()
    joint(robot, "waist").set("type", "prismatic")
    joint(robot, "l_elbow").find("limit").attrib.update(lower="0", upper="0")
    joint(robot, "r_elbow").find("limit").set("effort", "0")
    skeleton = skeleton_of_urdf(read_urdf(write(robot, tmp_path)))
    assert not {"waist", "l_elbow"} & set(skeleton.joints)
    assert "r_elbow" in skeleton.joints  # the file may be silent about its effort
    assert skeleton.total_mass == pytest.approx(
        skeleton_of_urdf(read_urdf(write(SmallUrdf().element(), tmp_path))).total_mass
    )
