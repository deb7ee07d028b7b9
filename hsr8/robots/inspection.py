"""Inspection of a robot's model file: guessed roles, and the description that follows."""

from dataclasses import dataclass, replace
from pathlib import Path

import mujoco

from hsr8.errors import ModelError
from hsr8.robots.description import (
    MODEL_SUFFIXES,
    RobotDescription,
    SoleRectangle,
    checked,
    read_description,
)
from hsr8.robots.flat_feet import flat_feet
from hsr8.robots.guess import Finding, Guess, guess, guess_roles
from hsr8.robots.key_mistake import reading_keys
from hsr8.robots.locate import find_description, find_model
from hsr8.robots.mjcf import read_mjcf
from hsr8.robots.models import reading_models
from hsr8.robots.read_model import read_model
from hsr8.robots.urdf import convert
from hsr8.robots.urdf_file import read_urdf
from hsr8.robots.urdf_skeleton import skeleton_of_urdf

UNKNOWN_SOLE = SoleRectangle(front=0.1, back=-0.1, left=0.05, right=-0.05, height=-0.05)


@dataclass(frozen=True, slots=True)
class Inspection:
    """Roles of a robot's parts.

    Attributes:
        model: MJCF or URDF file.
        file: of the description, or the model without one.
        description: stated or guessed; None where no feet were found.
        findings: guesses, one per role.
        stated: whether the description exists.
    """

    model: Path
    file: Path
    description: RobotDescription | None
    findings: tuple[Finding, ...]
    stated: bool

    def require_description(self) -> RobotDescription:
        """Return the description.

        Raises:
            ModelError: no feet were found; the message has the reason.
        """
        if self.description is None:
            reason = next(f.reason for f in self.findings if f.role == "feet")
            raise ModelError(f"{self.model}: feet: {reason}")
        return self.description


def inspect(name_or_file: str) -> Inspection:
    """Guess the roles of a robot's parts.

    Args:
        name_or_file: MJCF or URDF file, or a description by name or file.

    Raises:
        ModelError: a file is missing or cannot be read.
    """
    file = find_description(name_or_file).absolute()
    if file.suffix.lower() not in MODEL_SUFFIXES:
        description = read_description(file)
        model_file = find_model(description, file)
        with reading_keys(file):
            raw = read_model(model_file, description, file.parent)
        with reading_models(str(model_file)):
            guessed = guess(raw.spec.compile())
        return Inspection(model_file, file, description, guessed.findings, stated=True)
    guessed, model = _guess_in(file)
    findings = guessed.findings
    if guessed.feet is None:
        return Inspection(file, file, None, findings, stated=False)
    description = checked({"model": str(file), **guessed.keys()}, str(file))
    zero = _flat_feet(file, description, guessed, model)
    if zero:
        angles = ", ".join(f"{name} {angle:g}" for name, angle in zero.items())
        reason = "the soles are tilted at zero angles"
        findings = (*findings, Finding("zero", angles, "likely", reason))
        description = description.model_copy(update={"zero": zero})
    return Inspection(file, file, description, findings, stated=False)


def _guess_in(file: Path) -> tuple[Guess, mujoco.MjModel | None]:
    """Guess the roles in a model file; return the model, too, unless it is a URDF file.

    In a URDF file the base follows from the feet.
    """
    if file.suffix.lower() == ".urdf":
        return replace(guess_roles(skeleton_of_urdf(read_urdf(file))), base=""), None
    with reading_models(str(file)):
        model = read_mjcf(file).compile()
    if not model.njnt:
        raise ModelError(f"{file}: the model has no joints; expected a robot")
    return guess(model), model


def _flat_feet(
    file: Path, description: RobotDescription, guessed: Guess, model: mujoco.MjModel | None
) -> dict[str, float]:
    """Return the angles of ankles with which the soles are flat, where they are not [rad]."""
    if model is not None:
        return flat_feet(model, description.feet, guessed.legs)
    try:  # whatever the soles are
        stated = description.model_copy(update={"sole": UNKNOWN_SOLE})
        converted = convert(file, stated, file.parent)
    except ModelError:  # loading the robot reports it
        return {}
    return flat_feet(converted.spec.compile(), converted.feet, guessed.legs)
