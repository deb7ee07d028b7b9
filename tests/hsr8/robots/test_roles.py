from itertools import permutations

import pytest

from hsr8.errors import ModelError
from tests.hsr8.robots.robot_parts import (
    MENAGERIE,
    checked_roles,
    described,
    raw,
    shipped,
)
from tests.hsr8.robots.small_humanoid import SmallHumanoid

HIPS = ["".join(order) for order in permutations("yrp")]


@pytest.mark.parametrize("hip", HIPS)
@pytest.mark.parametrize("ankle", ["pr", "rp"])
@pytest.mark.parametrize("flip", [False, True])
def test_legs_are_the_last_six_hinges_in_any_order(hip, ankle, flip):
    robot = SmallHumanoid(hip=hip, ankle=ankle, flip=flip, offset=0.02, waist="yp")
    roles = checked_roles(raw(robot, described(robot)), described(robot))
    assert roles.legs == (tuple(robot.leg("l")), tuple(robot.leg("r")))
    assert (roles.base, roles.feet, roles.trunk) == ("base", robot.feet(), "base")


@pytest.mark.parametrize("oblique", [-0.7, 0.3, 0.7])
def test_oblique_hips_are_accepted(oblique):
    robot = SmallHumanoid(oblique=oblique)
    checked_roles(raw(robot, described(robot)), described(robot))


def test_joints_above_the_hips_do_not_belong_to_the_legs():
    """A base that carries the legs on a waist, as Booster T1."""
    robot = SmallHumanoid()
    lower = robot.element()
    base = next(e for e in lower.iter("body") if e.get("name") == "base")
    joint = {"name": "waist", "axis": "0 0 1", "range": "-1 1"}
    waist = base.makeelement("body", {"name": "hips"})
    waist.append(
        base.makeelement("inertial", {"pos": "0 0 0", "mass": "1", "diaginertia": "1 1 1"})
    )
    waist.insert(0, base.makeelement("joint", joint))
    for leg in [e for e in base if "hip" in e.get("name", "")]:
        base.remove(leg)
        waist.append(leg)
    base.append(waist)
    keys = described(robot, servo="rule")
    model = raw(robot, keys, lambda root: root.__setitem__(slice(None), list(lower)))
    roles = checked_roles(model, keys)
    assert roles.legs == (tuple(robot.leg("l")), tuple(robot.leg("r")))


@pytest.mark.parametrize(
    ("keys", "trunk"),
    [
        ({}, "base"),
        ({"head": ("head_yaw", "head_pitch")}, "torso"),
        ({"shoulders": ("l_shoulder_pitch", "r_shoulder_pitch")}, "torso"),
    ],
)
def test_the_trunk_carries_shoulders_or_head(keys, trunk):
    robot = SmallHumanoid(waist="yrp")
    keyed = described(robot, **keys)
    roles = checked_roles(raw(robot, keyed), keyed)
    assert roles.trunk == trunk
    assert (roles.head, roles.shoulders) == (keys.get("head"), keys.get("shoulders"))


@pytest.mark.parametrize("parts", [{"head": "", "arm": ""}, {"arm": "p"}, {"arm": "rpyprp"}])
def test_head_and_arms_are_optional(parts):
    robot = SmallHumanoid(**parts)
    checked_roles(raw(robot, described(robot)), described(robot))


def test_six_joints_of_which_one_is_a_common_waist_are_refused():
    """Five joints per leg below a waist are not six."""
    robot = SmallHumanoid(hip="rp", waist="")
    root = robot.element()
    base = next(e for e in root.iter("body") if e.get("name") == "base")
    base.insert(1, base.makeelement("joint", {"name": "waist", "axis": "0 0 1"}))
    outer = base.makeelement("body", {"name": "pelvis"})
    outer.append(base.makeelement("freejoint", {"name": "root"}))
    outer.append(
        base.makeelement("inertial", {"pos": "0 0 0", "mass": "1", "diaginertia": "1 1 1"})
    )
    base.remove(base.find("freejoint"))
    world = root.find("worldbody")
    world.remove(base)
    outer.append(base)
    world.append(outer)
    keys = described(robot)
    model = raw(robot, keys, lambda other: other.__setitem__(slice(None), list(root)))
    with pytest.raises(ModelError, match="5 hinge joints that it does not have in common"):
        checked_roles(model, keys)


@MENAGERIE
@pytest.mark.parametrize("name", ["op3", "t1", "g1", "apollo", "berkeley"])
def test_the_robots_of_the_menagerie_are_accepted(name):
    checked_roles(*shipped(name))


def test_the_default_robot_is_accepted():
    roles = checked_roles(*shipped("hsr8"))
    assert roles.trunk == "torso_link"
