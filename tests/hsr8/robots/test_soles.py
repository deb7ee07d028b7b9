from math import pi
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from hsr8.robots.inspection import inspect
from hsr8.robots.parts.soles import sole_tilt
from tests.hsr8.robots.robot_parts import MENAGERIE, model_file
from tests.hsr8.robots.small_humanoid import SmallHumanoid
from tests.hsr8.robots.small_urdf import SmallUrdf, write

BOX = np.array([[x, y, z] for x in (-0.1, 0.15) for y in (-0.04, 0.04) for z in (0.0, 0.03)])


@given(angle=st.floats(-0.7, 0.7))
def test_the_tilt_undoes_a_turn_of_the_foot(angle):
    turned = Rotation.from_rotvec([0.0, angle, 0.0]).apply(BOX)
    assert sole_tilt(turned) == pytest.approx(-angle, abs=1e-9)


def test_rounded_and_flat_shapes_have_no_sole():
    assert sole_tilt(BOX[BOX[:, 2] == 0.0]) is None
    sphere = np.random.default_rng(1).normal(size=(500, 3))
    assert sole_tilt(sphere / np.linalg.norm(sphere, axis=1, keepdims=True)) is None
    assert sole_tilt(np.zeros((0, 3))) is None


@pytest.mark.parametrize(("tilt", "flip"), [(0.2, False), (-0.15, True)])
def test_tilted_soles_give_the_angles_of_flat_ones(tilt, flip, tmp_path):
    """The zero posture of the file is another one than that of the soles."""
    root = SmallHumanoid(flip=flip).element()
    for geom in root.iter("geom"):
        if (geom.get("name") or "").endswith("_sole"):
            geom.set("euler", f"0 {tilt} 0")
    file = tmp_path / "small.xml"
    file.write_text(ElementTree.tostring(root, "unicode"))
    inspection = inspect(str(file))
    right = tilt if flip else -tilt
    assert inspection.description.zero == pytest.approx(
        {"l_ankle_pitch": -tilt, "r_ankle_pitch": right}, abs=1e-3
    )
    assert [f.sureness for f in inspection.findings if f.role == "zero"] == ["likely"]


def test_flat_soles_need_no_angles(tmp_path):
    (tmp_path / "small.xml").write_text(SmallHumanoid().xml())
    assert inspect(str(tmp_path / "small.xml")).description.zero == {}
    turned = Rotation.from_euler("z", 0.5 * pi)
    file = write(SmallUrdf(seed=5, root=turned).element(), tmp_path)
    assert inspect(str(file)).description.zero == {}


@MENAGERIE
def test_berkeley_humanoid_stands_on_tilted_soles():
    zero = inspect(str(model_file("berkeley"))).description.zero
    assert zero == pytest.approx({"LL_FFE": 0.1745, "LR_FFE": 0.1745}, abs=1e-3)
