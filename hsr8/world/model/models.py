"""Where the MJCF models lie, in a checkout and in an installed wheel alike."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hsr8.errors import ModelError

PACKAGE = Path(__file__).resolve().parents[2]


def models_dir() -> Path:
    """Folder that holds ``hsr8/hsr8.xml`` and ``field/``.

    Raises:
        ModelError: the installation is incomplete.
    """
    places = (PACKAGE / "_models", PACKAGE.parent / "models")
    for place in places:
        if (place / "hsr8" / "hsr8.xml").is_file():
            return place
    raise ModelError(
        f"hsr8/hsr8.xml is in neither of {', '.join(map(str, places))}: install hsr8 again"
    )


@contextmanager
def reading_models() -> Iterator[None]:
    """Where models are read: whoever changed them is told what will not do.

    Raises:
        ModelError: a file is damaged, or lacks a name that the program looks up.
    """
    try:
        yield
    except (ValueError, KeyError, SyntaxError) as error:  # the last one of what is no XML
        reason = " ".join(str(error.args[0]).split())
        raise ModelError(f"the models in {models_dir()} will not do: {reason}") from error
