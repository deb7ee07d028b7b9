"""MuJoCo bodies, joints and geoms of a URDF robot; links that do not move apart are one body."""

from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from hsr8.errors import ModelError
from hsr8.robots.description import RobotDescription
from hsr8.robots.urdf_base import Base
from hsr8.robots.urdf_elements import Inertial, Joint
from hsr8.robots.urdf_joints import Joints, joint_range
from hsr8.robots.urdf_shapes import COLLISION, VISUAL, GeomBuilder, quaternion
from hsr8.robots.urdf_soles import Sole

Array = NDArray[np.float64]
MIN_MASS = 1e-9  # of a moving body without mass, by that of the robot [1]
PHYSICS_STEP = 0.0025  # a URDF file states none [s]
MIN_GYRATION = 0.01  # its radius of gyration [m]
INERTIA_TOLERANCE = 1e-6  # of the triangle inequality, by the largest principal moment [1]
SOLE: dict[str, Any] = {
    "group": 3,
    "contype": 1,
    "conaffinity": 1,
    "condim": 4,
    "friction": [0.8, 0.01, 0.001],
    "solref": [0.01, 1.0],
    "solimp": [0.9, 0.95, 0.001, 0.5, 2.0],
    "mass": 0.0,
}
SOLE_THICKNESS = 0.1  # of the box that replaces the foot's collision shapes, by its length [1]


class ModelBuilder:
    """MuJoCo model of a URDF robot.

    Attributes:
        notes: on bodies without mass.
    """

    def __init__(
        self,
        joints: Joints,
        base: Base,
        description: RobotDescription,
        soles: tuple[Sole, Sole],
        effort: dict[str, float],
    ) -> None:
        self._tree = joints.tree
        self._base = base
        self._effort = effort
        self._zero = description.zero
        feet = [self._tree.carrier(foot) for foot in description.feet]
        self._soles = dict(zip(feet, soles, strict=True))
        inertials = [link.inertial for link in self._tree.urdf.links.values()]
        self._mass = sum(inertial.mass for inertial in inertials if inertial is not None)
        self.notes: list[str] = []

    def build(self, spec: mujoco.MjSpec, geoms: GeomBuilder) -> mujoco.MjModel:
        """Fill an empty model and compile it.

        Raises:
            ModelError: the inertia of a body is not one of a rigid body, or MuJoCo refuses the
                model.
        """
        urdf = self._tree.urdf
        if self._mass <= 0.0:
            raise ModelError(f"{urdf.file}: no link has a mass; expected <inertial> elements")
        spec.modelname = urdf.file.stem
        spec.compiler.degree = False
        spec.option.timestep = PHYSICS_STEP
        spec.compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE
        height = self._soles[next(iter(self._soles))].height
        body = spec.worldbody.add_body(name=self._base.link, pos=(0.0, 0.0, -height))
        body.add_freejoint(name=f"{self._base.link}_free")
        self._fill(body, urdf.root, self._base.root_pose, geoms)
        for foot, sole in self._soles.items():
            self._add_sole(spec.body(foot), foot, sole)
        try:
            return spec.copy().compile()
        except ValueError:
            geoms.drop_invalid_meshes()
        try:
            return spec.copy().compile()
        except ValueError as error:
            text = " ".join(str(error).split())
            raise ModelError(f"{urdf.file}: MuJoCo cannot compile the model: {text}") from error

    def _fill(self, body: Any, carrier: str, carrier_pose: Array, geoms: GeomBuilder) -> None:
        """Add mass, shapes and children of a carrier whose pose in the body is given."""
        links = [(link, carrier_pose @ pose) for link, pose in self._tree.group(carrier)]
        self._set_inertia(body, carrier, links)
        for name, pose in links:
            link = self._tree.urdf.links[name]
            geoms.add(body, link.visual, pose, VISUAL)
            if carrier not in self._soles:
                geoms.add(body, link.collision, pose, COLLISION)
            for joint in self._tree.urdf.below(name):
                if self._tree.moves(joint):
                    at = pose @ joint.pose
                    child = body.add_body(name=joint.child, pos=at[:3, 3], quat=quaternion(at))
                    self._add_joint(child, joint)
                    self._fill(child, joint.child, np.eye(4), geoms)

    def _add_joint(self, body: Any, joint: Joint) -> None:
        added = body.add_joint(
            name=joint.name,
            type=mujoco.mjtJoint.mjJNT_HINGE,
            axis=joint.axis,
            range=joint_range(joint),
            limited=mujoco.mjtLimited.mjLIMITED_TRUE,
            frictionloss=max(joint.friction, 0.0),
        )
        added.damping[0] = max(joint.damping, 0.0)
        effort = self._effort.get(joint.name)
        if effort is not None:
            added.actfrcrange = (-effort, effort)
            added.actfrclimited = mujoco.mjtLimited.mjLIMITED_TRUE

    def _set_inertia(self, body: Any, carrier: str, links: list[tuple[str, Array]]) -> None:
        parts = {
            name: (inertial, pose)
            for name, pose in links
            if (inertial := self._tree.urdf.links[name].inertial) is not None
        }
        total = fuse(list(parts.values()))
        mass, inertia = total.mass, total.inertia
        if mass <= 0.0:
            mass = MIN_MASS * self._mass
            inertia = mass * MIN_GYRATION**2 * np.eye(3)
            self.notes.append(f"link '{carrier}' has no mass: given {mass:.1g} kg")
        heaviest = max(parts, key=lambda name: parts[name][0].mass, default=carrier)
        body.mass, body.ipos = mass, total.com
        body.inertia, axes = _principal(inertia, heaviest, self._tree.urdf.file)
        body.iquat = Rotation.from_matrix(axes).as_quat(scalar_first=True)
        body.explicitinertial = True

    def _add_sole(self, body: Any, foot: str, sole: Sole) -> None:
        """Add the box of a sole; its axes are those of the base at zero angles."""
        foot_pose = self._base.root_pose @ self._tree.poses(self._zero)[foot]
        pose = np.linalg.inv(foot_pose)
        length, width = sole.size
        half = 0.5 * SOLE_THICKNESS * length
        middle = (0.5 * (sole.front + sole.back), 0.5 * (sole.left + sole.right))
        center = np.array([*middle, sole.height + half, 1.0])
        body.add_geom(
            name=f"{foot}_sole",
            type=mujoco.mjtGeom.mjGEOM_BOX,
            size=(0.5 * length, 0.5 * width, half),
            pos=(pose @ center)[:3],
            quat=quaternion(pose),
            **SOLE,
        )


def fuse(parts: list[tuple[Inertial, Array]]) -> Inertial:
    """Mass properties of links in the frame of the body that they form.

    Args:
        parts: of each link, with its pose in the body, shape (4, 4) [m].
    """
    mass = sum(part.mass for part, _ in parts)
    coms = [pose[:3, :3] @ part.com + pose[:3, 3] for part, pose in parts]
    moment = sum((p.mass * c for (p, _), c in zip(parts, coms, strict=True)), np.zeros(3))
    com = moment / mass if mass > 0.0 else moment
    inertia = np.zeros((3, 3))
    for (part, pose), center in zip(parts, coms, strict=True):
        r, turn = center - com, pose[:3, :3]
        inertia += turn @ part.inertia @ turn.T + part.mass * (r @ r * np.eye(3) - np.outer(r, r))
    return Inertial(mass, com, inertia)


def _principal(inertia: Array, link: str, file: Path) -> tuple[Array, Array]:
    """Principal moments [kg m²] and axes, a rotation; rounding of the file is evened out."""
    moments, axes = np.linalg.eigh(inertia)
    tolerance = INERTIA_TOLERANCE * moments[2]
    if not moments[0] > 0.0 or moments[0] + moments[1] < moments[2] - tolerance:
        values = " ".join(f"{moment:.3g}" for moment in moments)
        raise ModelError(
            f"{file}: link '{link}': inertia of no rigid body, got principal moments {values} "
            "kg m² with the links fixed to it; expected positive moments, each at most the sum "
            "of the others: correct <inertia>"
        )
    if moments[0] + moments[1] < moments[2] + tolerance:
        moments = moments + 2.0 * tolerance
    return moments, axes * np.sign(np.linalg.det(axes))
