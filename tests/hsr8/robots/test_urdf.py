"""URDF files: what the importer adds to MuJoCo's reader."""

from xml.etree.ElementTree import SubElement

import numpy as np
import pytest

from hsr8.errors import ModelError
from hsr8.robots.model.servos import own_efforts
from hsr8.robots.parts.roles import find_roles
from hsr8.robots.parts.skeleton import Posed
from hsr8.robots.parts.soles import soles_of
from tests.hsr8.robots.mesh_files import FORMATS, write_mesh
from tests.hsr8.robots.small_urdf import SmallUrdf, built, describe, joint, link, raw

SOLE = (0.10, -0.06, 0.105, 0.025, -0.44)


def soles(robot, folder, **keys):
    """Edges of the left sole in the base [m], and the notes of the robot."""
    read = raw(robot, folder, **keys)
    description = describe(**keys)
    roles = find_roles(read.model, description, read.prepared)
    zero = Posed.at(read.model, {})
    (left, right), notes = soles_of(zero, roles, description)
    assert right == left.mirrored()
    return (left.front, left.back, left.left, left.right, left.height), [*read.notes, *notes]


def replace_shapes(robot, side, kinds, *shapes):
    """Replace shapes of a foot by others: tag, keys, and position in the foot."""
    foot = link(robot, f"{side}_foot")
    for kind in kinds:
        for old in foot.findall(kind):
            foot.remove(old)
        for tag, keys, at in shapes:
            shape = SubElement(foot, kind)
            SubElement(shape, "origin", xyz=" ".join(map(str, at)))
            SubElement(SubElement(shape, "geometry"), tag, keys)


def both_feet(robot, kinds, *shapes):
    for side in "lr":
        replace_shapes(robot, side, kinds, *shapes)


def test_contacts_only_of_soles_and_with_obstacles(small_robot):
    model = small_robot.spec.copy().compile()
    floor = [
        g for g in range(model.ngeom) if (model.geom_contype[g] | model.geom_conaffinity[g]) & 1
    ]
    assert [model.geom(g).name for g in floor] == ["hsr8/r_sole", "hsr8/l_sole"] or len(floor) == 2
    solid = model.geom_group == 3
    assert (model.geom_contype[~solid] == 0).all()
    assert (model.geom_conaffinity[~solid] == 0).all()


def test_limits_come_from_the_file(tmp_path):
    read = raw(SmallUrdf().element(), tmp_path)
    knee = read.model.joint("l_knee")
    np.testing.assert_allclose(knee.range, (-0.1, 2.2))
    assert read.speed["l_knee"] == 8.0
    np.testing.assert_allclose(read.model.jnt_actfrcrange[knee.id], (-40.0, 40.0))
    assert float(knee.damping[0]) == 0.1
    assert float(knee.frictionloss[0]) == 0.05


def test_elements_of_other_programs_are_ignored(tmp_path):
    robot = SmallUrdf().element()
    SubElement(SubElement(link(robot, "l_foot"), "collision_checking"), "capsule", name="sole")
    SubElement(SubElement(robot, "gazebo"), "capsule")
    assert soles(robot, tmp_path)[0] == pytest.approx(SOLE)


@pytest.mark.parametrize("placeholder", ["-1", "3e38", "10001", "inf"])
def test_a_placeholder_of_an_effort_is_no_limit(placeholder, tmp_path):
    robot = SmallUrdf().element()
    joint(robot, "l_knee").find("limit").set("effort", placeholder)
    efforts = own_efforts(raw(robot, tmp_path).model)
    assert "l_knee" not in efforts
    assert efforts["r_knee"] == 40.0


def test_a_stated_limit_replaces_that_of_the_file_and_a_continuous_joint_gets_one_turn(tmp_path):
    robot = SmallUrdf().element()
    for side in "lr":
        joint(robot, f"{side}_hip_yaw").set("type", "continuous")
    tree = built(robot, tmp_path, effort={"l_knee": 50.0}, speed={"l_knee": 7.0}).model.tree
    assert tree.effort[tree.names.index("l_knee")] == 50.0
    assert tree.speed[tree.names.index("l_knee")] == 7.0
    assert (tree.lower[0], tree.upper[0]) == pytest.approx((-np.pi, np.pi))


def test_a_stated_range_frees_a_joint_without_one(tmp_path):
    robot = SmallUrdf().element()
    joint(robot, "l_knee").find("limit").attrib.update(lower="0", upper="0")
    model = raw(robot, tmp_path, range={"l_knee": (-0.1, 2.0)}).model
    np.testing.assert_allclose(model.joint("l_knee").range, (-0.1, 2.0))


def test_efforts_of_zero_everywhere_do_not_hold_the_legs(tmp_path):
    robot = SmallUrdf().element()
    for element in robot.findall("joint"):
        if element.find("limit") is not None:
            element.find("limit").set("effort", "0")
    read = raw(robot, tmp_path, shoulders=["l_shoulder", "r_shoulder"])
    names = {read.model.joint(j).name for j in range(read.model.njnt)}
    left, right = SmallUrdf().legs()
    assert names == {"pelvis_free", *left, *right, "l_shoulder", "r_shoulder"}


def test_a_camera_on_a_fixed_link_is_on_its_body(tmp_path):
    robot = SmallUrdf(seed=6).element()
    camera = {"body": "camera", "position": [0.01, 0.0, 0.0], "tilt_deg": -10.0}
    result = built(robot, tmp_path, camera=camera, head=["head_yaw", "head_pitch"])
    frame = result.model.tree.camera
    assert result.model.names[frame.joint] == "head_pitch"
    _, position = result.model.frame_pose(frame, np.zeros(len(result.model.names)))
    np.testing.assert_allclose(position, (0.06, 0.0, 0.33), atol=1e-9)


@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.parametrize("scale", ["1 1 1", "0.5 1 1"])
def test_a_mesh_of_any_format(name, scale, tmp_path):
    write_mesh(tmp_path, name)
    robot = SmallUrdf().element()
    mesh = ("mesh", {"filename": f"package://small/{name}", "scale": scale}, (0, 0, -0.01))
    both_feet(robot, ["collision", "visual"], mesh)
    sole, _ = soles(robot, tmp_path)
    length = 0.08 * float(scale.split()[0])
    assert sole == pytest.approx((length, -length, 0.10, 0.02, -0.44), abs=1e-6)
    assert raw(robot, tmp_path).model.nmesh == 1


def test_visual_shapes_where_the_others_make_no_flat_sole(tmp_path):
    robot = SmallUrdf().element()
    both_feet(robot, ["collision"], ("sphere", {"radius": "0.01"}, (0, 0, 0)))
    assert soles(robot, tmp_path)[0] == pytest.approx(SOLE)


def test_a_missing_visual_mesh_is_dropped_with_a_note(tmp_path):
    robot = SmallUrdf().element()
    mesh = ("mesh", {"filename": "package://small/none.stl"}, (0, 0, 0))
    both_feet(robot, ["visual"], mesh)
    sole, notes = soles(robot, tmp_path)
    assert sole == pytest.approx(SOLE)
    assert any("1 meshes missing, first package://small/none.stl" in n for n in notes)


def test_a_mesh_that_mujoco_refuses_is_dropped_with_a_note(tmp_path):
    (tmp_path / "flat.obj").write_text("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")
    robot = SmallUrdf().element()
    both_feet(robot, ["visual"], ("mesh", {"filename": "flat.obj"}, (0, 0, 0)))
    read = raw(robot, tmp_path)
    assert read.model.nmesh == 0
    assert read.prepared.spec.copy().compile().nmesh == 0
    assert any("flat.obj left out" in note for note in read.notes)


def test_a_stated_sole_is_relative_to_the_foot_link(tmp_path):
    sole = {"front": 0.07, "back": -0.05, "left": 0.02, "right": -0.03, "height": -0.015}
    # The link of the foot is 3 cm below its body, the ankle.
    edges, _ = soles(SmallUrdf(seed=1).element(), tmp_path, sole=sole)
    assert edges == pytest.approx((0.07, -0.05, 0.08, 0.03, -0.445))


@pytest.mark.parametrize("names", [("l_pad", "r_pad"), ("l_foot", "r_foot")])
def test_a_stated_shape_or_link(names, tmp_path):
    robot = SmallUrdf().element()
    for side in "lr":
        shape = SubElement(link(robot, f"{side}_foot"), "collision", name=f"{side}_pad")
        SubElement(SubElement(shape, "geometry"), "box", size="0.1 0.06 0.02")
    edges, _ = soles(robot, tmp_path, sole=names)
    assert edges == pytest.approx((0.05, -0.05, 0.09, 0.03, -0.44) if names[0] == "l_pad" else SOLE)


@pytest.mark.parametrize("difference", [0.001, 0.01])
def test_soles_that_differ_are_averaged(difference, tmp_path):
    robot = SmallUrdf().element()
    box = {"size": f"{0.16 + 2.0 * difference} 0.08 0.02"}
    replace_shapes(robot, "r", ["collision"], ("box", box, (0.02, -0.005, 0.0)))
    edges, notes = soles(robot, tmp_path)
    mean = 0.5 * difference
    assert edges == pytest.approx((0.10 + mean, -0.06 - mean, *SOLE[2:]))
    noted = [text for text in notes if text.startswith("soles differ")]
    assert len(noted) == int(difference > 0.002)


def test_a_foot_that_is_not_flat_is_reported(tmp_path):
    robot = SmallUrdf().element()
    both_feet(
        robot,
        ["collision"],
        ("box", {"size": "0.16 0.08 0.02"}, (0.02, 0, 0.01)),
        ("box", {"size": "0.03 0.03 0.02"}, (0, 0, 0)),
    )
    _, notes = soles(robot, tmp_path)
    assert any(
        "the sole of 'l_ankle_roll_link' covers 7% of the foot's outline" in n for n in notes
    )


def test_the_minimum_sole_scales_with_the_robot(tmp_path):
    """4 % of a leg of 0.40 m."""
    robot = SmallUrdf().element()
    for width, accepted in (("0.017", True), ("0.015", False)):
        both_feet(robot, ["collision"], ("box", {"size": f"0.1 {width} 0.02"}, (0, 0, 0)))
        both_feet(robot, ["visual"])
        if accepted:
            assert soles(robot, tmp_path)[0][3] == pytest.approx(0.06 - 0.5 * float(width))
        else:
            with pytest.raises(ModelError, match=r"too small .* expected at least 16 mm"):
                soles(robot, tmp_path)
