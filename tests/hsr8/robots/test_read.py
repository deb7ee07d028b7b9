"""Model files are read with names for all parts, and every file that they need is known."""

import re
from xml.etree import ElementTree

import mujoco
import pytest

from hsr8.errors import ModelError
from hsr8.robots.file.description import read_description
from hsr8.robots.file.locate import digest, find_description
from hsr8.robots.loaded import load_robot, read_robot
from tests.hsr8.robots.mesh_humanoid import write_robot
from tests.hsr8.robots.robot_parts import SHIPPED, described, part, setting
from tests.hsr8.robots.small_humanoid import SmallHumanoid


@pytest.fixture
def read(tmp_path):
    """Write a changed robot and read it."""

    def read_changed(change, **keys):
        root = SmallHumanoid(actuator="").element()
        change(root)
        (tmp_path / "robot.xml").write_text(ElementTree.tostring(root, "unicode"))
        return read_robot(described(SmallHumanoid(), **keys), tmp_path / "robot.toml").model

    return read_changed


def option(**values):
    return lambda root: root.find("option").attrib.update(values)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (option(timestep="0"), "option: timestep, got 0 s; expected at least 1e-05"),
        (
            setting("joint", "l_knee", range="nan nan"),
            "joint 'l_knee': range, got nan nan; expecte",
        ),
        (
            setting("joint", "l_knee", damping="-1"),
            "joint 'l_knee': damping, got -1; expected >= 0",
        ),
        (setting("body", "torso", pos="0 0 1e9"), "body 'torso': 1e+09 m from the body that carr"),
    ],
)
def test_numbers_that_are_not_those_of_a_robot_are_refused(read, change, reason):
    with pytest.raises(ModelError, match=re.escape(reason)):
        read(change)


def test_warnings_of_mujoco_are_neither_printed_nor_logged(read, tmp_path, monkeypatch, recwarn):
    monkeypatch.chdir(tmp_path)
    for change in (
        setting("joint", "l_knee", range="nan nan"),
        setting("body", "torso", pos="0 0 1e9"),
    ):
        with pytest.raises(ModelError):
            read(change)
    assert not recwarn
    assert [path.name for path in tmp_path.iterdir()] == ["robot.xml"]


def names(model):
    bodies = [model.body(b).name for b in range(model.nbody)]
    return bodies, [model.joint(j).name for j in range(model.njnt)]


def test_parts_without_a_name_get_one(read):
    def remove_names(root):
        for tag in ("body", "joint"):
            for element in list(root.iter(tag))[::2]:
                if element.get("name") not in SmallHumanoid().feet():
                    element.attrib.pop("name", None)
        part(root, "body", "torso").set("name", "body_1")

    bodies, joints = names(read(remove_names))
    assert len({*bodies}) == len(bodies)
    assert len({*joints}) == len(joints)
    assert "body_1" in bodies
    assert "unnamed_body_1" in bodies
    assert all(bodies)
    assert all(joints)


def test_names_of_the_file_remain(read):
    assert names(read(lambda root: None)) == names(
        mujoco.MjModel.from_xml_string(SmallHumanoid(actuator="").xml())
    )


@pytest.mark.parametrize("angle", ["radian", "degree"])
def test_a_description_corrects_a_range(read, angle):
    def unit(root):
        root.find("compiler").set("angle", angle)

    model = read(unit, range={"l_knee": (0.1, 1.9)})
    assert model.joint("l_knee").range == pytest.approx([0.1, 1.9])


def described_file(folder, element, lines=""):
    (folder / "robot.xml").write_text(ElementTree.tostring(element, encoding="unicode"))
    left, right = SmallHumanoid().feet()
    file = folder / "robot.toml"
    file.write_text(f'model = "robot.xml"\nfeet = ["{left}", "{right}"]\n{lines}')
    return file


def test_a_change_of_an_included_file_is_another_robot(tmp_path):
    root = SmallHumanoid().element()
    actuators = root.find("actuator")
    root.remove(actuators)
    include = ElementTree.Element("mujocoinclude")
    include.append(actuators)
    root.append(ElementTree.Element("include", {"file": "servos.xml"}))
    servos = tmp_path / "servos.xml"
    text = ElementTree.tostring(include, "unicode")
    servos.write_text(text)
    file = str(described_file(tmp_path, root))
    before, robot = digest(file), load_robot(file)
    assert load_robot(file) is robot
    servos.write_text(text.replace('kp="300"', 'kp="310"'))
    assert digest(file) != before
    assert load_robot(file).model.tree.stiffness[0] == 310.0


def test_a_change_of_a_mesh_is_another_robot(tmp_path):
    file = write_robot(tmp_path)
    before = digest(str(file))
    mesh = next(path for path in tmp_path.rglob("*") if path.suffix in (".stl", ".obj"))
    mesh.write_bytes(mesh.read_bytes() + b" ")
    assert digest(str(file)) != before


@pytest.mark.parametrize("name", SHIPPED)
def test_mass_and_joints_of_a_description_are_those_of_the_model(name):
    file = find_description(name)
    description = read_description(file)
    model = read_robot(description, file).model
    assert description.about.mass == pytest.approx(model.body_subtreemass[1], rel=0.01)
    assert description.about.joints == model.njnt - 1
