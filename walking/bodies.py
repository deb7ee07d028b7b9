"""The robot's bodies as a table that compiled code reads."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from walking.dynamics_kernel import BODY

Array = NDArray[np.float64]

BASE = 1  # index of the free root among Pinocchio's joints


def bodies_of(model: Any, names: Sequence[str]) -> Array:
    """Base, and the body that every joint moves; other joints are stiff.

    Args:
        model: Pinocchio model with a free root.
        names: of the joints, in the order of the rows.

    Returns:
        the table of `walking.dynamics_kernel` (number of joints + 1, 18).

    Raises:
        ValueError: a joint is no hinge, or comes before the one that carries it.
    """
    neutral = pin.neutral(model)
    others = [model.getJointId(n) for n in list(model.names)[BASE + 1 :] if n not in names]
    model = pin.buildReducedModel(model, others, neutral)
    data = model.createData()
    pin.computeJointJacobians(model, data, pin.neutral(model))
    ids = [BASE, *(model.getJointId(name) for name in names)]
    table = np.zeros((len(ids), BODY))
    for row, own in enumerate(ids):
        placement, inertia = data.oMi[own], model.inertias[own]
        R = placement.rotation
        table[row, 7], table[row, 8:11] = inertia.mass, R @ inertia.lever
        tensor = R @ inertia.inertia @ R.T
        table[row, 11:17] = tensor[[0, 0, 1, 0, 1, 2], [0, 1, 1, 2, 2, 2]]
        if row == 0:
            continue
        parent = ids.index(model.parents[own])
        column = model.joints[own].idx_v
        # In the frame of the base, where all angles are zero.
        axis = data.J[3:, column]
        if parent >= row or not np.isclose(np.linalg.norm(axis), 1.0):
            raise ValueError(f"the joint {names[row - 1]!r} is no hinge on one named before it")
        table[row, 0] = parent
        table[row, 1:4] = placement.translation - data.oMi[model.parents[own]].translation
        table[row, 4:7], table[row, 17] = axis, model.armature[column]
    return table
