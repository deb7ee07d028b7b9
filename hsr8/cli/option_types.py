"""Types of command-line options."""

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, Literal, get_args

from tyro.conf import Positional, UseAppendAction, arg
from tyro.constructors import PrimitiveConstructorSpec


def _optional(
    kind: Callable[[str], Any], metavar: str, choices: tuple[str, ...] | None = None
) -> PrimitiveConstructorSpec[Any]:
    """Parse one value of an option whose default is None; the word ``None`` is not a value."""
    return PrimitiveConstructorSpec(
        nargs=1,
        metavar=metavar,
        instance_from_str=lambda words: kind(words[0]),
        is_instance=lambda value: value is not None,
        str_from_instance=lambda value: [str(value)],
        choices=choices,
    )


def _choice(kind: Any) -> PrimitiveConstructorSpec[Any]:
    """Parse one value of a `Literal` of texts, of an option whose default is None."""
    choices = get_args(kind)
    return _optional(str, f"{{{','.join(choices)}}}", choices)


BodyKind = Literal["full", "kinematic"]
CameraKind = Literal["rendered", "analytic", "neck-reach", "omnidirectional"]
ViewKind = Literal["native", "web"]
NO_DEFAULT = arg(help_behavior_hint="")  # in the help
Integer = Annotated[int | None, _optional(int, "N"), NO_DEFAULT]
Number = Annotated[float | None, _optional(float, "X"), NO_DEFAULT]
Seconds = Annotated[float | None, _optional(float, "S"), NO_DEFAULT]
Text = Annotated[str | None, _optional(str, "TEXT"), NO_DEFAULT]
File = Annotated[Path | None, _optional(Path, "FILE"), NO_DEFAULT]
Body = Annotated[BodyKind | None, _choice(BodyKind), NO_DEFAULT]
Camera = Annotated[CameraKind | None, _choice(CameraKind), NO_DEFAULT]
View = Annotated[ViewKind | None, _choice(ViewKind), NO_DEFAULT]
Flag = Annotated[bool, NO_DEFAULT]
Scenario = Positional[
    Annotated[str, arg(metavar="SCENARIO", help="name (see `hsr8 list`) or TOML file")]
]
RobotName = Positional[
    Annotated[str, arg(metavar="ROBOT", help="name (see `hsr8 robot list`) or description file")]
]
RUN = "run folder, or a parent folder for its newest run"
RunPath = Positional[Annotated[Path, arg(metavar="RUN", help=RUN)]]
AnyRunPath = Positional[
    Annotated[Path | None, _optional(Path, "RUN"), arg(help=RUN, help_behavior_hint="")]
]
SETTINGS = arg(
    metavar="KEY=VALUE",
    help="Any setting, such as world.n_moving=8; may be repeated.",
    help_behavior_hint="",
)
ENTRY_SETTINGS = arg(
    metavar="KEY=VALUE",
    help="A setting, such as navigation.gaze.mode=steps or plugin.planner=mine.py:Mine; may be "
    "repeated.",
    help_behavior_hint="",
)
EntrySettings = UseAppendAction[Annotated[tuple[tuple[str, ...], ...], ENTRY_SETTINGS]]
Settings = UseAppendAction[Annotated[tuple[tuple[str, ...], ...], SETTINGS]]
Values = UseAppendAction[
    Annotated[tuple[tuple[str, ...], ...], arg(metavar="KEY=V1,V2,...", help_behavior_hint="")]
]
Json = Annotated[bool, arg(help="Print one JSON object on standard output.", help_behavior_hint="")]
Quiet = Annotated[bool, arg(help="Print neither progress nor results.", help_behavior_hint="")]
