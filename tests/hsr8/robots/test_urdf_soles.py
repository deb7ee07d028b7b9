"""Soles come from the description or the shapes of the feet, and are mirror images."""

from xml.etree.ElementTree import SubElement

import pytest

from hsr8.robots.urdf import convert
from tests.hsr8.robots.mesh_files import FORMATS, write_mesh
from tests.hsr8.robots.small_urdf import SmallUrdf, describe, link, write

SOLE = (0.10, -0.06, 0.045, -0.035, -0.04)


def converted(robot, folder, **keys):
    return convert(write(robot, folder), describe(**keys), folder)


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


def test_spheres_below_the_corners(tmp_path):
    robot = SmallUrdf().element()
    corners = [(x, y, 0.0) for x in (-0.05, 0.08) for y in (-0.03, 0.03)]
    both_feet(robot, ["collision"], *(("sphere", {"radius": "0.01"}, c) for c in corners))
    assert converted(robot, tmp_path).soles[0] == pytest.approx((0.08, -0.05, 0.03, -0.03, -0.04))


def test_an_upright_cylinder(tmp_path):
    robot = SmallUrdf().element()
    both_feet(robot, ["collision"], ("cylinder", {"radius": "0.05", "length": "0.02"}, (0, 0, 0)))
    sole = converted(robot, tmp_path).soles[0]
    assert sole == pytest.approx((0.05, -0.05, 0.05, -0.05, -0.04), abs=1e-9)


@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.parametrize("scale", ["1 1 1", "0.5 1 1"])
def test_a_mesh_of_any_format(name, scale, tmp_path):
    write_mesh(tmp_path, name)
    robot = SmallUrdf().element()
    mesh = ("mesh", {"filename": f"package://small/{name}", "scale": scale}, (0, 0, -0.01))
    both_feet(robot, ["collision", "visual"], mesh)
    robot_file = converted(robot, tmp_path)
    length = 0.08 * float(scale.split()[0])
    assert robot_file.soles[0] == pytest.approx((length, -length, 0.04, -0.04, -0.04), abs=1e-6)
    assert robot_file.spec.compile().nmesh == 1


def test_visual_shapes_where_the_others_make_no_flat_sole(tmp_path):
    robot = SmallUrdf().element()
    both_feet(robot, ["collision"], ("sphere", {"radius": "0.01"}, (0, 0, 0)))
    result = converted(robot, tmp_path)
    assert result.soles[0] == pytest.approx(SOLE)
    assert any("from its visual shapes" in note for note in result.notes)


def test_a_missing_visual_mesh_is_dropped_with_a_note(tmp_path):
    robot = SmallUrdf().element()
    mesh = ("mesh", {"filename": "package://small/none.stl"}, (0, 0, 0))
    both_feet(robot, ["visual"], mesh)
    result = converted(robot, tmp_path)
    assert result.soles[0] == pytest.approx(SOLE)
    assert any("1 meshes not found, first package://small/none.stl" in n for n in result.notes)


def test_a_mesh_that_mujoco_refuses_is_dropped_with_a_note(tmp_path):
    (tmp_path / "flat.obj").write_text("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")
    robot = SmallUrdf().element()
    both_feet(robot, ["visual"], ("mesh", {"filename": "flat.obj"}, (0, 0, 0)))
    result = converted(robot, tmp_path)
    assert result.spec.compile().nmesh == 0
    assert any("flat.obj left out" in note for note in result.notes)


def test_a_stated_sole_is_relative_to_the_foot_link(tmp_path):
    sole = {"front": 0.07, "back": -0.05, "left": 0.02, "right": -0.03, "height": -0.015}
    result = converted(SmallUrdf(seed=1).element(), tmp_path, sole=sole)
    # The link of the foot is 3 cm below its body, the ankle.
    assert result.soles[0] == pytest.approx((0.07, -0.05, 0.02, -0.03, -0.045))
    assert result.soles[1] == pytest.approx((0.07, -0.05, 0.03, -0.02, -0.045))
    assert result.description.sole is None


def test_a_stated_shape(tmp_path):
    robot = SmallUrdf().element()
    for side in "lr":
        shape = SubElement(link(robot, f"{side}_foot"), "collision", name=f"{side}_pad")
        SubElement(SubElement(shape, "geometry"), "box", size="0.1 0.06 0.02")
    result = converted(robot, tmp_path, sole=["l_pad", "r_pad"])
    assert result.soles[0] == pytest.approx((0.05, -0.05, 0.03, -0.03, -0.04))


@pytest.mark.parametrize(
    ("difference", "note"),
    [(0.0, None), (0.001, "soles differ by 1.0 mm"), (0.01, "warning: soles differ by 10.0 mm")],
)
def test_soles_that_differ_are_averaged(difference, note, tmp_path):
    robot = SmallUrdf().element()
    box = {"size": f"{0.16 + 2.0 * difference} 0.08 0.02"}
    replace_shapes(robot, "r", ["collision"], ("box", box, (0.02, -0.005, 0.0)))
    result = converted(robot, tmp_path)
    mean = 0.5 * difference
    assert result.soles[0] == pytest.approx((0.10 + mean, -0.06 - mean, *SOLE[2:]))
    assert result.soles[1] == pytest.approx(result.soles[0].mirrored())
    notes = [text for text in result.notes if "differ" in text]
    assert (notes == []) if note is None else notes[0].startswith(note)


def test_a_foot_that_is_not_flat_is_reported(tmp_path):
    robot = SmallUrdf().element()
    both_feet(
        robot,
        ["collision"],
        ("box", {"size": "0.16 0.08 0.02"}, (0.02, 0, 0.01)),
        ("box", {"size": "0.03 0.03 0.02"}, (0, 0, 0)),
    )
    notes = converted(robot, tmp_path).notes
    assert any(note.startswith("warning: the sole of 'l_foot' covers 7 %") for note in notes)
