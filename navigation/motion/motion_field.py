"""Modified univector field: where to go at a point among obstacles and virtual obstacles."""

from math import atan2, cos, hypot, pi, sin

import numpy as np
from numpy.typing import NDArray

from navigation.decision import VirtualObstacle
from navigation.motion.avoid_obstacle import avoid_obstacle, spiral_turn, turning_sign
from navigation.motion.extended_radius import physical_radius
from navigation.motion.move_to_goal import move_to_goal, muf
from navigation.motion.univector import blended_sum, nearness, shrunk_for_goal, weighted_sum
from navigation.motion.virtual_obstacle import (
    PathPoint,
    VirtualSides,
    oval,
    path_point,
    printed_path_length,
    printed_radius,
)
from navigation.obstacle_set import ObstacleSet
from navigation.parameters.motion import MovingObstacleParameters, UnivectorParameters
from navigation.value import value

Array = NDArray[np.float64]


@value
class FieldScene:
    """What the field is made of.

    Attributes:
        obstacles: n obstacles in W.
        s_oe: extended radii (n,) [m].
        psi: psi_sf + psi_ob of each (n,).
        target: destination (2,) [m].
        target_heading: heading to arrive with [rad].
        side: remembered side of the arrival, see `move_to_goal`.
        signs: sign of (9) for each obstacle (n,); None for the short way at every point.
    """

    obstacles: ObstacleSet
    s_oe: Array
    psi: Array
    target: Array
    target_heading: float
    side: int = 0
    signs: Array | None = None


@value
class ActiveVirtualObstacle:
    """A dynamic virtual obstacle in force, and the way out of it.

    Attributes:
        obstacle: what the recorder shows.
        direction: g, where the field leads at the robot [rad].
        outward: angle of n, from the mover's path to the robot's side [rad].
        weight: f in [0, 1].
    """

    obstacle: VirtualObstacle
    direction: float
    outward: float
    weight: float


ActiveVirtualObstacles = tuple[ActiveVirtualObstacle, ...]


class MotionField:
    """u_T of eq. (10) with the obstacles of eq. (9) and the virtual ones of eq. (11)."""

    def __init__(self, univector: UnivectorParameters, mover: MovingObstacleParameters) -> None:
        """Keep the parameters of the field and of moving obstacles."""
        self._univector = univector
        self._mover = mover
        self._sides = VirtualSides(mover)

    def at(
        self, points: Array, heading: float, scene: FieldScene, virtual: ActiveVirtualObstacles
    ) -> Array:
        """u_T at `points` (..., 2) in W [m] for a robot with `heading` [rad]: (..., 2).

        `virtual` in the blend by distance act alike at all points: they belong to one place
        of the robot.
        """
        p = self._univector
        u_muf = muf(points, heading, scene.target, scene.target_heading, p, side=scene.side)
        if p.blend == "weights":
            return self._weighted(points, u_muf, scene, virtual)
        return self._blended(points, u_muf, scene, virtual)

    def planned(
        self, heading: float, scene: FieldScene, virtual: ActiveVirtualObstacles
    ) -> "PlannedField":
        """The field of a decision, for those who watch.

        In the blend by distance a virtual obstacle acts at the robot's place alone: the field
        around it is without.
        """
        p = self._univector
        acting = virtual if p.blend == "weights" else ()
        return PlannedField(p, self._mover, heading, scene, acting)

    def _weighted(
        self, points: Array, u_muf: Array, scene: FieldScene, virtual: ActiveVirtualObstacles
    ) -> Array:
        """The printed sum: a virtual obstacle is one more obstacle with S_oe = R_vo."""
        p = self._univector
        u_auf = avoid_obstacle(
            points,
            scene.target,
            scene.obstacles.position,
            scene.s_oe,
            d_e=p.d_e,
            d_b=p.d_b,
            k_r=p.k_r,
            inside=p.inside,
            signs=scene.signs,
        )
        if virtual:
            u_virtual = avoid_obstacle(
                points,
                scene.target,
                np.array([f.obstacle.position for f in virtual]),
                np.array([f.obstacle.radius for f in virtual]),
                d_e=p.d_e,
                d_b=p.d_b,
                k_r=p.k_r,
                inside=p.inside,
                outward=np.array([f.outward for f in virtual]),
                abeam=True,
            )
            u_auf = np.concatenate([u_auf, u_virtual], axis=-2)
        return weighted_sum(u_muf, u_auf, p.w_muf, p.w_auf)

    def _blended(
        self, points: Array, u_muf: Array, scene: FieldScene, virtual: ActiveVirtualObstacles
    ) -> Array:
        """The sum by distance, with radii that leave the destination reachable."""
        p = self._univector
        centres = scene.obstacles.position
        offset = centres - scene.target
        radii, d_e = shrunk_for_goal(
            scene.s_oe,
            physical_radius(scene.obstacles, p),
            np.hypot(offset[:, 0], offset[:, 1]),
            p,
        )
        u_auf = avoid_obstacle(
            points,
            scene.target,
            centres,
            radii,
            d_e=d_e,
            d_b=p.d_b,
            k_r=p.k_r,
            inside=p.inside,
            signs=scene.signs,
        )
        away = np.asarray(points)[..., None, :] - centres
        ramp = nearness(np.hypot(away[..., 0], away[..., 1]), radii, d_e, p.d_b)
        g = np.array([[cos(f.direction), sin(f.direction)] for f in virtual]).reshape(-1, 2)
        weight = np.array([f.weight for f in virtual])
        return blended_sum(u_muf, u_auf, ramp, g, weight, virtual_weight=p.virtual_weight)

    def uncapped_obstacles(
        self, pose: Array, velocity: Array, scene: FieldScene
    ) -> ActiveVirtualObstacles:
        """Virtual obstacles of the own form: uncapped, in the whole band, with a side kept.

        Args:
            pose: of the robot (3,) [m, m, rad].
            velocity: of the robot in W (2,) [m/s].
            scene: the scene.
        """
        virtual = []
        banded = set()
        for index in np.nonzero(scene.obstacles.speed >= self._mover.min_speed)[0].tolist():
            foot = self._foot(pose, scene, index)
            s_oe = float(scene.s_oe[index])
            if foot is None or abs(foot.lateral) >= s_oe:
                continue
            relative = scene.obstacles.velocity[index] - velocity
            length = self._mover.path_time * hypot(*relative.tolist())
            length += self._univector.eta_imp * float(scene.psi[index])
            if foot.along >= length:
                continue
            track = int(scene.obstacles.ids[index])
            banded.add(track)
            side = self._sides.update(track, foot, self._to_goal(pose, scene))
            f = oval(foot.along / length, self._mover.xi)
            virtual.append(
                self._active(track, foot, side, weight=f, radius=f * s_oe, pose=pose, scene=scene)
            )
        self._sides.keep(banded)
        return tuple(virtual)

    def _to_goal(self, pose: Array, scene: FieldScene) -> tuple[float, float]:
        """u_muf at the robot."""
        p = self._univector
        goal, heading = scene.target, scene.target_heading
        phi = float(move_to_goal(pose[:2], pose[2], goal, heading, p, side=scene.side))
        return cos(phi), sin(phi)

    def printed_obstacles(
        self, pose: Array, velocity: Array, scene: FieldScene, indices: tuple[int, ...]
    ) -> ActiveVirtualObstacles:
        """Virtual obstacles as printed, eq. (11) in (9), of the obstacles with these `indices`."""
        virtual = []
        u_muf = self._to_goal(pose, scene)
        for index in indices:
            foot = self._foot(pose, scene, index)
            if foot is None:
                continue
            relative = scene.obstacles.velocity[index] - velocity
            length = printed_path_length(
                hypot(*relative.tolist()),
                float(scene.psi[index]),
                self._mover.omega_dist,
                self._univector.eta_vo,
                self._univector.eta_imp,
            )
            radius = printed_radius(foot, float(scene.s_oe[index]), length, self._mover.xi)
            if radius is not None:
                side = -1 if foot.left_of_path(u_muf) < 0.0 else 1
                track = int(scene.obstacles.ids[index])
                virtual.append(
                    self._active(
                        track, foot, side, weight=1.0, radius=radius, pose=pose, scene=scene
                    )
                )
        return tuple(virtual)

    def _foot(self, pose: Array, scene: FieldScene, index: int) -> PathPoint | None:
        return path_point(
            pose[:2],
            scene.obstacles.position[index],
            scene.obstacles.velocity[index],
        )

    def _active(
        self,
        track: int,
        foot: PathPoint,
        side: int,
        *,
        weight: float,
        radius: float,
        pose: Array,
        scene: FieldScene,
    ) -> ActiveVirtualObstacle:
        """Leave the path sideways, more along it the farther the robot is out of the oval."""
        p = self._univector
        nx, ny = foot.normal(side)
        outward = atan2(ny, nx)
        gap = max(0.0, side * foot.lateral - radius)
        turn = float(spiral_turn(gap, radius, p.d_e, p.k_r))
        place = np.array([foot.x, foot.y])
        sign = float(turning_sign(scene.target - place, pose[:2] - place))
        return ActiveVirtualObstacle(
            VirtualObstacle(place, radius, track),
            (outward + sign * turn + pi) % (2.0 * pi) - pi,
            outward,
            weight,
        )


@value
class PlannedField:
    """The field that a decision was made in; looking at it changes nothing.

    Attributes:
        univector, mover: parameters of the field.
        heading: of the robot [rad].
        scene: obstacles and destination.
        virtual: virtual obstacles that act wherever they are looked at.
    """

    univector: UnivectorParameters
    mover: MovingObstacleParameters
    heading: float
    scene: FieldScene
    virtual: ActiveVirtualObstacles

    def at(self, points: Array) -> Array:
        """u_T at `points` (..., 2) in W [m]: (..., 2)."""
        field = MotionField(self.univector, self.mover)
        return field.at(points, self.heading, self.scene, self.virtual)
