"""Refusal of mechanisms that the walking engine cannot drive: closed chains, springs, actuators.

Every check raises one `ModelError` with the element, the reason and the remedy.
"""

from collections.abc import Iterator
from itertools import pairwise

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import ModelError
from hsr8.robots.file.description import RobotDescription
from hsr8.robots.file.key_mistake import RepairableError, at_most, label
from hsr8.robots.parts.roles import Roles
from hsr8.robots.parts.skeleton import HINGE, path_up

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
STATELESS = int(mujoco.mjtDyn.mjDYN_NONE)
MAX_SPRING = 0.05  # stiffness of a joint spring that walking neglects, of its servo's [1]
SERIAL = 'state linkage = "serial" to drive every joint of the legs by itself'
WRAP_JOINT, WRAP_SITE = int(mujoco.mjtWrap.mjWRAP_JOINT), int(mujoco.mjtWrap.mjWRAP_SITE)


def check_mechanism(
    model: mujoco.MjModel, roles: Roles, description: RobotDescription, source: str
) -> None:
    """Refuse a mechanism that the walking engine cannot drive.

    Raises:
        ModelError: a reversed range, a closed chain, a stiff spring, or joints without a servo.
    """
    check = _Mechanism(model, roles, description, source)
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
    """Return whether an actuator holds its joint at its setpoint, without a state."""
    gain, bias = model.actuator_gainprm[actuator, 0], model.actuator_biasprm[actuator, 1]
    return bool(
        model.actuator_dyntype[actuator] == STATELESS
        and model.actuator_gaintype[actuator] == FIXED_GAIN
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
        if name == "forcerange" and lower * upper == 0.0 and lower != upper:
            raise self._error(
                f"{who}: {name}, got {lower:g} {upper:g}; expected torque in both directions"
            )

    def ties(self) -> None:
        """No constraint may close a chain, hold the robot, or couple joints of the legs."""
        model = self._model
        for tie in range(model.neq):
            if not model.eq_active0[tie]:
                continue
            name = f"equality {label(model.equality(tie).name, tie)!r}"
            kind = int(model.eq_type[tie])
            if kind in RIGID_TIES:
                self._require_open(name, RIGID_TIES[kind], self._tied_bodies(tie))
            ends = [end for end in (model.eq_obj1id[tie], model.eq_obj2id[tie]) if end >= 0]
            joints = list(map(int, ends)) if kind == JOINT_TIES else []
            if kind == TENDON_TIES:
                joints = sorted({j for t in ends for j in self._tendon_joints(int(t))})
            if not {*joints} & self._legs:
                continue
            follower, *leaders = (repr(model.joint(j).name) for j in joints)
            others = f" to {', '.join(leaders)}" if leaders else ""
            reason = (
                f"{name}: couples joint {follower}{others} in a leg; expected legs of independent "
                "joints: remove it"
            )
            raise self._loop(reason) if kind == JOINT_TIES else self._error(reason)

    def _require_open(self, name: str, kind: str, bodies: list[int]) -> None:
        """Refuse a rigid tie of the robot; one that closes a loop of a leg can be replaced."""
        model = self._model
        if self._root not in model.body_rootid[bodies]:
            return
        tied = " and ".join(repr(model.body(b).name) if b else "the world" for b in bodies)
        reason = f"{name}: closed chain, a {kind} ties {tied}; expected a tree of bodies: remove it"
        above = {b for body in bodies for b in path_up(model, body)}
        of_leg = any(int(model.jnt_bodyid[joint]) in above for joint in self._legs)
        raise self._loop(reason) if of_leg and 0 not in bodies else self._error(reason)

    def _loop(self, reason: str) -> ModelError:
        return RepairableError(f"{self._source}: {reason}, or {SERIAL}", linkage="serial")

    def _tied_bodies(self, tie: int) -> list[int]:
        ends = (int(self._model.eq_obj1id[tie]), int(self._model.eq_obj2id[tie]))
        if self._model.eq_objtype[tie] == SITE:
            return [int(self._model.site_bodyid[end]) for end in ends]
        return [max(end, 0) for end in ends]

    def tendons(self) -> None:
        """No tendon may drive or pull a leg."""
        model = self._model
        driven = model.actuator_trnid[model.actuator_trntype == TO_TENDON, 0]
        for tendon in range(model.ntendon):
            joints = {*self._tendon_joints(tendon)} & self._legs
            passive = model.tendon_stiffness[tendon] or model.tendon_stiffnesspoly[tendon].any()
            passive = passive or model.tendon_limited[tendon]
            if not joints or not (passive or tendon in driven):
                continue
            drives = tendon in driven
            remedy = "the tendon and its actuator" if drives else "the tendon"
            raise self._error(
                f"tendon {label(model.tendon(tendon).name, tendon)!r}: "
                f"{'drives' if drives else 'pulls'} joint {model.joint(min(joints)).name!r} of a "
                f"leg; expected an actuator per joint: remove {remedy}, and state "
                'servo = "rule"'
            )

    def _tendon_joints(self, tendon: int) -> Iterator[int]:
        """Yield the joints that a tendon moves: its own, or those between its sites."""
        model = self._model
        first, n = int(model.tendon_adr[tendon]), int(model.tendon_num[tendon])
        bodies = list[int]()
        for wrap in range(first, first + n):
            target = int(model.wrap_objid[wrap])
            if model.wrap_type[wrap] == WRAP_JOINT:
                yield target
            elif model.wrap_type[wrap] == WRAP_SITE:
                bodies.append(int(model.site_bodyid[target]))
        for one, other in pairwise(bodies):
            apart = {*path_up(model, one)} ^ {*path_up(model, other)}
            yield from (j for j in range(model.njnt) if int(model.jnt_bodyid[j]) in apart)

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
        self._springs()

    def _require_servo(self, joint: int, *, needed: bool) -> None:
        model, actuators = self._model, joint_actuators(self._model, joint)
        who = f"joint {model.joint(joint).name!r}"
        if len(actuators) > 1:
            raise self._needs_linkage(joint, f"{who}: {len(actuators)} actuators; expected one")
        if needed and not actuators:
            raise self._needs_servos(f"{who}: no actuators; expected one position servo")
        for actuator in actuators:
            name = label(model.actuator(actuator).name, actuator)
            self._require_position(joint, actuator, f"actuator {name!r} of {who}")

    def _require_position(self, joint: int, actuator: int, who: str) -> None:
        """Require that an actuator is a position servo with gear 1, without a state."""
        model = self._model
        gain, gear = model.actuator_gainprm[actuator, 0], model.actuator_gear[actuator, 0]
        dynamics = mujoco.mjtDyn(model.actuator_dyntype[actuator]).name.removeprefix("mjDYN_")
        if gain < 0.0 and np.isclose(gain, -model.actuator_biasprm[actuator, 1]):
            raise self._needs_servos(f"{who}: kp, got {gain:g}; expected > 0")
        if dynamics != "NONE":
            raise self._needs_servos(
                f"{who}: has a state, got dynamics {dynamics.lower()}; expected <position> without "
                "timeconst"
            )
        if not is_position_servo(model, actuator):
            raise self._needs_servos(
                f"{who}: not a position servo but a torque motor or another kind; expected "
                "<position>"
            )
        if gear != 1.0:
            raise self._needs_linkage(joint, f"{who}: gear, got {gear:g}; expected 1")

    def _needs_servos(self, reason: str) -> ModelError:
        return RepairableError(f'{self._source}: {reason}; or state servo = "rule"', servo="rule")

    def _needs_linkage(self, joint: int, reason: str) -> ModelError:
        """Return the error of a joint whose actuators one servo can replace, in a leg."""
        if joint not in self._legs:
            return self._needs_servos(reason)
        return RepairableError(f"{self._source}: {reason}; or {SERIAL}", linkage="serial")

    def _springs(self) -> None:
        """Springs of leg joints must be soft against their servos; walking does not know them."""
        model = self._model
        for joint in sorted(self._legs):
            spring = float(model.jnt_stiffness[joint])
            (servo,) = joint_actuators(model, joint)
            limit = MAX_SPRING * float(model.actuator_gainprm[servo, 0])
            if spring > limit:
                raise self._needs_servos(
                    f"joint {model.joint(joint).name!r}: spring, got a stiffness of {spring:.3g} "
                    f"N m/rad; expected at most {at_most(limit)}, {MAX_SPRING:.0%} of its servo: "
                    "remove the stiffness of the joint"
                )
