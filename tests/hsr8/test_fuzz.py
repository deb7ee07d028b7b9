"""Random bad input works or is refused with a message, in a short time."""

import random
import shutil

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hsr8.cli.main import entry
from hsr8.errors import ScenarioError, UsageError
from hsr8.scenario.layers import BUILT_IN, built_in_names
from hsr8.scenario.loader import load_scenario, loads
from hsr8.simulation.loop import Simulation
from tests.hsr8.bad_input import keys, mutated, near, value, written
from vision.color import load_table
from vision.errors import VisionError

SCHEMA = keys()


def text_case(rng):
    """Load a built-in scenario with damaged text."""
    name = rng.choice(built_in_names())
    raw = mutated(rng, (BUILT_IN / f"{name}.toml").read_bytes())
    loads(raw.decode("utf-8", errors="replace"), name)


def table_case(rng):
    """Load a built-in scenario with some keys near their limits."""
    chosen = rng.sample(SCHEMA, rng.randrange(1, 4))
    words = [f"{key}={written(near(rng, node))}" for key, node in chosen]
    load_scenario(rng.choice(built_in_names()), words)


def setting_case(rng):
    """Load a scenario with a damaged ``--set``."""
    key = rng.choice(SCHEMA)[0]
    word = f"{key}={written(value(rng))}"
    if rng.random() < 0.7:
        word = mutated(rng, word.encode()).decode("utf-8", errors="replace")
    load_scenario(rng.choice(built_in_names()), (word,))


def outcomes(case, numbers):
    """Return the results of some cases: valid or refused."""
    results = set()
    for number in numbers:
        try:
            case(random.Random(number))
            results.add("valid")
        except UsageError as error:
            results.add("refused" if str(error).strip() else f"case {number} without a message")
        except BaseException as error:
            error.add_note(f"case {number}")
            raise
    return results


@pytest.mark.parametrize("case", [text_case, table_case, setting_case])
def test_any_input_is_used_or_refused(case):
    assert outcomes(case, range(100)) == {"valid", "refused"}


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A run folder as a kill leaves it."""
    out = tmp_path_factory.mktemp("fuzz")
    words = ["run", "quick", "--body", "kinematic", "--camera", "analytic", "--quiet"]
    more = ["--duration", "1.2", "--out", str(out)]
    assert entry([*words, *more]) == 1
    (folder,) = (out / "quick").iterdir()
    manifest = (folder / "manifest.json").read_text()
    (folder / "manifest.json").write_text(manifest.replace('"timeout"', '"running"'))
    return folder


NUMBERS = [
    key for key, node in SCHEMA if node.get("type") in ("number", "integer") and key != "seed"
]


@settings(max_examples=100)
@given(
    key=st.sampled_from(NUMBERS),
    value=st.sampled_from(["1e300", "-1e300", "9223372036854775807", "nan"]),
)
def test_every_number_has_bounds(key, value):
    with pytest.raises(ScenarioError, match=key.split(".")[-1]):
        load_scenario("quick", (f"{key}={value}",))


@pytest.mark.parametrize(
    "setting",
    ["robot.speed.vx=1e-5"],
)
def test_small_values_of_unbounded_cost_are_refused(setting):
    with pytest.raises(ScenarioError, match=setting.split("=")[0]):
        load_scenario("quick", (setting,))


@pytest.mark.parametrize(
    "setting",
    [
        "walking.gait.min_footstep_time=10.0",
        "navigation.gaze.max_pan=0.01",
    ],
)
def test_a_run_works_at_the_limits(setting):
    scenario = load_scenario(
        "course", ['robot.body="kinematic"', 'camera.source="analytic"', setting]
    )
    with Simulation(scenario, 1) as simulation:
        for _ in range(100):
            simulation.step()
    assert np.isfinite(simulation._robot.frame.belief.pose).all()


@pytest.mark.parametrize("name", ["../x.toml", "x.toml\x00"])
def test_a_scenario_extends_nothing_outside_its_folder(name):
    with pytest.raises(ScenarioError):
        loads(f"extends = '{name}'" if "\x00" not in name else 'extends = "x.toml\\u0000"')


def test_a_color_table_runs_no_code(tmp_path):
    code = tmp_path / "code.npz"
    np.savez(code, labels=np.array([print], object), names=np.array(["red"]))
    with pytest.raises(VisionError, match="not a colour table"):
        load_table(code)


@pytest.mark.parametrize("words", [["verify"]])
def test_a_key_of_another_version_is_reported_with_both_versions(run, tmp_path, capfd, words):
    copy = tmp_path / "copy"
    shutil.copytree(run, copy)
    file = copy / "scenario.toml"
    file.write_text(file.read_text().replace("footstep_time", "step_time"))
    assert entry([*words, str(copy)]) == 2
    error = capfd.readouterr().err
    assert "walking.gait.step_time: unknown key" in error
    assert "was made by hsr8 0." in error
    assert "this is hsr8 0." in error
