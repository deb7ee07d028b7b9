"""Keys of configuration files: the text of each is a mark in its annotation.

    radius: Annotated[float, Interval(gt=0.0, le=2.0), "m", doc("Radius of the robot [m].")] = 0.12

The annotation of a key has its type, its bounds, the unit by which it scales, and its text.
"""

from functools import cache
from typing import Any, get_type_hints

from annotated_types import DocInfo


@cache
def texts(kind: type) -> dict[str, str]:
    """Return the text of every documented key of a table or a parameter class."""
    return {
        key: mark.documentation
        for key, hint in hints(kind).items()
        for mark in getattr(hint, "__metadata__", ())
        if isinstance(mark, DocInfo)
    }


@cache
def hints(kind: type) -> dict[str, Any]:
    """Return the annotations of a class with their marks."""
    return get_type_hints(kind, include_extras=True)
