"""Comparison of a robot in two models: a change of the model must not change the robot."""

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import ModelError
from hsr8.robots.parts.skeleton import Posed

Array = NDArray[np.float64]

PRECISION = 1e-9  # of masses [kg] and places [m] in the normal form


def require_same(before: Posed, after: Posed, source: str) -> None:
    """Require equal mass, centre of mass, inertia and places of the joints.

    Args:
        before: robot before a change of its model.
        after: robot in the same posture after the change.
        source: model file, which begins the message.

    Raises:
        ModelError: a quantity differs.
    """
    raw, normal = before.model, after.model
    root = int(raw.jnt_bodyid[0])
    _same(source, "mass [kg]", raw.body_subtreemass[root], normal.body_subtreemass[1])
    _same(source, "centre of mass [m]", before.data.subtree_com[root], after.data.subtree_com[1])
    inertias = (posed.data.cinert[:, :6].sum(axis=0) for posed in (before, after))
    _same(source, "inertia about the centre of mass [kg m²]", next(inertias), next(inertias))
    for joint in (raw.joint(j) for j in range(1, raw.njnt)):
        anchor = after.data.joint(joint.name).xanchor
        _same(source, f"place of joint {joint.name!r} [m]", before.data.xanchor[joint.id], anchor)


def _same(source: str, quantity: str, before: Array | float, after: Array | float) -> None:
    if not np.allclose(before, after, rtol=PRECISION, atol=PRECISION):
        raise ModelError(
            f"{source}: {quantity}: changed in the normal form, got {after}; expected {before}"
        )
