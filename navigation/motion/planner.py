"""Motion planner: univector field, velocity modification, safety filter, velocity mapping."""

from dataclasses import replace
from math import atan2, cos, hypot, sin

import numpy as np
from numpy.typing import NDArray

from compilation.record import record
from compilation.value import value
from navigation.belief.belief import Belief
from navigation.belief.tracks import Tracks
from navigation.decision import (
    DirectionField,
    MotionDecision,
    Situation,
    SpeedLimits,
    Task,
    VirtualObstacle,
    read_only,
)
from navigation.motion.collision_band import CollisionCase, Encounter
from navigation.motion.hypotheses import collision_discs
from navigation.motion.motion_field import ActiveVirtualObstacles, FieldScene, MotionField
from navigation.motion.move_to_goal import ArrivalSide, arrival_gain
from navigation.motion.passing_side import PassingSides
from navigation.motion.safety_filter import RolloutStart, SafetyFilter
from navigation.motion.univector import extended_radius, physical_radius
from navigation.motion.unseen_ground import ground_seen
from navigation.motion.velocity_mapping import body_velocity, idle_velocity, target_heading
from navigation.motion.velocity_modification import ModifiedSpeed, modify_speed, sample_speed
from navigation.motion.waypoint_search import search_waypoint
from navigation.parameters.navigation import NavigationParameters
from navigation.partial_evaluation import psi_obstacle, psi_self
from navigation.transform import velocity_in_world

Array = NDArray[np.float64]

_NO_DIRECTION = 1e-9


@value
class _Wanted:
    """Result of field and velocity modification, before the safety filter.

    Attributes:
        direction: direction in W [rad].
        speed: speed along it [m/s].
        situation: outcome of velocity modification.
        virtual: active virtual obstacles.
        field: vector field; None for a turn on the spot.
    """

    direction: float
    speed: float = 0.0
    situation: Situation = "free"
    virtual: tuple[VirtualObstacle, ...] = ()
    field: DirectionField | None = None


class Planner:
    """Modified univector field with velocity modification (Yoo & Kim, section III).

    The profile `extended` adds a speed limit towards unseen ground, a safety filter and a rear
    check.
    """

    def __init__(self, parameters: NavigationParameters, limits: SpeedLimits) -> None:
        """Start standing.

        Args:
            parameters: profile.
            limits: speed limits of the walking layer.
        """
        self._parameters = parameters
        self._limits = limits
        self._field = MotionField(parameters.univector, parameters.moving_obstacles)
        self._safety_filter = SafetyFilter(
            parameters.safety_filter, parameters.velocity_mapping, limits
        )
        self._limits_of_filter = record(parameters.safety_filter)
        self._sides = PassingSides(parameters.univector)
        self._arrival = ArrivalSide(parameters.univector)
        self._path: tuple[float, float] | None = None
        self._body = np.zeros(3)
        self._direction: float | None = None

    def plan(self, belief: Belief, task: Task, look: float | None = None) -> MotionDecision:
        """Decide the motion of the next footstep; call once per footstep.

        Args:
            belief: belief of the robot.
            task: task of the mission.
            look: direction in W that the body turns to for a fixed camera, if any [rad].
        """
        heading = float(belief.pose[2])
        if self._direction is None:
            self._direction = heading
        if task.done or belief.lost:
            turn_rate = self._parameters.velocity_mapping.lost_turn_rate
            self._body = idle_velocity(not task.done, turn_rate, self._limits)
            return MotionDecision(read_only(self._body), self._direction)
        obstacles = Tracks.of(belief.tracks)
        task = self._search_waypoint(belief, task, obstacles)
        scene, radii = self._scene(belief, task, obstacles)
        wanted = self._wanted(belief, task, scene)
        last = wanted.direction if self._path is None else self._path[0]
        facing = target_heading(belief.pose[:2], task, look, last, self._parameters)
        course, speed = self._filtered(belief, wanted, facing, obstacles)
        self._path = course, speed
        self._body = body_velocity(
            course,
            speed,
            heading,
            course if facing is None else facing,
            limits=self._limits,
            turn_gain=self._parameters.velocity_mapping.turn_gain,
        )
        return MotionDecision(
            read_only(self._body),
            wanted.direction,
            wanted.speed,
            wanted.situation,
            wanted.virtual,
            extended_radii=radii,
            field=wanted.field,
        )

    def _search_waypoint(self, belief: Belief, task: Task, obstacles: Tracks) -> Task:
        """Return `task`, or one with a waypoint around static obstacles that block the path."""
        p = self._parameters
        if not p.waypoint_search.enabled or task.aligning:
            return task
        static = obstacles.where(obstacles.static)
        radii = physical_radius(static, p.univector) + p.univector.margin
        waypoint = search_waypoint(
            belief.pose[:2], task.target, static.position, radii, p.waypoint_search
        )
        if waypoint is task.target:
            return task
        dx, dy = (task.target - waypoint).tolist()
        return replace(task, target=waypoint, heading=atan2(dy, dx), is_goal=False)

    def _filtered(
        self, belief: Belief, wanted: _Wanted, facing: float | None, obstacles: Tracks
    ) -> tuple[float, float]:
        """Return direction [rad] and speed [m/s] after the safety filter."""
        p = self._parameters
        if not p.safety_filter.enabled:
            return wanted.direction, wanted.speed
        rows, s_robot = obstacles.rows, p.univector.s_robot
        ages = belief.local_map.age_at(rows["last_seen"])
        discs = collision_discs(rows, obstacles.clouds, ages, s_robot, self._limits_of_filter)
        start = RolloutStart(belief.pose, self._body, wanted.direction, facing)
        velocity = wanted.speed * np.array([cos(wanted.direction), sin(wanted.direction)])
        return self._safety_filter.choose(start, velocity, discs)

    def _scene(
        self, belief: Belief, task: Task, obstacles: Tracks
    ) -> tuple[FieldScene, tuple[tuple[int, float], ...]]:
        """Return the inputs of the field, and (track id, S_oe) of its obstacles."""
        p = self._parameters
        obstacles = obstacles.where(~obstacles.lost | (obstacles.age <= p.univector.memory))
        psi_sf = psi_self(belief.pose_covariance, p.evaluation)
        velocity = velocity_in_world(belief.pose, self._body)
        psi_ob = psi_obstacle(obstacles, belief.pose[:2], velocity, p.evaluation)
        s_oe = extended_radius(obstacles, psi_sf, psi_ob, p.univector)
        side = self._arrival.update(belief.pose[:2], task)
        signs = None
        if p.univector.grouping or p.univector.side_memory:
            signs = self._sides.signs(belief.pose[:2], task.target, obstacles, s_oe)
        scene = FieldScene(obstacles, s_oe, psi_sf + psi_ob, task.target, task.heading, side, signs)
        return scene, tuple(zip(obstacles.ids.tolist(), s_oe.tolist(), strict=True))

    def _wanted(self, belief: Belief, task: Task, scene: FieldScene) -> _Wanted:
        """Return direction of the field and speed, before the safety filter."""
        p = self._parameters
        pose = belief.pose
        if task.aligning:
            return _Wanted(float(pose[2]))
        velocity = velocity_in_world(pose, self._body)
        virtual: ActiveVirtualObstacles = ()
        if p.moving_obstacles.virtual_obstacle == "uncapped":
            virtual = self._field.uncapped_obstacles(pose, velocity, scene)
        direction = self._steer(pose, scene, virtual)
        distance = hypot(*(task.target - pose[:2]).tolist())
        desired = self._limits.vx * arrival_gain(distance, task.is_goal, p.univector)
        encounters = self._encounters(pose, direction, scene)
        speed = self._modified_speed(encounters, direction, velocity, desired)
        if p.moving_obstacles.virtual_obstacle == "printed":
            blocked = self._blocking(encounters, speed)
            virtual = self._field.printed_obstacles(pose, velocity, scene, blocked)
            if virtual:
                direction = self._steer(pose, scene, virtual)
        self._direction = direction
        allowed = min(speed.speed, self._max_speed(belief, direction))
        return _Wanted(
            direction,
            allowed,
            speed.situation,
            tuple(f.obstacle for f in virtual),
            field=self._field.planned(float(pose[2]), scene, virtual),
        )

    def _steer(self, pose: Array, scene: FieldScene, virtual: ActiveVirtualObstacles) -> float:
        u_x, u_y = self._field.at(pose[:2], float(pose[2]), scene, virtual).tolist()
        if hypot(u_x, u_y) < _NO_DIRECTION:
            return float(pose[2]) if self._direction is None else self._direction
        return atan2(u_y, u_x)

    def _encounters(self, pose: Array, direction: float, scene: FieldScene) -> dict[int, Encounter]:
        """Return the movers in axes of the line of motion, by their index in the scene."""
        p = self._parameters
        radii = scene.s_oe
        if p.moving_obstacles.radius == "physical":
            radii = physical_radius(scene.obstacles, p.univector) + p.moving_obstacles.margin
        o = scene.obstacles
        return {
            index: Encounter.on_line(
                direction, o.position[index] - pose[:2], o.velocity[index], float(radii[index])
            )
            for index in np.nonzero(o.speed >= p.moving_obstacles.min_speed)[0].tolist()
        }

    def _modified_speed(
        self, encounters: dict[int, Encounter], direction: float, velocity: Array, desired: float
    ) -> ModifiedSpeed:
        p = self._parameters.moving_obstacles
        now = max(0.0, float(velocity[0]) * cos(direction) + float(velocity[1]) * sin(direction))
        if p.velocity_modification == "off" or not encounters:
            return ModifiedSpeed(desired, "free")
        modify = modify_speed if p.velocity_modification == "closed" else sample_speed
        return modify(tuple(encounters.values()), desired, now, self._limits, p)

    def _blocking(self, encounters: dict[int, Encounter], speed: ModifiedSpeed) -> tuple[int, ...]:
        """Return movers that no speed avoids: case (c), and (b) without a reachable escape."""
        definite = {
            index
            for index, e in encounters.items()
            if e.case(self._limits.vx) is CollisionCase.DEFINITE
        }
        if speed.situation == "path_change":
            definite |= {i for i, e in encounters.items() if e.in_band()}
        return tuple(sorted(definite))

    def _max_speed(self, belief: Belief, direction: float) -> float:
        """Return the maximum speed in `direction`, less towards unseen ground [m/s]."""
        p = self._parameters.unseen_ground
        if not p.enabled or ground_seen(belief, direction, p):
            return self._limits.vx
        return p.speed
