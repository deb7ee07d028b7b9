"""A robot of another size: the same drawing, scaled.

Lengths go with the size s, masses with s³, inertias with s⁵. With equal gravity, times go
with √s, torques with s⁴, and so on: a robot scaled like this moves exactly as the original
does, only larger and slower, as far as its control does so, too.
"""

from dataclasses import dataclass
from math import sqrt
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.robots.file.files import models_dir
from hsr8.robots.file.locate import find_description
from hsr8.robots.loaded import LoadedRobot, load_robot


@dataclass(frozen=True, slots=True)
class _Scale:
    """Powers of a size."""

    length: float

    @property
    def time(self) -> float:
        return sqrt(self.length)

    @property
    def mass(self) -> float:
        return self.length**3

    @property
    def inertia(self) -> float:
        return self.length**5

    @property
    def torque(self) -> float:
        return self.length**4

    @property
    def damping(self) -> float:
        return self.torque * self.time


def scale_robot(spec: mujoco.MjSpec, size: float) -> None:
    """Scale a robot in place.

    Its joints are hinges with servos, its shapes primitives; contacts soften in proportion.
    The physics step stays: it belongs to the control period, not to the robot.

    Args:
        spec: robot with a free root, nothing else in its world.
        size: factor on all lengths [1].
    """
    scale = _Scale(size)
    for body in spec.bodies:
        body.pos = size * body.pos
        body.ipos = size * body.ipos
        body.mass *= scale.mass
        body.inertia = scale.inertia * body.inertia
        body.fullinertia = scale.inertia * body.fullinertia
    for joint in spec.joints:
        _scale_joint(joint, scale)
    for geom in spec.geoms:
        _scale_geom(geom, scale)
    for site in spec.sites:
        site.pos = size * site.pos
        site.size = size * site.size
        site.fromto = size * site.fromto
    for camera in spec.cameras:
        camera.pos = size * camera.pos
    for actuator in spec.actuators:
        _scale_servo(actuator, scale)
    for key in spec.keys:
        for k in range(3):
            key.qpos[k] *= size  # of the free root


def _scale_joint(joint: mujoco.MjsJoint, scale: _Scale) -> None:
    joint.pos = scale.length * joint.pos
    joint.armature *= scale.inertia
    joint.frictionloss *= scale.torque
    joint.actfrcrange = scale.torque * joint.actfrcrange
    joint.damping = scale.damping * joint.damping
    joint.stiffness = scale.torque * joint.stiffness
    _slow_down(joint.solref_limit, scale)
    _slow_down(joint.solref_friction, scale)


def _scale_geom(geom: mujoco.MjsGeom, scale: _Scale) -> None:
    geom.pos = scale.length * geom.pos
    geom.size = scale.length * geom.size
    geom.fromto = scale.length * geom.fromto
    geom.mass *= scale.mass
    sliding, torsional, rolling = geom.friction
    geom.friction = [sliding, scale.length * torsional, scale.length * rolling]
    _slow_down(geom.solref, scale)
    geom.solimp[2] *= scale.length


def _slow_down(solref: NDArray[np.float64], scale: _Scale) -> None:
    """Time constant of a constraint; a negative one is a stiffness, which no model here has."""
    solref[0] *= scale.time


def _scale_servo(actuator: mujoco.MjsActuator, scale: _Scale) -> None:
    actuator.forcerange = scale.torque * actuator.forcerange
    actuator.gainprm[0] *= scale.torque
    actuator.biasprm[1] *= scale.torque
    actuator.biasprm[2] *= scale.damping


def scaled_robot(size: float, folder: Path) -> LoadedRobot:
    """Return HSR-VIII of another size, written to a folder and loaded from there."""
    file = folder / f"size-{size}.toml"
    if file.exists():
        return load_robot(str(file))
    spec = mujoco.MjSpec.from_file(str(models_dir() / "hsr8" / "hsr8.xml"))
    scale_robot(spec, size)
    spec.compile()
    (folder / f"size-{size}.xml").write_text(spec.to_xml(), encoding="utf-8")
    text = find_description("hsr8").read_text(encoding="utf-8")
    text = text.replace('"hsr8/hsr8.xml"', f'"size-{size}.xml"')
    for line in ("radius = 0.12\n", "tuned = true\n"):  # of the original only
        text = text.replace(line, "")
    file.write_text(text, encoding="utf-8")
    return load_robot(str(file))
