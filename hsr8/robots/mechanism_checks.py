"""Refusal of mechanisms that the walking engine cannot drive: inertia, closed chains, actuators.

Every check raises one `ModelError` with the element, the reason and the remedy.
"""

from collections.abc import Iterator

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import ModelError
from hsr8.robots.description import RobotDescription
from hsr8.robots.roles import Roles
from hsr8.robots.skeleton import HINGE, label

RIGID_TIES = {
    int(mujoco.mjtEq.mjEQ_CONNECT): "connect",
    int(mujoco.mjtEq.mjEQ_WELD): "weld",
}
JOINT_TIES = int(mujoco.mjtEq.mjEQ_JOINT)
TENDON_TIES = int(mujoco.mjtEq.mjEQ_TENDON)
SITE = int(mujoco.mjtObj.mjOBJ_SITE)
TO_JOINT = (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT))
TO_TENDON = int(mujoco.mjtTrn.mjTRN_TENDON)
FIXED_GAIN = int(mujoco.mjtGain.mjGAIN_FIXED)
AFFINE_BIAS = int(mujoco.mjtBias.mjBIAS_AFFINE)
WRAP_JOINT, WRAP_SITE = int(mujoco.mjtWrap.mjWRAP_JOINT), int(mujoco.mjtWrap.mjWRAP_SITE)


def check_mechanism(
    model: mujoco.MjModel, roles: Roles, description: RobotDescription, source: str
) -> None:
    """Refuse a mechanism that the walking engine cannot drive.

    Raises:
        ModelError: inertia that is not positive, a reversed range, a closed chain, or joints
            without a servo.
    """
    check = _Mechanism(model, roles, description, source)
    check.inertia()
    check.ranges()
    check.ties()
    check.tendons()
    check.servos()


def joint_actuators(model: mujoco.MjModel, joint: int) -> list[int]:
    """Return the actuators of a joint."""
    return [
        a
        for a in range(model.nu)
        if model.actuator_trntype[a] in TO_JOINT and model.actuator_trnid[a, 0] == joint
    ]


def is_position_servo(model: mujoco.MjModel, actuator: int) -> bool:
    """Return whether an actuator holds its joint at its setpoint."""
    gain, bias = model.actuator_gainprm[actuator, 0], model.actuator_biasprm[actuator, 1]
    return bool(
        model.actuator_gaintype[actuator] == FIXED_GAIN
        and model.actuator_biastype[actuator] == AFFINE_BIAS
        and gain > 0.0
        and np.isclose(gain, -bias)
    )


class _Mechanism:
    def __init__(
        self, model: mujoco.MjModel, roles: Roles, description: RobotDescription, source: str
    ) -> None:
        self._model, self._roles = model, roles
        self._servo, self._source = description.servo, source
        self._root = int(model.body_rootid[model.body(roles.base).id])
        self._legs = {model.joint(name).id for leg in roles.legs for name in leg}

    def _error(self, reason: str) -> ModelError:
        return ModelError(f"{self._source}: {reason}")

    def inertia(self) -> None:
        """Masses and inertias must be positive where a body has any."""
        model = self._model
        for body in range(1, model.nbody):
            if model.body_rootid[body] != self._root:
                continue
            name = label(model.body(body).name, body)
            mass, inertia = model.body_mass[body], model.body_inertia[body]
            if not (np.isfinite(mass) and mass >= 0.0):
                raise self._error(f"body {name!r}: mass, got {mass:g} kg; expected 0 or more")
            if not np.isfinite(inertia).all() or (mass > 0.0 and not (inertia > 0.0).all()):
                values = " ".join(f"{value:.3g}" for value in inertia)
                raise self._error(
                    f"body {name!r}: inertia is not positive, got principal moments {values} "
                    "kg m²; expected positive ones: correct its <inertial>"
                )

    def ranges(self) -> None:
        """Ranges must rise; MuJoCo takes a reversed one for no limit."""
        model = self._model
        for joint in range(model.njnt):
            if model.body_rootid[model.jnt_bodyid[joint]] == self._root:
                who = f"joint {label(model.joint(joint).name, joint)!r}"
                self._require_rise(who, "range", model.jnt_range[joint])
                self._require_rise(who, "actuatorfrcrange", model.jnt_actfrcrange[joint])
        for servo in range(model.nu):
            who = f"actuator {label(model.actuator(servo).name, servo)!r}"
            self._require_rise(who, "forcerange", model.actuator_forcerange[servo])

    def _require_rise(self, who: str, name: str, limits: NDArray[np.float64]) -> None:
        lower, upper = limits.tolist()
        if lower > upper:
            raise self._error(f"{who}: {name}, got {lower:g} {upper:g}; expected lower < upper")
        if name != "range" and not lower <= 0.0 <= upper:
            raise self._error(f"{who}: {name}, got {lower:g} {upper:g}; expected 0 in it")

    def ties(self) -> None:
        """No constraint may close a chain, hold the robot, or couple joints of the legs."""
        model = self._model
        for tie in range(model.neq):
            if not model.eq_active0[tie]:
                continue
            name = f"equality {label(model.equality(tie).name, tie)!r}"
            kind = int(model.eq_type[tie])
            if kind in RIGID_TIES:
                bodies = self._tied_bodies(tie)
                if self._root in model.body_rootid[bodies]:
                    tied = " and ".join(
                        repr(model.body(b).name) if b else "the world" for b in bodies
                    )
                    raise self._error(
                        f"{name}: closed chain, a {RIGID_TIES[kind]} ties {tied}; expected a "
                        "tree of bodies: remove it and the joints that it drives"
                    )
            ends = [int(model.eq_obj1id[tie]), int(model.eq_obj2id[tie])]
            joints = set(ends) & self._legs if kind == JOINT_TIES else set()
            if kind == TENDON_TIES:
                joints = {j for t in ends if t >= 0 for j in self._tendon_joints(t)} & self._legs
            if joints:
                raise self._error(
                    f"{name}: couples joint {model.joint(min(joints)).name!r} of a leg; expected "
                    "legs of independent joints: remove it, and drive every joint by itself"
                )

    def _tied_bodies(self, tie: int) -> list[int]:
        ends = (int(self._model.eq_obj1id[tie]), int(self._model.eq_obj2id[tie]))
        if self._model.eq_objtype[tie] == SITE:
            return [int(self._model.site_bodyid[end]) for end in ends]
        return [max(end, 0) for end in ends]

    def tendons(self) -> None:
        """No tendon may drive a leg."""
        model = self._model
        for actuator in range(model.nu):
            if model.actuator_trntype[actuator] != TO_TENDON:
                continue
            tendon = int(model.actuator_trnid[actuator, 0])
            joints = set(self._tendon_joints(tendon)) & self._legs
            if joints:
                raise self._error(
                    f"tendon {label(model.tendon(tendon).name, tendon)!r}: drives joint "
                    f"{model.joint(min(joints)).name!r} of a leg; expected an actuator per joint: "
                    'remove the tendon and its actuator, and state servo = "rule"'
                )

    def _tendon_joints(self, tendon: int) -> Iterator[int]:
        """Yield the joints that a tendon moves: its own, or those above its sites."""
        model = self._model
        first, n = int(model.tendon_adr[tendon]), int(model.tendon_num[tendon])
        for wrap in range(first, first + n):
            target = int(model.wrap_objid[wrap])
            if model.wrap_type[wrap] == WRAP_JOINT:
                yield target
            elif model.wrap_type[wrap] == WRAP_SITE:
                body = int(model.site_bodyid[target])
                adr, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
                yield from range(adr, adr + count)

    def servos(self) -> None:
        """Where the model's servos are used, each driven joint must have one."""
        model = self._model
        on_legs = [a for joint in self._legs for a in joint_actuators(model, joint)]
        has_own = any(is_position_servo(model, actuator) for actuator in on_legs)
        if self._servo != "own" and not (self._servo is None and has_own):
            return
        needed = {*self._legs}
        for name in (*(self._roles.head or ()), *(self._roles.shoulders or ())):
            needed.add(model.joint(name).id)
        for joint in range(model.njnt):
            on_robot = model.body_rootid[model.jnt_bodyid[joint]] == self._root
            if model.jnt_type[joint] == HINGE and on_robot:
                self._require_servo(joint, needed=joint in needed)

    def _require_servo(self, joint: int, *, needed: bool) -> None:
        model = self._model
        name, actuators = model.joint(joint).name, joint_actuators(model, joint)
        remedy = '; or state servo = "rule"'
        if len(actuators) > 1 or (needed and not actuators):
            raise self._error(
                f"joint {name!r}: {len(actuators) or 'no'} actuators; expected one position servo"
                f"{remedy}"
            )
        for actuator in actuators:
            who = f"actuator {label(model.actuator(actuator).name, actuator)!r} of joint {name!r}"
            gain = model.actuator_gainprm[actuator, 0]
            if gain < 0.0 and np.isclose(gain, -model.actuator_biasprm[actuator, 1]):
                raise self._error(f"{who}: kp, got {gain:g}; expected > 0")
            if not is_position_servo(model, actuator):
                raise self._error(
                    f"{who}: not a position servo but a torque motor or another kind; expected "
                    f"<position>{remedy}"
                )
            gear = model.actuator_gear[actuator, 0]
            if gear != 1.0:
                raise self._error(f"{who}: gear, got {gear:g}; expected 1{remedy}")
