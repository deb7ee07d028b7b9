"""Each mistake in a description file is one message that begins with the file and the key."""

import re
from xml.etree import ElementTree

import pytest

from hsr8.errors import ModelError
from hsr8.robots.file.description import read_description
from hsr8.robots.loaded import load_robot
from tests.hsr8.robots.small_humanoid import SmallHumanoid
from tests.hsr8.robots.small_urdf import FEET, SmallUrdf, write

SMALL = SmallHumanoid()
ANYWHERE = [  # also of a model that does not exist
    ("feet = 3", "feet: wrong value, got 3; expected a list"),
    ('feets = ["l", "r"]', "feets: unknown key; did you mean 'feet'?"),
    (
        "sole = {front = -1, back = 1, left = 1, right = -1, height = 0}",
        "sole: front edge not beyond the back edge, got front = -1, back = 1; expected front",
    ),
    ("servo.lag = 0", "servo.lag: wrong value, got 0; expected at least 0.001 and at most 1 s"),
    ("range = {l_knee = [2, 1]}", "range.l_knee: empty range, got [2.0, 1.0]; expected lower < up"),
    ('srdf = "a.srdf"', "state: missing, got srdf alone; expected both"),
    ('head = ["a", "b"]\nrigid = ["b"]', "rigid: joint 'b' is also in head; expected one key"),
    ('[posture]\nservo = "rule"', "'servo' is a key of the whole file: move it above the first ["),
]
IN_THE_MODEL = [
    ("zero = {l_kne = 0.1}", "zero: the model has no hinge joint 'l_kne'; did you mean 'l_knee'?"),
    ("posture = {l_knee = 0.5}", "posture.l_knee: a joint of the leg, which moves while walking"),
    ("posture = {head_yaw = 7.0}", "posture.head_yaw: outside the range of the joint, got 7 rad"),
    (
        "range = {l_hip_yaw = [1.2, 1.4], r_hip_yaw = [1.2, 1.4]}",
        "range.l_hip_yaw: the mirrored ranges of 'l_hip_yaw' and 'r_hip_yaw' have nothing in c",
    ),
    (
        "range = {l_hip_roll = [0.1, 0.7], r_hip_roll = [-0.7, -0.1]}",
        "range.l_hip_roll: the ready posture is outside, got 0.0",
    ),
    ("effort = {l_knee = 0.1}", "effort.l_knee: too weak to carry the robot on one leg"),
]


def mjcf(folder):
    text = ElementTree.tostring(SMALL.element(), encoding="unicode")
    (folder / "robot.xml").write_text(text)
    return "robot.xml", SMALL.feet()


def urdf(folder):
    return write(SmallUrdf().element(), folder).name, FEET


@pytest.fixture
def described(tmp_path):
    """Writes a description of a small robot with further lines."""

    def make(lines, kind=mjcf):
        model, (left, right) = kind(tmp_path)
        file = tmp_path / "robot.toml"
        feet = "" if lines.startswith("feet =") else f'feet = ["{left}", "{right}"]\n'
        file.write_text(f'model = "{model}"\n{feet}{lines}\n')
        return file

    return make


def message_of(action, file):
    with pytest.raises(ModelError) as caught:
        action(file)
    message = str(caught.value)
    assert caught.value.exit_code == 2
    assert "\n" not in message
    where, _, text = message.partition(": ")
    assert where.split(":")[0] == str(file)
    return text


@pytest.mark.parametrize(("lines", "expected"), ANYWHERE)
def test_a_wrong_value_is_one_message(described, lines, expected):
    assert expected in message_of(read_description, described(lines))


@pytest.mark.parametrize(("lines", "expected"), IN_THE_MODEL)
def test_a_name_that_the_model_lacks_is_one_message(described, lines, expected):
    file = described(lines)
    assert message_of(lambda f: load_robot(str(f)), file).startswith(expected)


def test_several_mistakes_are_listed(described):
    file = described('servo = {lag = 0, delay = 1}\nfeets = ["l"]')
    with pytest.raises(ModelError) as caught:
        read_description(file)
    first, *others = str(caught.value).splitlines()
    assert first == f"{file}: 3 mistakes"
    places = {tuple(line.split(": ")[:2]) for line in others}
    keys = [(3, "servo.lag"), (3, "servo.delay"), (4, "feets")]
    assert places == {(f"  {file}:{line}", key) for line, key in keys}


def test_rigid_joints_keep_the_angle_of_the_posture_and_lose_their_limits(described):
    lines = 'rigid = ["l_elbow_pitch", "l_elbow_pitch"]\n[effort]\nl_elbow_pitch = 3.0\n'
    names = SMALL.element().iter("joint")
    elbow = next(e.get("name") for e in names if e.get("name", "").startswith("l_elbow"))
    robot = load_robot(str(described(lines.replace("l_elbow_pitch", elbow))))
    assert elbow not in robot.model.names
    assert robot.spec.joint(elbow) is None


def test_a_state_of_the_whole_body_completes_the_posture(described, tmp_path):
    joints = "".join(f'<joint name="{name}" value="0.1"/>' for name in ("l_knee", "head_yaw"))
    (tmp_path / "a.srdf").write_text(
        f'<robot><group_state name="home" group="all">{joints}'
        '<joint name="finger" value="1"/></group_state></robot>'
    )
    lines = 'srdf = "a.srdf"\nstate = "home"\n'
    assert load_robot(str(described(lines, urdf))).description.posture == {"head_yaw": 0.1}


def test_joints_whose_range_excludes_zero_are_held_inside_it(described):
    joint = "l_shoulder_pitch"
    robot = load_robot(str(described(f"range = {{{joint} = [1.0, 2.0]}}")))
    assert robot.description.posture == {joint: pytest.approx(1.02)}
    assert f"posture: {joint!r} 0.000 -> 1.020 rad, within its range" in robot.notes


def test_a_limit_of_the_model_is_not_blamed_on_a_key(described, tmp_path):
    """The number of the message is enough, although it is rounded."""
    file = described("", urdf)
    model = tmp_path / "small.urdf"
    root = ElementTree.fromstring(model.read_text())
    knee = next(e for e in root.iter("joint") if e.get("name") == "l_knee")
    knee.find("limit").set("effort", "0.1")
    model.write_text(ElementTree.tostring(root, encoding="unicode"))
    with pytest.raises(ModelError, match=r"small\.urdf: joint 'l_knee': too weak") as caught:
        load_robot(str(file))
    needed = re.search(r"expected at least ([0-9.]+): state effort", str(caught.value))[1]
    assert load_robot(str(described(f"effort = {{l_knee = {needed}}}", urdf)))
