"""Files of robots: the folder of the MJCF models, packages, meshes and included parts."""

import hashlib
import os
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from xml.etree import ElementTree

from hsr8.errors import ModelError
from hsr8.robots.file.key_mistake import KeyMistake

PACKAGE = Path(__file__).resolve().parents[2]


def models_dir() -> Path:
    """Return the folder with ``hsr8/hsr8.xml`` and ``field/``.

    Raises:
        ModelError: the installation is incomplete.
    """
    folders = (PACKAGE / "_models", PACKAGE.parent / "models")
    for folder in folders:
        if (folder / "hsr8" / "hsr8.xml").is_file():
            return folder
    raise ModelError(
        f"hsr8/hsr8.xml: missing in {' and '.join(map(str, folders))}; install hsr8 again"
    )


@contextmanager
def reading_models(source: str | None = None) -> Iterator[None]:
    """Context in which errors of model files become a `ModelError`, without further warnings.

    Args:
        source: file that is read, which begins the message; default: the models of hsr8.

    Raises:
        ModelError: a file is damaged, or lacks a required name.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # MuJoCo's, about models that are checked here
            yield
    except (ValueError, KeyError, SyntaxError) as error:  # SyntaxError: invalid XML
        reason = " ".join(str(error.args[0]).split())
        what = "invalid robot or field model" if source is None else "invalid robot model"
        raise ModelError(f"{source or models_dir()}: {what}: {reason}") from error


def package_folders(packages: Mapping[str, str], folder: Path) -> dict[str, Path]:
    """Folder of each package of a description; relative ones are next to its file.

    Raises:
        KeyMistake: a folder does not exist.
    """
    folders = {name: folder / os.path.expanduser(text) for name, text in packages.items()}
    for name, path in folders.items():
        if not os.path.isdir(path):
            raise KeyMistake(
                f"packages.{name}: not a folder, got '{path}'; expected the package's folder"
            )
    return folders


def find_mesh(uri: str, urdf: Path, packages: Mapping[str, Path]) -> Path | None:
    """Find the file of a mesh.

    ``package://NAME/FILE`` is searched in the folder of the package if it is known, else as
    ``NAME/FILE``, then as ``FILE``, in every folder from that of the URDF file upwards; paths
    without a scheme as they are.

    Args:
        uri: address of the mesh.
        urdf: file that names it.
        packages: known folders.

    Returns:
        Its path, or None if the file does not exist.
    """
    scheme, _, rest = uri.rpartition("://")
    name, _, tail = rest.partition("/")
    if scheme in ("package", "model") and name in packages:
        candidates = [packages[name] / tail]
    else:
        tails = (rest, tail) if scheme in ("package", "model") else (rest,)
        folders = list(urdf.resolve().parents)
        candidates = [folder / text for text in tails if text for folder in folders]
    return next((path for path in candidates if path.is_file()), None)


def files_of(model: Path, packages: Mapping[str, Path]) -> Iterator[Path]:
    """Yield a model file, and the files that it includes or refers to and that exist.

    Args:
        model: MJCF or URDF file.
        packages: folders of the packages that a URDF file names.
    """
    if model.suffix.lower() == ".urdf":
        yield model
        yield from _meshes_of(model, packages)
        return
    import mujoco  # noqa: PLC0415 (loads slowly)

    try:
        names = mujoco.mju_getXMLDependencies(str(model))
    except mujoco.FatalError:  # reading the file reports the reason
        names = [str(model)]
    yield from (path for path in map(Path, sorted(names)) if path.is_file())


def _meshes_of(urdf: Path, packages: Mapping[str, Path]) -> Iterator[Path]:
    """Yield the mesh files of a URDF file that exist."""
    try:
        robot = ElementTree.fromstring(urdf.read_bytes())
    except (OSError, ValueError, ElementTree.ParseError):
        return  # reading it reports the reason
    uris = dict.fromkeys(mesh.get("filename", "") for mesh in robot.iter("mesh"))
    yield from (path for uri in uris if (path := find_mesh(uri, urdf, packages)))


def digest_of(files: Iterator[Path]) -> str:
    """Return the first 12 digits of the SHA-256 of some files."""
    digest = hashlib.sha256()
    for file in files:
        digest.update(file.read_bytes())
    return digest.hexdigest()[:12]


def stamp_of(files: Iterator[Path]) -> tuple[tuple[str, int, int], ...]:
    """Return names, times of change and sizes of some files, which differ when a file changes."""
    stats = ((str(file), file.stat()) for file in files if file.is_file())
    return tuple((name, stat.st_mtime_ns, stat.st_size) for name, stat in stats)
