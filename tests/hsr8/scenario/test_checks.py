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
        (
            COURSE + "[navigation.mission]\nr_goal = 0.09",
            "navigation.mission.r_goal: must be at most r_release = 0.08, got 0.09",
        ),
        (
            COURSE + "[navigation.evaluation]\nd_nm = 1.5",
            "navigation.evaluation.d_nm: must be at most d_fm = 1.3, got 1.5",
        ),
        (COURSE + '[camera]\nsource = "neck-reach"', 'requires navigation.gaze.mode = "fixed"'),
        (COURSE + "[camera]\nshutter_ms = 80", "is longer than period_ms = 60"),
        (
            'mission = {kind = "tour"}\n[criteria]\ngoal_reached = true',
            'criteria.goal_reached: a mission of kind "tour" has no goal',
        ),
        (
            'mission = {kind = "points", points = [[0, 0], [1, 1]], endless = true}\n'
            "[criteria]\ngoal_reached = true",
            "criteria.goal_reached: an endless mission has no goal",
        ),
        (
            'mission = {kind = "points", points = [[0, 0], [1, 1]]}\n'
            "[criteria]\nmin_via_points = 2",
            "points before the goal, 1, got 2",
        ),
        (COURSE + "[criteria]\nmin_via_points = 5", "points before the goal, 4, got 5"),
        (
            COURSE
            + "[robot.start]\nposition = [0.0, 0.0]\n"
            + "[[world.obstacle]]\nposition = [0.1, 0.0]",
            "position: must be at least 0.2 m from robot.start.position = [0.0, 0.0]",
        ),
        (
            COURSE
            + "[robot.start]\nposition = [0.5, 0.0]\n"
            + '[[world.mover]]\nmotion = "circle"\ncentre = [0.0, 0.0]\npath_radius = 0.6',
            "world.mover[0].centre: begins at the start of the robot",
        ),
        (COURSE + "[[world.obstacle]]\nposition = [9.0, 0.0]", "is outside the field"),
        (
            COURSE
            + "[robot.start]\nposition = [0.5, 0.1]\n"
            + "[[world.wall]]\nstart = [-1.0, 0.0]\nend = [1.0, 0.0]",
            "world.wall[0]: must be at least 0.24 m from robot.start.position",
        ),
        (
            'mission = {kind = "points", points = [[0.0, 0.9]]}\n'
            "[[world.wall]]\nstart = [0.0, 0.0]\nend = [0.0, 2.0]",
            "world.wall[0]: must be at least 0.24 m from mission.points[0]",
        ),
        (
            COURSE + "[[world.wall]]\nstart = [0.0, 0.0]\nend = [0.0, 2.6]",
            "world.wall[0].end: [0.0, 2.6] is outside the field",
        ),
        (
            COURSE + "[[world.wall]]\nstart = [0.0, 0.0]\nend = [0.0, 2.0]\ngap = 0.3",
            "world.wall[0].gap",
        ),
        (
            'mission = {kind = "walk"}\n[command]\nvx = 0.1\n[world.encounters]\nn = 2',
            "has no route to encounter on",
        ),
        (
            COURSE + '[[world.mover]]\nmotion = "shuttle"\nstart = [0, 0]\nend = [0, 0]',
            "must differ from start",
        ),
        (
            'mission = {kind = "points", points = [[1.0, 1.0]]}\n'
            "[[world.obstacle]]\nposition = [1.0, 1.1]",
            "must be at least 0.2 m from mission.points[0] = [1.0, 1.0]",
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
        ("walk", "command.footstep={forward=0.05, lift=1}", "expected one of single_support"),
        ("walk", "command.random.vx=[0.3, 0.1]", "the first bound must not be above the second"),
        ("walk", "command.stretch=[]", "command: is missing; expected vx"),
        ("course", "command.vx=0.1", 'requires mission.kind = "walk"'),
        ("walk", 'fault=[{kind="push"}]', "fault[0].magnitude: missing"),
        ("walk", 'fault=[{kind="push",start=99,magnitude=1}]', "must be before the end of the run"),
        ("walk", 'fault=[{kind="push",magnitude=1,body="torso"}]', "did you mean"),
        ("walk", "disturbance.push=[{time=1, impulse=1}]", "expected one of random"),
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
