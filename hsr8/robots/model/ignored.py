"""Features of a model file that neither walking nor the physics of the simulator use."""

from collections.abc import Iterator
from dataclasses import dataclass

import mujoco
import numpy as np

from hsr8.robots.file.files import models_dir

MAX_LISTED = 6  # elements in a note
OPTION_KINDS = {
    "integrator": mujoco.mjtIntegrator,
    "cone": mujoco.mjtCone,
    "solver": mujoco.mjtSolver,
    "jacobian": mujoco.mjtJacobian,
}
OPTIONS = (
    *OPTION_KINDS,
    *("gravity", "wind", "magnetic", "density", "viscosity", "impratio", "iterations"),
    *("ls_iterations", "noslip_iterations", "tolerance", "disableflags", "enableflags"),
)


@dataclass(frozen=True, slots=True)
class Feature:
    """Attribute that is set to its default.

    Attributes:
        elements: list of a specification.
        attribute: attribute of its elements.
        first: first coefficient that is dropped; None of a single number.
        default: value without the feature.
        text: name of the feature, for the note.
    """

    elements: str
    attribute: str
    first: int | None
    default: float
    text: str


IGNORED = (
    Feature("bodies", "gravcomp", None, 0.0, "gravity compensation"),
    Feature("joints", "actgravcomp", None, 0, "gravity compensation by the actuators"),
    Feature("joints", "damping", 1, 0.0, "damping that grows with the speed"),
    Feature("joints", "stiffness", 1, 0.0, "stiffness that grows with the angle"),
    Feature("actuators", "delay", None, 0.0, "delay of the actuators"),
)


def drop_ignored(spec: mujoco.MjSpec) -> Iterator[str]:
    """Set the ignored features of a model to their defaults; yield a note on each.

    Args:
        spec: specification, changed in place.
    """
    for feature in IGNORED:
        names = [e.name for e in getattr(spec, feature.elements) if _dropped(e, feature)]
        if names:
            more = " ..." if len(names) > MAX_LISTED else ""
            yield f"{feature.text} left out: {', '.join(names[:MAX_LISTED])}{more}"


def _dropped(element: object, feature: Feature) -> bool:
    """Set an attribute to its default; return whether it had another value."""
    value = getattr(element, feature.attribute)
    if feature.first is None:
        setattr(element, feature.attribute, feature.default)
        return bool(value != feature.default)
    changed = bool((np.asarray(value)[feature.first :] != feature.default).any())
    value[feature.first :] = feature.default
    return changed


def dropped_options(spec: mujoco.MjSpec) -> Iterator[str]:
    """Yield a note on options of the model that the simulator's field replaces."""
    usual = mujoco.MjSpec().option
    field = mujoco.MjSpec.from_file(str(models_dir() / "field" / "vision.xml")).option
    dropped = []
    for name in OPTIONS:
        own, default, used = (np.asarray(getattr(o, name)) for o in (spec.option, usual, field))
        if not np.array_equal(own, default) and not np.array_equal(own, used):
            kind = OPTION_KINDS.get(name)
            values = (
                [kind(int(own)).name.partition("_")[2].lower()]
                if kind
                else [f"{v:g}" for v in own.ravel()]
            )
            dropped.append(f"{name} {' '.join(values)}")
    if dropped:
        yield f"options of the model replaced by those of the simulator: {', '.join(dropped)}"
