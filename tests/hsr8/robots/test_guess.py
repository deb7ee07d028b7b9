"""The guess finds the parts of a robot by its kinematic tree, whatever their names."""

from itertools import permutations
from xml.etree import ElementTree

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from hsr8.robots.inspection import inspect
from hsr8.robots.parts.guess import guess
from tests.hsr8.robots.robot_parts import (
    ICUB,
    MENAGERIE,
    add_toes,
    checked_roles,
    compiled,
    described,
    installed,
    model_file,
    part,
    raw,
    removing,
    setting,
)
from tests.hsr8.robots.small_humanoid import SmallHumanoid
from tests.hsr8.robots.small_urdf import SmallUrdf, write

ROOTS = [(0, 0, 0), (0, 0, 180), (90, 0, 0), (0, 90, 90)]  # turns of a root link [deg]
HIPS = ["".join(order) for order in permutations("yrp")]
LETTERS = {"l": "b", "r": "a", "": "c"}  # in the wrong alphabetical order


def numbered(side, name):
    """Names that show neither the side nor the part."""
    return f"{LETTERS[side]}{sum(name.encode()) % 997}"


def spanish(side, name):
    return {"l": "izq_", "r": "der_", "": ""}[side] + numbered("", name)


def findings(robot, *changes):
    return {finding.role: finding for finding in guess(compiled(robot, *changes)).findings}


def in_frame(quat):
    """Turn the robot in its base, so that the directions of the base are others."""

    def change(root):
        base = part(root, "body", "base")
        inner = base.makeelement("body", {"name": "inner", "quat": quat})
        for child in list(base):
            if child.tag != "freejoint":
                base.remove(child)
                inner.append(child)
        base.append(inner)

    return change


@pytest.mark.parametrize("hip", HIPS)
@pytest.mark.parametrize("ankle", ["pr", "rp"])
@pytest.mark.parametrize("name", [numbered, spanish])
def test_parts_are_found_without_names_and_in_any_order(hip, ankle, name):
    robot = SmallHumanoid(hip=hip, ankle=ankle, name=name, offset=0.02, flip=True)
    roles = guess(compiled(robot))
    assert roles.feet == robot.feet()
    assert roles.legs == (tuple(robot.leg("l")), tuple(robot.leg("r")))
    assert roles.head == (name("", "head_yaw"), name("", "head_pitch"))
    assert roles.shoulders == (name("l", "shoulder_pitch"), name("r", "shoulder_pitch"))
    assert roles.camera == name("", "eye")
    assert {f.sureness for f in roles.findings} == {"certain"}


@pytest.mark.parametrize(
    "robot",
    [
        SmallHumanoid(),
        SmallHumanoid(waist="yrp", arm="rpyprp", oblique=0.6),
        SmallHumanoid(head="", arm=""),
        SmallHumanoid(head="y", actuator=""),
        SmallHumanoid(name=numbered, limited=False, actuator="motor"),
    ],
)
def test_the_guessed_description_is_accepted(robot):
    roles = guess(compiled(robot))
    keys = described(robot, **roles.keys())
    checked = checked_roles(raw(robot, keys), keys)
    assert (checked.base, checked.feet, checked.legs) == (roles.base, roles.feet, roles.legs)
    assert (checked.head, checked.shoulders) == (roles.head, roles.shoulders)


@pytest.mark.parametrize(
    ("quat", "forward"),
    [
        ("1 0 0 0", "+x"),
        ("0 0 0 1", "-x"),  # as iCub
        (".70710678 0 0 .70710678", "+y"),
        (".70710678 .70710678 0 0", "+x"),  # z of the base to the right
        (".5 .5 .5 .5", "+y"),  # y of the base forward, z to the left
        ("0 1 0 0", "+x"),  # upside down
    ],
)
def test_the_directions_of_the_root_are_arbitrary(quat, forward):
    robot = SmallHumanoid()
    roles = guess(compiled(robot, in_frame(quat)))
    assert roles.feet == robot.feet()
    assert roles.head == ("head_yaw", "head_pitch")
    assert {f.role: f for f in roles.findings}["forward"].part == f"{forward} of base"


BLIND = {"name": numbered, "limited": False}  # neither names nor ranges show the front


@pytest.mark.parametrize(
    ("robot", "changes", "sureness", "reason"),
    [
        (SmallHumanoid(limited=False), [in_frame("0 0 0 1")], "likely", "names of left and right"),
        (SmallHumanoid(name=numbered), [in_frame("0 0 0 1")], "likely", "knees bend forward"),
        (SmallHumanoid(**BLIND), [], "unsure", "feet are longer in front, x of the root"),
    ],
)
def test_the_front_follows_from_knees_names_or_feet(robot, changes, sureness, reason):
    forward = findings(robot, *changes)["forward"]
    assert forward.sureness == sureness
    assert forward.reason.startswith(reason)
    assert guess(compiled(robot, *changes)).feet == robot.feet()


@pytest.mark.parametrize("hip", HIPS[:2])
@pytest.mark.parametrize("ankle", ["pr"])
def test_toes_are_not_feet(hip, ankle):
    robot = SmallHumanoid(hip=hip, ankle=ankle)
    roles = guess(compiled(robot, add_toes(robot)))
    assert (roles.feet, roles.legs[0]) == (robot.feet(), tuple(robot.leg("l")))
    assert "without the toes beyond l_toe" in {f.role: f for f in roles.findings}["feet"].reason


def light_trunk(root):
    """A waist that carries arms but hardly a mass, and no head."""
    part(root, "body", "torso").find("inertial").set("mass", "0.01")
    part(root, "body", "waist_yaw_link").find("inertial").set("mass", "0.01")


@pytest.mark.parametrize("arm", ["prp", "p"])
def test_a_light_trunk_with_arms_is_not_a_head(arm):
    """Nor is an arm at the side of the waist a tilting head."""
    robot = SmallHumanoid(waist="y", head="", arm=arm)
    found = findings(robot, light_trunk)["head"]
    assert (found.part, found.sureness) == ("", "missing")


def add_back_legs(root):
    """Two more legs, as those of a quadruped."""
    base = part(root, "body", "base")
    for side in "lr":
        leg = ElementTree.fromstring(
            ElementTree.tostring(part(root, "body", f"{side}_hip_yaw_link"))
        )
        for element in leg.iter():
            if element.get("name"):
                element.set("name", f"back_{element.get('name')}")
        x, y, z = leg.get("pos").split()
        leg.set("pos", f"{float(x) - 0.3} {y} {z}")
        base.append(leg)


def ball_hips(root):
    for side in "lr":
        part(root, "joint", f"{side}_hip_yaw").attrib.update(type="ball")
        for key in ("axis", "range"):
            part(root, "joint", f"{side}_hip_yaw").attrib.pop(key)


def two_joints(root):
    for side in "lr":
        for name in ("hip_yaw", "hip_roll", "ankle_pitch", "ankle_roll"):
            removing("joint", f"{side}_{name}")(root)


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ([add_back_legs], "4 chains end lowest, at one height; expected two legs"),
        ([ball_hips], "joint 'l_hip_yaw' is a slide or ball joint; expected hinge joints: three"),
        ([two_joints], "the chains that end lowest have 2 hinge joints, of which 2 pitch"),
        (
            [setting("joint", "r_knee", axis="1 0 0")],
            "at 'l_ankle_roll' and 'r_ankle_roll', are not mirror images of each other",
        ),
    ],
)
def test_the_reason_why_there_are_no_legs_is_named(changes, reason):
    feet = findings(SmallHumanoid(actuator="", arm=""), *changes)["feet"]
    assert feet.sureness == "missing"
    assert reason in feet.reason


@pytest.mark.parametrize(
    ("robot", "role", "reason"),
    [
        (SmallHumanoid(head=""), "head", "no joint on the mid plane yaws a light upper part"),
        (SmallHumanoid(head="", waist="yp"), "head", "no joint on the mid plane"),
        (SmallHumanoid(head="y"), "head", "head_yaw yaws, but no joint pitches with it"),
        (SmallHumanoid(arm=""), "shoulders", "no mirrored chains above the hips"),
        (SmallHumanoid(arm="ryy"), "shoulders", "no pitching joint near l_shoulder_roll"),
        (SmallHumanoid(head=""), "camera", "the robot has none"),
    ],
)
def test_a_missing_part_has_its_reason(robot, role, reason):
    finding = findings(robot)[role]
    assert (finding.part, finding.sureness) == ("", "missing")
    assert reason in finding.reason
    assert getattr(guess(compiled(robot)), role) is None


@pytest.mark.parametrize("head", ["py", "yrp"])
def test_other_orders_of_the_neck_are_likely(head):
    roles = guess(compiled(SmallHumanoid(head=head)))
    assert roles.head == ("head_yaw", "head_pitch")
    assert {f.role: f for f in roles.findings}["head"].sureness == "likely"


@pytest.mark.parametrize(
    ("direction", "camera"),
    [("0 -1 0 0 0 1", "eye"), ("0 1 0 0 0 1", None), ("1 0 0 0 0 1", None)],
)
def test_only_a_camera_that_looks_forward_is_taken(direction, camera):
    assert guess(compiled(SmallHumanoid(), setting("camera", "eye", xyaxes=direction))).camera == (
        camera
    )


def test_arms_that_point_sideways_are_lowered():
    """A turn of the shoulder about x puts the arms level; the posture undoes it."""
    robot = SmallHumanoid(arm="rpp")
    turns = [
        setting("body", f"{side}_shoulder_roll_link", quat=f"0.70710678 {x}0.70710678 0 0")
        for side, x in (("l", ""), ("r", "-"))
    ]
    posture = guess(compiled(robot, *turns)).posture
    assert posture == {"l_shoulder_roll": -posture["r_shoulder_roll"], **posture}
    assert posture["l_shoulder_roll"] == pytest.approx(-np.pi / 2 + 0.25, abs=0.02)
    assert not guess(compiled(robot)).posture


TURNS = [Rotation.from_euler("xyz", angles, degrees=True) for angles in ROOTS]


@pytest.mark.parametrize("hip", ["yrp", "pry"])
@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("seed", [None, 3])
def test_the_parts_of_a_urdf_robot_are_found_in_any_frames(tmp_path, hip, turn, seed):
    robot = SmallUrdf(hip=hip, root=turn, seed=seed)
    inspection = inspect(str(write(robot.element(), tmp_path)))
    assert inspection.description.feet == ("l_ankle_roll_link", "r_ankle_roll_link")
    assert inspection.description.head == ("head_yaw", "head_pitch")
    assert inspection.description.shoulders == ("l_shoulder", "r_shoulder")


@pytest.mark.parametrize(
    "name",
    [
        "hsr8",
        pytest.param("icub", marks=ICUB),
        *(pytest.param(n, marks=MENAGERIE) for n in ("op3", "t1", "g1", "apollo", "berkeley")),
        *(pytest.param(n, marks=installed(n)) for n in ("jvrc1", "alexander", "talos", "gr3")),
    ],
)
def test_the_parts_of_the_shipped_robots_are_found(name):
    """Those that a description leaves out may be found."""
    stated = inspect(name).description
    guessed = inspect(str(model_file(name))).description
    feet = stated.feet if name != "icub" else ("l_ankle_2", "r_ankle_2")  # carries l_foot
    assert guessed.feet == feet
    assert stated.head in (None, guessed.head)
    assert guessed.shoulders == stated.shoulders
    if isinstance(stated.camera, str):
        assert guessed.camera == stated.camera
