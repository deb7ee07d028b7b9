"""Scaling of the default parameters from HSR-VIII to another robot."""

from dataclasses import fields, is_dataclass, replace
from functools import cache
from typing import Any, TypeVar, get_type_hints

from walking.body.robot_model import RobotModel
from walking.dimension import HSR_VIII, DecayPerTick, Dimension, GainPerTick, RobotMeasures, Rule
from walking.parameters import WalkingParameters

Section = TypeVar("Section")


def parameters_for(robot: RobotModel, chosen: WalkingParameters | None = None) -> WalkingParameters:
    """Return the parameters of a robot; for HSR-VIII exactly the defaults.

    Args:
        robot: model of the robot.
        chosen: parameters to keep where they differ from the defaults; the others are scaled.
    """
    defaults = WalkingParameters()
    scaled = scale_parameters(defaults, HSR_VIII, robot.measures())
    return scaled if chosen is None else override(scaled, chosen, defaults)


def scale_parameters(parameters: Section, old: RobotMeasures, new: RobotMeasures) -> Section:
    """Scale parameters from a robot with measures `old` to one with measures `new`.

    Args:
        parameters: parameters of the engine, a section of them, or a command.
        old: measures of the robot of the parameters.
        new: measures of the other robot.
    """
    section: Any = type(parameters)
    rules = rules_of(section)
    scaled: dict[str, Any] = {}
    for name in (field.name for field in fields(section)):
        value = getattr(parameters, name)
        if is_dataclass(value):
            scaled[name] = scale_parameters(value, old, new)
        elif name in rules:
            scaled[name] = rules[name].scale(value, old, new)
    return replace(parameters, **scaled)  # type: ignore[type-var]


@cache
def rules_of(section: type) -> dict[str, Rule]:
    """Return the scaling rules of the parameters of a section by name."""
    rules = {}
    for name, hint in get_type_hints(section, include_extras=True).items():
        for mark in getattr(hint, "__metadata__", ()):
            if isinstance(mark, Dimension | DecayPerTick | GainPerTick):
                rules[name] = mark
    return rules


def override(scaled: Section, chosen: Section, defaults: Section) -> Section:
    """Return `chosen` with the scaled value wherever it equals the default."""
    values: dict[str, Any] = {}
    for name in (field.name for field in fields(chosen)):  # type: ignore[arg-type]
        value, default = getattr(chosen, name), getattr(defaults, name)
        if is_dataclass(value):
            values[name] = override(getattr(scaled, name), value, default)
        elif value == default:
            values[name] = getattr(scaled, name)
    return replace(chosen, **values)  # type: ignore[type-var]
