"""Location of the MJCF models, in a checkout or in an installed wheel."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hsr8.errors import ModelError

PACKAGE = Path(__file__).resolve().parents[1]


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
    """Context in which errors of model files become a `ModelError`.

    Args:
        source: file that is read, which begins the message; default: the models of hsr8.

    Raises:
        ModelError: a file is damaged, or lacks a required name.
    """
    try:
        yield
    except (ValueError, KeyError, SyntaxError) as error:  # SyntaxError: invalid XML
        reason = " ".join(str(error.args[0]).split())
        what = "invalid robot or field model" if source is None else "invalid robot model"
        raise ModelError(f"{source or models_dir()}: {what}: {reason}") from error
