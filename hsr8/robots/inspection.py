"""Inspection of a robot's model file: guessed roles, and the description that follows."""

from dataclasses import dataclass, replace
from pathlib import Path

import mujoco

from hsr8.errors import ModelError
from hsr8.robots.description import MODEL_SUFFIXES, RobotDescription, checked, read_description
from hsr8.robots.guess import Finding, Guess, guess, guess_roles
from hsr8.robots.locate import find_description, find_model
from hsr8.robots.models import reading_models
from hsr8.robots.read_model import read_model
from hsr8.robots.urdf_file import read_urdf
from hsr8.robots.urdf_skeleton import skeleton_of_urdf


@dataclass(frozen=True, slots=True)
class Inspection:
    """Roles of a robot's parts.

    Attributes:
        model: MJCF or URDF file.
        file: of the description; for a model without one, where it would be next to the model.
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
        model = find_model(description, file.parent)
        raw = read_model(model, description, file.parent)
        return Inspection(model, file, description, guess(raw.spec.compile()).findings, stated=True)
    guessed, target = _guess(file), file.with_suffix(".toml")
    if guessed.feet is None:
        return Inspection(file, target, None, guessed.findings, stated=False)
    description = checked({"model": str(file), **guessed.keys()}, str(file))
    return Inspection(file, target, description, guessed.findings, stated=False)


def _guess(file: Path) -> Guess:
    """Guess the roles in a model file; in a URDF file the base follows from the feet."""
    if file.suffix.lower() == ".urdf":
        return replace(guess_roles(skeleton_of_urdf(read_urdf(file))), base="")
    with reading_models(str(file)):
        model = mujoco.MjModel.from_xml_path(str(file))
    if not model.njnt:
        raise ModelError(f"{file}: the model has no joints; expected a robot")
    return guess(model)
