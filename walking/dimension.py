"""Dimensions of parameters, and their scaling by dynamic similarity.

A length scales with the legs, a time with the period of the pendulum. Powers of the robot's
measures therefore scale parameters tuned for one robot to another one: twice the size, longer steps
in slower time, equal Froude numbers v²/(g leg) under equal gravity (Alexander, "Optimization and
gaits in the locomotion of vertebrates", Physiol. Rev. 1989).
"""

from __future__ import annotations

from dataclasses import astuple, dataclass, fields, is_dataclass, replace
from functools import cache
from typing import TYPE_CHECKING, Any, TypeVar, get_type_hints

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Section = TypeVar("Section", bound="DataclassInstance")


@dataclass(frozen=True, slots=True)
class RobotMeasures:
    """Measures of a robot.

    Attributes:
        leg: hip to sole along the straight leg [m].
        hip: half the distance between the hips [m].
        sole: half the width of a sole [m].
        time: √(height / g) of the equivalent pendulum, see `RobotModel.pendulum_height` [s].
        weight: weight of the robot [N].
        ankle: relative compliance of an ankle servo, weight times pendulum height over
            stiffness [rad/rad].
    """

    leg: float
    hip: float
    sole: float
    time: float
    weight: float
    ankle: float


HSR_VIII = RobotMeasures(
    leg=0.245, hip=0.035, sole=0.03, time=0.146737, weight=53.955, ankle=0.0949724
)
"""Robot that the default parameters were tuned for."""


@dataclass(frozen=True, slots=True)
class Dimension:
    """Product of powers of a robot's measures, see `RobotMeasures`.

    Attributes:
        leg, hip, sole, time, weight, ankle: exponents [1].
    """

    leg: float = 0.0
    hip: float = 0.0
    sole: float = 0.0
    time: float = 0.0
    weight: float = 0.0
    ankle: float = 0.0

    def __mul__(self, other: Dimension) -> Dimension:
        return Dimension(*(a + b for a, b in zip(astuple(self), astuple(other), strict=True)))

    def __truediv__(self, other: Dimension) -> Dimension:
        return self * other**-1.0

    def __pow__(self, power: float) -> Dimension:
        return Dimension(*(power * a for a in astuple(self)))

    def scale(self, value: float, old: RobotMeasures, new: RobotMeasures) -> float:
        """Scale a value from a robot with measures `old` to one with measures `new`."""
        factor = 1.0
        for power, a, b in zip(astuple(self), astuple(old), astuple(new), strict=True):
            factor *= (b / a) ** power
        return value * factor


@dataclass(frozen=True, slots=True)
class DecayPerTick:
    """Decay factor per control tick."""

    def scale(self, value: float, old: RobotMeasures, new: RobotMeasures) -> float:
        """Return the factor with equal decay over an equal phase of the gait."""
        return float(value ** (old.time / new.time))


@dataclass(frozen=True, slots=True)
class GainPerTick:
    """Filter gain per control tick."""

    def scale(self, value: float, old: RobotMeasures, new: RobotMeasures) -> float:
        """Return the gain with equal correction over an equal phase of the gait."""
        if old.time == new.time:
            return value  # exactly
        return 1.0 - DecayPerTick().scale(1.0 - value, old, new)


Rule = Dimension | DecayPerTick | GainPerTick  # scaling rule of a parameter

NUMBER = Dimension()  # ratio, gain, angle or sensor property: equal for all robots
LENGTH = Dimension(leg=1.0)  # length of the walk
STANCE = Dimension(hip=1.0)  # distance across the stance
SOLE = Dimension(sole=1.0)  # distance within the sole
TIME = Dimension(time=1.0)  # time of the walk
HEIGHT = TIME**2.0  # height of a pendulum under equal gravity
FORCE = Dimension(weight=1.0)  # fraction of the robot's weight
SPEED = LENGTH / TIME  # speed of the walk
DIFFUSION = LENGTH / TIME**0.5  # random walk per square root of time
ACCELERATION = LENGTH / TIME**2.0  # acceleration of the walk
RATE = TIME**-1.0  # angular velocity, or feedback gain to a velocity
RATE_CHANGE = TIME**-2.0  # angular acceleration
ANKLE_TIME = Dimension(ankle=1.0) * TIME  # ankle setpoint per angular velocity
PER_LENGTH = LENGTH**-1.0  # angle per length of the walk
DECAY_PER_TICK = DecayPerTick()  # decay factor per control tick
GAIN_PER_TICK = GainPerTick()  # filter gain per control tick


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
        if is_dataclass(getattr(parameters, name)):
            scaled[name] = scale_parameters(getattr(parameters, name), old, new)
        elif name in rules:
            scaled[name] = rules[name].scale(getattr(parameters, name), old, new)
    return replace(parameters, **scaled)


@cache
def rules_of(section: type) -> dict[str, Rule]:
    """Return the scaling rules of the parameters of a section by name."""
    rules = {}
    for name, hint in get_type_hints(section, include_extras=True).items():
        for mark in getattr(hint, "__metadata__", ()):
            if isinstance(mark, Dimension | DecayPerTick | GainPerTick):
                rules[name] = mark
    return rules
