import pytest

from hsr8.errors import ScenarioError
from hsr8.scenario.loader import load_scenario, loads

COURSE = 'mission = {kind = "course"}\n'


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (COURSE + "[robot.speed]\nvx = 0.9", "walking.limits.vx"),
        (
            COURSE + "[belief.local_map]\ncell = 0.005",
            "must be at least size / 1000 = 0.006, got 0.005",
        ),
        (COURSE + '[camera]\nsource = "neck-reach"', 'requires navigation.gaze.mode = "fixed"'),
        (COURSE + "[camera]\nshutter_ms = 80", "is longer than period_ms = 60"),
        (
            'mission = {kind = "tour"}\n[criteria]\ngoal_reached = true',
            'criteria.goal_reached: a mission of kind "tour" has no goal',
        ),
        (
            'mission = {kind = "points", points = [[0, 0], [1, 1]]}\n'
            "[criteria]\nmin_via_points = 2",
            "points before the goal, 1, got 2",
        ),
        (
            COURSE
            + "[robot.start]\nposition = [0.0, 0.0]\n"
            + "[[world.obstacle]]\nposition = [0.1, 0.0]",
            "position: must be at least 0.2 m from robot.start.position = [0.0, 0.0]",
        ),
        (COURSE + "[[world.obstacle]]\nposition = [9.0, 0.0]", "is outside the field"),
        (
            COURSE
            + "[robot.start]\nposition = [0.5, 0.1]\n"
            + "[[world.wall]]\nstart = [-1.0, 0.0]\nend = [1.0, 0.0]",
            "world.wall[0]: must be at least 0.24 m from robot.start.position",
        ),
        (
            'mission = {kind = "walk"}\n[command]\nvx = 0.1\n[world.encounters]\nn = 2',
            "has no route to encounter on",
        ),
    ],
)
def test_contradicting_keys_are_reported_with_their_line(text, expected):
    with pytest.raises(ScenarioError) as caught:
        loads(text, "file.toml")
    (line,) = str(caught.value).splitlines()[1:]
    assert expected in line
    assert line.startswith("  file.toml:")


@pytest.mark.parametrize(
    ("name", "override", "expected"),
    [
        ("walk", "command.vz=0.1", "expected one of vx, vy, wz"),
        ("walk", "command.vx=6", "expected at least -5 and at most 5 m/s"),
        ("course", "command.vx=0.1", 'requires mission.kind = "walk"'),
        ("walk", 'fault=[{kind="push",magnitude=1,body="torso"}]', "did you mean"),
    ],
)
def test_wrong_commands_and_pushes_are_reported_with_their_key(name, override, expected):
    with pytest.raises(ScenarioError) as caught:
        load_scenario(name, [override])
    assert expected in str(caught.value)
    assert override.partition("=")[0].split(".")[0] in str(caught.value)


def test_a_body_without_dynamics_cannot_be_pushed():
    push = "disturbance.random={}"
    assert load_scenario("walk", [push]).disturbance.random.impulse == (0.2, 0.8)
    with pytest.raises(ScenarioError, match=r"requires robot\.body"):
        load_scenario("walk", [push, "robot.body=kinematic"])
