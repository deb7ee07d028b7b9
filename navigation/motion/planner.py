"""Motion planner: one pipeline for the default method, that of the paper and all baselines.

A method decides the desired velocity; the safety filter, where it is used, vetoes it; the velocity
mapping turns direction and speed into a velocity of the body within its limits.
"""

from dataclasses import replace
from math import atan2, hypot

import numpy as np
from numpy.typing import NDArray

from compilation.record import record
from compilation.value import value
from navigation.angles import wrap
from navigation.decision import MotionDecision, SpeedLimits, read_only
from navigation.motion.hypotheses import collision_discs
from navigation.motion.move_to_goal import arrival_gain, arrival_side, move_to_goal
from navigation.motion.planning_scene import Desired, Method, PlanningScene
from navigation.motion.safety_filter import RolloutStart, SafetyFilter
from navigation.motion.velocity_mapping import idle_velocity, target_heading
from navigation.parameters.navigation import NavigationParameters
from navigation.scene import Scene

Array = NDArray[np.float64]


@value
class MotionMemory:
    """State of the motion planner between two decisions.

    Attributes:
        course: latest direction of motion in W; None at the start [rad].
        leg: number of via points passed.
        side: side of the arrival of this leg, see `arrival_side`.
        plan: state of the method.
    """

    course: float | None = None
    leg: int = 0
    side: int = 0
    plan: object = None


class Planner:
    """Motion planner.

    Args:
        parameters: profile.
        limits: speed limits of the walking layer.
        method: decides the desired velocity.
        filtered: whether the safety filter vetoes it.
    """

    def __init__(
        self,
        parameters: NavigationParameters,
        limits: SpeedLimits,
        method: Method,
        *,
        filtered: bool = False,
    ) -> None:
        self._parameters = parameters
        self._limits = limits
        self._method = method
        self._filter = None
        if filtered:
            self._filter = SafetyFilter(
                parameters.safety_filter, parameters.velocity_mapping, limits
            )
        self._discs = record(parameters.safety_filter)

    def begin(self) -> MotionMemory:
        """Return the memory at the start, after a fall and after a relocalization."""
        return MotionMemory()

    def plan(self, memory: MotionMemory, scene: Scene) -> tuple[MotionDecision, MotionMemory]:
        """Decide the motion of the next footstep; call once per footstep.

        Args:
            memory: result of the call before, or of `begin`.
            scene: belief, task and obstacles.
        """
        task, heading = scene.task, float(scene.belief.pose[2])
        if task.done or scene.belief.lost:
            turn_rate = self._parameters.velocity_mapping.lost_turn_rate
            body = read_only(idle_velocity(not task.done, turn_rate, self._limits))
            return MotionDecision(body, heading), MotionMemory()
        planning = self._planning_scene(memory, scene)
        desired = self._method.desired(planning)
        motion = desired if self._filter is None else self._filtered(desired, planning, scene)
        body, course = _body(motion, planning)
        decision = MotionDecision(
            body,
            desired.direction,
            hypot(*desired.velocity.tolist()),
            motion.situation,
            desired.virtual,
            extended_radii=_by_track(planning, desired.radii),
            field=desired.field,
        )
        return decision, MotionMemory(course, task.index, planning.side, desired.plan)

    def _planning_scene(self, memory: MotionMemory, scene: Scene) -> PlanningScene:
        """Return the obstacles that the method avoids, and the motion without them."""
        p, pose, task = self._parameters, scene.belief.pose, scene.task
        known = ~scene.obstacles.lost | (scene.obstacles.age <= p.univector.memory)
        side, course, speed = 0, float(pose[2]), 0.0
        if not task.aligning:
            before = memory.side if memory.leg == task.index else 0
            side = arrival_side(pose[:2], task, before, p.univector)
            course = float(
                move_to_goal(pose[:2], task.target, task.heading, p.univector, side=side)
            )
            distance = hypot(*(task.target - pose[:2]).tolist())
            speed = self._limits.vx * arrival_gain(distance, task.is_goal, p.univector)
        last = course if memory.course is None else memory.course
        return PlanningScene(
            pose=pose,
            body=scene.body,
            obstacles=scene.obstacles.where(known),
            psi=scene.psi_sf + scene.psi_ob[known],
            s_oe=scene.s_oe[known],
            task=task,
            course=course,
            speed=speed,
            facing=target_heading(pose[:2], task, scene.look, last, p),
            side=side,
            limits=self._limits,
            parameters=p,
            plan=memory.plan,
        )

    def _filtered(self, desired: Desired, planning: PlanningScene, scene: Scene) -> Desired:
        """Return `desired`, or another motion if the safety filter vetoes it."""
        assert self._filter is not None
        s_robot = self._parameters.univector.s_robot
        obstacles = scene.obstacles
        discs = collision_discs(obstacles.rows, obstacles.clouds, s_robot, self._discs)
        start = RolloutStart(planning.pose, planning.body, desired.direction, planning.facing)
        velocity, direction = self._filter.choose(start, desired.velocity, discs)
        if velocity is desired.velocity:
            return desired
        return replace(desired, velocity=velocity, direction=direction, situation="veto")


def _body(motion: Desired, planning: PlanningScene) -> tuple[Array, float]:
    """Return velocity in R (3,) [m/s, m/s, rad/s] and direction of motion in W [rad]."""
    if motion.body is None:
        speed = hypot(*motion.velocity.tolist())
        return read_only(planning.walk(motion.direction, speed)), motion.direction
    body = np.clip(motion.body, planning.low(), planning.high())
    vx, vy, _ = body.tolist()
    course = wrap(float(planning.pose[2]) + atan2(vy, vx))
    return read_only(body), course if hypot(vx, vy) > 1e-9 else planning.course


def _by_track(planning: PlanningScene, radii: Array | None) -> tuple[tuple[int, float], ...]:
    """Return (track id, radius [m]) of the obstacles."""
    if radii is None:
        return ()
    return tuple(zip(planning.obstacles.ids.tolist(), radii.tolist(), strict=True))
