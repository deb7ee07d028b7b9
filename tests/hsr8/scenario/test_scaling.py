import json
from dataclasses import is_dataclass

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hsr8.errors import ModelError
from hsr8.robots.scale import RobotDefaults, RobotScale
from hsr8.scenario import loader
from hsr8.scenario.layers import built_in_names
from hsr8.scenario.loader import dump, load_scenario, loads
from hsr8.scenario.scaling import is_complete, scaled
from hsr8.scenario.schema import Scenario
from hsr8.scenario.section import Section
from navigation.parameters.navigation import NavigationParameters

SCALE = RobotScale(length=2.0, speed=1.5, turn=0.5, weight=8.0)
BIG = ["robot.model=big"]
ratio = st.floats(0.3, 3.0)
scales = st.builds(RobotScale, ratio, ratio, ratio, ratio)


@pytest.fixture
def defaults(monkeypatch):
    """Defaults of the robot "big"."""
    table = {"robot": {"radius": 0.3}, "navigation": {"gaze": {"max_pan": 1.0}}}
    given = RobotDefaults(SCALE, table)

    def robot_defaults(model):
        if model != "big":
            raise ModelError(f"unknown robot {model!r}")
        return given

    monkeypatch.setattr(loader, "robot_defaults", robot_defaults)
    return given


def leaves(value, path=()):
    """All values of nested tables and lists by path."""
    if isinstance(value, dict | list):
        items = value.items() if isinstance(value, dict) else enumerate(value)
        for key, inner in items:
            yield from leaves(inner, (*path, key))
    else:
        yield path, value


def table_of(scenario):
    return json.loads(scenario.model_dump_json(exclude_none=True))


@pytest.mark.parametrize("name", ["course", "corridor", "behind", "push", "fig4c"])
@settings(max_examples=2, deadline=None)
@given(scales)
def test_a_scale_and_its_inverse_cancel(name, scale):
    table = table_of(load_scenario(name))
    inverse = RobotScale(1 / scale.length, 1 / scale.speed, 1 / scale.turn, 1 / scale.weight)
    again = scaled(scaled(table, scale.factor), inverse.factor)
    for (path, value), (same, original) in zip(leaves(again), leaves(table), strict=True):
        assert path == same
        equal = isinstance(value, float)
        assert value == (pytest.approx(original, rel=1e-9) if equal else original), path


@pytest.mark.parametrize("name", built_in_names())
def test_the_scale_of_hsr_viii_changes_nothing(name):
    table = table_of(load_scenario(name))
    assert scaled(table, RobotScale().factor) == table
    assert is_complete(table)


@pytest.mark.parametrize(
    ("name", "profile"), [*((name, "extended") for name in built_in_names()), ("course", "paper")]
)
def test_a_built_in_scenario_with_all_its_defaults_is_scaled(monkeypatch, name, profile):
    monkeypatch.setattr(loader, "robot_defaults", lambda _: RobotDefaults(SCALE))
    words = [f"navigation.profile={profile}"]
    for_robot = table_of(load_scenario(name, [*BIG, *words]))
    expected = scaled(table_of(load_scenario(name, words)), SCALE.factor)
    expected["robot"]["model"] = "big"
    for (path, value), (same, wanted) in zip(leaves(for_robot), leaves(expected), strict=True):
        assert path == same
        assert value == (pytest.approx(wanted) if isinstance(wanted, float) else wanted), path


def test_values_of_a_user_are_literal_and_others_scaled(defaults, tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(
        'extends = "corridor"\n[world]\nlane = [0.5, 0.6]\n[robot]\nmodel = "big"\n'
        "[navigation.mission]\nr_release = 0.11\n"
    )
    scenario = load_scenario(
        str(file),
        ["navigation.mission.r_via=0.2", "mission.points.1=[3.0, 0.5]"],
        options={"--duration": {"duration": 7.0}},
        more={"--vary": ["belief.tracking.max_speed=0.9"]},
    )
    assert scenario.world.lane == (0.5, 0.6)
    assert scenario.navigation.mission.r_release == 0.11
    assert scenario.navigation.mission.r_via == 0.2
    assert scenario.duration == 7.0
    assert scenario.belief.tracking.max_speed == 0.9
    # The built-in scenario, with one entry of a list replaced, and defaults:
    assert scenario.world.size == (10.0, 4.0)
    assert scenario.mission.points == ((0.0, 0.0), (3.0, 0.5), (-4.0, 0.0))
    assert scenario.navigation.mission.r_goal == 0.1
    assert scenario.robot.speed.vx == pytest.approx(0.3)
    assert scenario.robot.speed.wz == pytest.approx(0.4)
    assert scenario.belief.tracking.forget_time == pytest.approx(25.0 * 2.0 / 1.5)
    assert scenario.world.scale == 2.0


def test_defaults_in_lists_and_optional_tables_are_scaled(defaults):
    scenario = load_scenario(
        "push",
        [
            *BIG,
            "world.obstacle=[{position=[1.0, 2.0]}]",
            'world.mover=[{motion="circle", centre=[-1.0, 1.0], path_radius=0.5}]',
            'fault=[{kind="bump", magnitude=0.01, position=[2.0, 2.0]}]',
        ],
    )
    assert scenario.world.obstacle[0].position == (1.0, 2.0)
    assert scenario.world.obstacle[0].radius == 0.16
    assert scenario.world.mover[0].path_radius == 0.5
    assert scenario.world.mover[0].speed == pytest.approx(0.15)
    assert scenario.fault[0].radius == 0.2
    assert scenario.fault[0].magnitude == 0.01
    factor = SCALE.factor("N s")
    assert scenario.disturbance.random.impulse == pytest.approx((0.3 * factor, 0.8 * factor))
    assert [stretch.vx for stretch in scenario.command.stretch[:2]] == pytest.approx([0.3, 0.225])


def test_the_table_of_a_robot_is_a_default(defaults):
    scenario = load_scenario("course", BIG)
    assert scenario.robot.radius == 0.3
    assert scenario.navigation.univector.s_robot == 0.3
    assert scenario.navigation.gaze.max_pan == 1.0
    paper = load_scenario("course", [*BIG, "navigation.profile=paper", "robot.radius=0.25"])
    assert paper.robot.radius == 0.25
    assert paper.navigation.univector.s_robot == 0.25
    assert paper.navigation.gaze.max_pan == 1.0
    usual = NavigationParameters.paper()
    assert paper.navigation.univector.margin == 2.0 * usual.univector.margin
    assert paper.navigation.planner.paper.d_e == 2.0 * usual.planner.paper.d_e


def test_the_camera_of_a_robot_takes_precedence_over_a_preset(monkeypatch):
    table = {"camera": {"vertical_fov_deg": 50.0}}
    monkeypatch.setattr(loader, "robot_defaults", lambda _: RobotDefaults(SCALE, table))
    assert load_scenario("course", BIG).camera.vertical_fov_deg == 50.0
    ideal = load_scenario("course", [*BIG, "camera.preset=ideal"]).camera
    assert (ideal.vertical_fov_deg, ideal.blind_above) == (50.0, 10_000.0)


@pytest.mark.parametrize("name", ["fig4b", "push"])
@pytest.mark.parametrize("more", [[], ["navigation.profile=paper", "world.scale=1.0"]])
def test_a_dump_is_complete_and_never_scaled_again(defaults, monkeypatch, name, more):
    scenario = load_scenario(name, [*BIG, *more, "navigation.evaluation.omega_o=20.0"])
    text = dump(scenario)
    assert scenario.navigation.evaluation.omega_o == 20.0  # the default for HSR-VIII
    monkeypatch.undo()  # the robot is unknown here
    assert loads(text) == scenario
    assert dump(loads(text)) == text


def test_a_dump_with_a_missing_key_is_completed_for_its_robot(defaults):
    scenario = load_scenario("course", BIG)
    lines = [a for a in dump(scenario).splitlines() if not a.startswith(("r_via", "omega_o "))]
    assert loads("\n".join(lines)) == scenario


def test_nested_defaults_are_those_of_their_section():
    """A section in another one has its own defaults, so that missing tables can be completed."""

    def check(section):
        for key, field in section.model_fields.items():
            default = field.get_default(call_default_factory=True)
            if isinstance(default, Section) or is_dataclass(default):
                assert default == type(default)(), key
            if isinstance(default, Section):
                check(type(default))

    check(Scenario)
