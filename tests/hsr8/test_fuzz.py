"""Random bad input works or is refused with a message, in a short time."""

import random
import shutil
import time
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hsr8.cli.main import entry
from hsr8.errors import ScenarioError, SimulationDiverged, UsageError
from hsr8.loop import Simulation
from hsr8.robots.file import files
from hsr8.scenario.layers import BUILT_IN, built_in_names
from hsr8.scenario.loader import load_scenario, loads
from tests.hsr8.bad_input import keys, model_changed, mutated, near, value, written
from vision.color import COLOR_CLASSES, ColorTable, load_table, save_table
from vision.errors import VisionError

TICKS = 100  # of a run
MODEL_TICKS = 20  # of a run with a damaged model
MODELS = ("hsr8/hsr8.xml", "field/vision.xml")
LIMIT = 20.0  # processor time of a case [s]
SCHEMA = keys()


def text_case(rng, folder):
    """Load a built-in scenario with damaged text."""
    name = rng.choice(built_in_names())
    raw = mutated(rng, (BUILT_IN / f"{name}.toml").read_bytes())
    loads(raw.decode("utf-8", errors="replace"), name)


def table_case(rng, folder):
    """Load a built-in scenario with some keys near their limits."""
    chosen = rng.sample(SCHEMA, rng.randrange(1, 4))
    words = [f"{key}={written(near(rng, node))}" for key, node in chosen]
    load_scenario(rng.choice(built_in_names()), words)


def setting_case(rng, folder):
    """Load a scenario with a damaged ``--set``."""
    key = rng.choice(SCHEMA)[0]
    word = f"{key}={written(value(rng))}"
    if rng.random() < 0.7:
        word = mutated(rng, word.encode()).decode("utf-8", errors="replace")
    load_scenario(rng.choice(built_in_names()), (word,))


def start_case(rng, folder):
    """Run the first ticks with some keys near their limits."""
    words = ['camera.source="analytic"', "camera.width=64", "camera.height=48"]
    for key, node in rng.sample(SCHEMA, rng.randrange(1, 3)):
        words.append(f"{key}={written(near(rng, node))}")
    scenario = load_scenario(rng.choice(built_in_names()), words)
    if scenario.camera.source != "rendered":
        begin(scenario, rng.randrange(3), TICKS)


def model_case(rng, folder):
    """Run the first ticks with a damaged model of the robot or the field."""
    body = rng.choice(("full", "kinematic"))
    scenario = load_scenario("quick", (f'robot.body="{body}"', 'camera.source="analytic"'))
    copy = folder / "models"
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(files.models_dir(), copy)
    file = copy / rng.choice(MODELS)
    file.write_text(model_changed(rng, file.read_text(encoding="utf-8")), encoding="utf-8")
    with patch.object(files, "PACKAGE", folder / "hsr8"):
        begin(scenario, 0, MODEL_TICKS)


def colors_case(rng, folder):
    """Read a damaged colour table."""
    file = folder / "colors.npz"
    save_table(ColorTable(COLOR_CLASSES), file)
    file.write_bytes(mutated(rng, file.read_bytes()))
    load_table(file)


def begin(scenario, seed, ticks):
    """Run the first ticks of a scenario."""
    with Simulation(scenario, seed) as simulation:
        for _ in range(ticks):
            if simulation.exit_reason is None:
                simulation.step()


def outcomes(case, numbers, folder):
    """Return the results of some cases: valid or refused."""
    results = set()
    for number in numbers:
        began = time.process_time()
        try:
            case(random.Random(number), folder)
            results.add("valid")
        except (ScenarioError, SimulationDiverged, UsageError, VisionError) as error:
            results.add("refused" if str(error).strip() else f"case {number} without a message")
        except BaseException as error:
            error.add_note(f"case {number}")
            raise
        assert time.process_time() - began < LIMIT, f"case {number}"
    return results


@pytest.mark.parametrize(
    ("case", "count"),
    [
        (text_case, 700),
        (table_case, 700),
        (setting_case, 700),
        (model_case, 60),
        (colors_case, 100),
    ],
)
def test_any_input_is_used_or_refused(case, count, tmp_path):
    assert outcomes(case, range(count), tmp_path) == {"valid", "refused"}


@pytest.mark.slow
@pytest.mark.timeout(7200)
@pytest.mark.parametrize("case", [text_case, table_case, setting_case, start_case, model_case])
def test_any_input_is_used_or_refused_in_many_cases(case, tmp_path):
    count = 400 if case in (start_case, model_case) else 10_000
    assert outcomes(case, range(1000, 1000 + count), tmp_path) == {"valid", "refused"}


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
    ["robot.speed.vx=1e-5", "navigation.gaze.step=1e-9", "belief.local_map.cell=1e-8"],
)
def test_small_values_of_unbounded_cost_are_refused(setting):
    with pytest.raises(ScenarioError, match=setting.split("=")[0]):
        load_scenario("quick", (setting,))


@pytest.mark.parametrize(
    "setting",
    [
        "walking.gait.min_footstep_time=10.0",
        "walking.odometry.yaw_drift=1.0",
        "walking.odometry.lateral_noise=1.0",
        "navigation.gaze.step=7.0",
        "navigation.gaze.max_pan=0.01",
        "navigation.gaze.min_tilt=-2.0",
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


@pytest.mark.parametrize("name", ["../x.toml", "/etc/passwd", "a/b.toml", "..", "x.toml\x00"])
def test_a_scenario_extends_nothing_outside_its_folder(name):
    with pytest.raises(ScenarioError):
        loads(f"extends = '{name}'" if "\x00" not in name else 'extends = "x.toml\\u0000"')


def test_a_color_table_runs_no_code(tmp_path):
    code = tmp_path / "code.npz"
    np.savez(code, labels=np.array([print], object), names=np.array(["red"]))
    with pytest.raises(VisionError, match="not a colour table"):
        load_table(code)


@pytest.mark.parametrize("words", [["verify"], ["render"]])
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
