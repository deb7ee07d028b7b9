"""Models read and completed by their description."""

from xml.etree import ElementTree
from xml.etree.ElementTree import SubElement

import numpy as np
import pytest

from hsr8.errors import ModelError
from hsr8.robots.description import checked
from hsr8.robots.loaded import load_robot
from hsr8.robots.read_model import read_model
from tests.hsr8.robots.small_humanoid import SmallHumanoid

SMALL = SmallHumanoid()


@pytest.mark.parametrize("angle", ["radian", "degree"])
def test_a_description_corrects_a_range(tmp_path, angle):
    element = SMALL.element()
    element.find("compiler").set("angle", angle)
    file = tmp_path / "robot.xml"
    file.write_text(ElementTree.tostring(element, encoding="unicode"))
    keys = {"model": file.name, "feet": SMALL.feet(), "range": {"l_knee": (0.1, 1.9)}}
    model = read_model(file, checked(keys, "test"), tmp_path).spec.compile()
    assert model.joint("l_knee").range == pytest.approx([0.1, 1.9])
    other = model.joint("r_knee").range
    assert other[1] == pytest.approx(2.2 if angle == "radian" else np.radians(2.2))


def described(tmp_path, element, lines=""):
    tmp_path.joinpath("robot.xml").write_text(ElementTree.tostring(element, encoding="unicode"))
    file = tmp_path / "robot.toml"
    left, right = SMALL.feet()
    file.write_text(f'model = "robot.xml"\nfeet = ["{left}", "{right}"]\n{lines}')
    return str(file)


def test_the_floor_of_a_scene_and_its_contacts_are_removed(tmp_path):
    element = SMALL.element()
    floor = {"name": "floor", "type": "plane", "size": "1 1 0.1"}
    SubElement(element.find("worldbody"), "geom", floor)
    base = element.find("worldbody/body/geom")
    base.set("name", "trunk")
    SubElement(SubElement(element, "contact"), "pair", {"geom1": "trunk", "geom2": "floor"})
    spec = load_robot(described(tmp_path, element)).spec
    assert not spec.pairs
    assert spec.geom("floor") is None


def test_a_range_of_an_unknown_joint_is_refused(tmp_path):
    lines = "[range]\nl_kne = [0.0, 1.0]\n"
    with pytest.raises(ModelError, match=r"range: the model has no hinge joint 'l_kne'.*l_knee"):
        load_robot(described(tmp_path, SMALL.element(), lines))
