"""Parameters of any robot, derived from its model and from the choices made for HSR-VIII."""

from dataclasses import fields, is_dataclass, replace
from functools import cache
from typing import Any, TypeVar, get_type_hints

from walking.body.robot_model import RobotModel
from walking.dimension import DecayPerTick, Dimension, GainPerTick, Rule
from walking.parameters import WalkingParameters
from walking.robot_measures import HSR_VIII, RobotMeasures

Section = TypeVar("Section")


def parameters_for(robot: RobotModel, given: WalkingParameters | None = None) -> WalkingParameters:
    """Parameters of a robot; for HSR-VIII they are the defaults, bit for bit.

    Args:
        robot: the robot's numbers.
        given: parameters some of which were chosen on purpose: what differs from the default
            is kept, the rest is the robot's own.
    """
    defaults = WalkingParameters()
    own = scale_parameters(defaults, HSR_VIII, robot.measures())
    return own if given is None else _chosen(given, defaults, own)


def scale_parameters(parameters: Section, old: RobotMeasures, new: RobotMeasures) -> Section:
    """Parameters of a robot with measures `old`, made those of one with measures `new`.

    Args:
        parameters: of the engine, a section of them, or a command.
        old: measures of the one robot.
        new: measures of the other.
    """
    section: Any = type(parameters)
    rules = rules_of(section)
    made: dict[str, Any] = {}
    for name, value in _values(parameters).items():
        if is_dataclass(value):
            made[name] = scale_parameters(value, old, new)
        elif name in rules:
            made[name] = rules[name].scale(value, old, new)
    return replace(parameters, **made)  # type: ignore[type-var]


@cache
def rules_of(section: type) -> dict[str, Rule]:
    """How the parameters of a section go over to another robot, by name."""
    rules = {}
    for name, hint in get_type_hints(section, include_extras=True).items():
        for mark in getattr(hint, "__metadata__", ()):
            if isinstance(mark, Dimension | DecayPerTick | GainPerTick):
                rules[name] = mark
    return rules


def _chosen(given: Section, defaults: Section, own: Section) -> Section:
    """`own` with everything in which `given` differs from `defaults`."""
    made: dict[str, Any] = {}
    others = zip(_values(defaults).values(), _values(own).values(), strict=True)
    for (name, value), (default, derived) in zip(_values(given).items(), others, strict=True):
        if is_dataclass(value):
            made[name] = _chosen(value, default, derived)
        elif value == default:
            made[name] = derived
    return replace(given, **made)  # type: ignore[type-var]


def _values(section: object) -> dict[str, Any]:
    return {f.name: getattr(section, f.name) for f in fields(section)}  # type: ignore[arg-type]
