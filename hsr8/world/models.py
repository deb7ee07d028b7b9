"""Where the MJCF models lie, in a checkout and in an installed wheel alike."""

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parents[1]


def models_dir() -> Path:
    """Folder that holds ``hsr8/hsr8.xml`` and ``field/``.

    Raises:
        FileNotFoundError: the installation is incomplete.
    """
    places = (_PACKAGE / "_models", _PACKAGE.parent / "models")
    for place in places:
        if (place / "hsr8" / "hsr8.xml").is_file():
            return place
    raise FileNotFoundError(
        f"hsr8/hsr8.xml is in neither of {', '.join(map(str, places))}: install hsr8 again"
    )
