"""Modified univector field with obstacles and dynamic virtual obstacles."""

from math import atan2, cos, hypot, pi, sin

import numpy as np
from numpy.typing import NDArray

from compilation.value import value
from navigation.belief.tracks import Tracks
from navigation.decision import VirtualObstacle
from navigation.motion.avoid_obstacle import avoid_obstacle, spiral_turn, turning_sign
from navigation.motion.move_to_goal import move_to_goal, muf
from navigation.motion.univector import (
    blended_sum,
    nearness,
    physical_radius,
    shrunk_for_goal,
    weighted_sum,
)
from navigation.motion.virtual_obstacle import (
    PathPoint,
    VirtualSides,
    oval,
    path_point,
    printed_path_length,
    printed_radius,
)
from navigation.parameters.motion import MovingObstacleParameters, UnivectorParameters

Array = NDArray[np.float64]


@value
class FieldScene:
    """Inputs of the field.

    Attributes:
        obstacles: n obstacles in W.
        s_oe: extended radii (n,) [m].
        psi: psi_sf + psi_ob of each (n,).
        target: destination (2,) [m].
        target_heading: arrival heading [rad].
        side: remembered side of the arrival, see `move_to_goal`.
        signs: sign of (9) for each obstacle (n,); None for the shorter side at every point.
    """

    obstacles: Tracks
    s_oe: Array
    psi: Array
    target: Array
    target_heading: float
    side: int = 0
    signs: Array | None = None


@value
class ActiveVirtualObstacle:
    """An active dynamic virtual obstacle.

    Attributes:
        obstacle: its circle, for records.
        direction: g, direction of the field at the robot [rad].
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

    def __init__(
        self, univector: UnivectorParameters, moving_obstacles: MovingObstacleParameters
    ) -> None:
        self._univector = univector
        self._moving = moving_obstacles
        self._sides = VirtualSides(moving_obstacles)

    def at(
        self, points: Array, heading: float, scene: FieldScene, virtual: ActiveVirtualObstacles
    ) -> Array:
        """Return u_T at `points` (..., 2) in W [m] for a robot with `heading` [rad]: (..., 2).

        In the blend by distance `virtual` has the same effect at all points: it holds for one
        position of the robot.
        """
        p = self._univector
        phi = move_to_goal(points, heading, scene.target, scene.target_heading, p, side=scene.side)
        u_muf = muf(points, scene.target, phi)
        if p.blend == "weights":
            return self._weighted(points, u_muf, scene, virtual)
        return self._blended(points, u_muf, scene, virtual)

    def planned(
        self, heading: float, scene: FieldScene, virtual: ActiveVirtualObstacles
    ) -> "PlannedField":
        """Return the field of a decision for displays.

        In the blend by distance it leaves out `virtual`, which holds for the robot only.
        """
        active = virtual if self._univector.blend == "weights" else ()
        return PlannedField(self, heading, scene, active)

    def _weighted(
        self, points: Array, u_muf: Array, scene: FieldScene, virtual: ActiveVirtualObstacles
    ) -> Array:
        """Return the printed sum: a virtual obstacle is an obstacle with S_oe = R_vo."""
        p = self._univector
        u_auf = avoid_obstacle(
            points,
            scene.target,
            scene.obstacles.position,
            scene.s_oe,
            p,
            signs=scene.signs,
        )
        if virtual:
            u_virtual = avoid_obstacle(
                points,
                scene.target,
                np.array([f.obstacle.position for f in virtual]),
                np.array([f.obstacle.radius for f in virtual]),
                p,
                outward=np.array([f.outward for f in virtual]),
                abeam=True,
            )
            u_auf = np.concatenate([u_auf, u_virtual], axis=-2)
        return weighted_sum(u_muf, u_auf, p.w_muf, p.w_auf)

    def _blended(
        self, points: Array, u_muf: Array, scene: FieldScene, virtual: ActiveVirtualObstacles
    ) -> Array:
        """Return the sum by distance, with radii that leave the destination reachable."""
        p = self._univector
        centres = scene.obstacles.position
        offset = centres - scene.target
        radii, d_e = shrunk_for_goal(
            scene.s_oe,
            physical_radius(scene.obstacles, p),
            np.hypot(offset[:, 0], offset[:, 1]),
            p,
        )
        u_auf = avoid_obstacle(points, scene.target, centres, radii, p, d_e=d_e, signs=scene.signs)
        away = np.asarray(points)[..., None, :] - centres
        ramp = nearness(np.hypot(away[..., 0], away[..., 1]), radii, d_e, p.d_b)
        g = np.array([[cos(f.direction), sin(f.direction)] for f in virtual]).reshape(-1, 2)
        weight = np.array([f.weight for f in virtual])
        return blended_sum(u_muf, u_auf, ramp, g, weight, virtual_weight=p.virtual_weight)

    def uncapped_obstacles(
        self, pose: Array, velocity: Array, scene: FieldScene
    ) -> ActiveVirtualObstacles:
        """Return uncapped virtual obstacles in the whole band, with a remembered side.

        Args:
            pose: pose of the robot (3,) [m, m, rad].
            velocity: velocity of the robot in W (2,) [m/s].
            scene: obstacles and destination.
        """
        virtual = []
        tracks_in_band = set()
        for index in np.nonzero(scene.obstacles.speed >= self._moving.min_speed)[0].tolist():
            projection = self._projection(pose, scene, index)
            s_oe = float(scene.s_oe[index])
            if projection is None or abs(projection.lateral) >= s_oe:
                continue
            relative = scene.obstacles.velocity[index] - velocity
            length = self._moving.path_time * hypot(*relative.tolist())
            length += self._univector.eta_imp * float(scene.psi[index])
            if projection.along >= length:
                continue
            track = int(scene.obstacles.ids[index])
            tracks_in_band.add(track)
            side = self._sides.update(track, projection, self._to_goal(pose, scene))
            f = oval(projection.along / length, self._moving.xi)
            virtual.append(
                self._active(pose, scene, index, projection, side, weight=f, radius=f * s_oe)
            )
        self._sides.keep(tracks_in_band)
        return tuple(virtual)

    def _to_goal(self, pose: Array, scene: FieldScene) -> tuple[float, float]:
        """Return u_muf at the robot."""
        p = self._univector
        goal, heading = scene.target, scene.target_heading
        phi = float(move_to_goal(pose[:2], pose[2], goal, heading, p, side=scene.side))
        return cos(phi), sin(phi)

    def printed_obstacles(
        self, pose: Array, velocity: Array, scene: FieldScene, indices: tuple[int, ...]
    ) -> ActiveVirtualObstacles:
        """Return virtual obstacles as printed, eq. (11) in (9), of the obstacles `indices`."""
        virtual = []
        u_muf = self._to_goal(pose, scene)
        for index in indices:
            projection = self._projection(pose, scene, index)
            if projection is None:
                continue
            relative = scene.obstacles.velocity[index] - velocity
            length = printed_path_length(
                hypot(*relative.tolist()),
                float(scene.psi[index]),
                self._moving.omega_dist,
                self._univector.eta_vo,
                self._univector.eta_imp,
            )
            radius = printed_radius(projection, float(scene.s_oe[index]), length, self._moving.xi)
            if radius is not None:
                side = -1 if projection.left_of_path(u_muf) < 0.0 else 1
                virtual.append(
                    self._active(pose, scene, index, projection, side, weight=1.0, radius=radius)
                )
        return tuple(virtual)

    def _projection(self, pose: Array, scene: FieldScene, index: int) -> PathPoint | None:
        o = scene.obstacles
        return path_point(pose[:2], o.position[index], o.velocity[index])

    def _active(
        self,
        pose: Array,
        scene: FieldScene,
        index: int,
        projection: PathPoint,
        side: int,
        *,
        weight: float,
        radius: float,
    ) -> ActiveVirtualObstacle:
        """Direct the robot out of the path, more along the path the farther it is from the oval."""
        p = self._univector
        nx, ny = projection.normal(side)
        outward = atan2(ny, nx)
        gap = max(0.0, side * projection.lateral - radius)
        turn = float(spiral_turn(gap, radius, p.d_e, p.k_r))
        centre = np.array([projection.x, projection.y])
        sign = float(turning_sign(scene.target - centre, pose[:2] - centre))
        return ActiveVirtualObstacle(
            VirtualObstacle(centre, radius, int(scene.obstacles.ids[index])),
            (outward + sign * turn + pi) % (2.0 * pi) - pi,
            outward,
            weight,
        )


@value
class PlannedField:
    """Vector field of a decision.

    Attributes:
        field: modified univector field.
        heading: heading of the robot [rad].
        scene: obstacles and destination.
        virtual: virtual obstacles with an effect at all points.
    """

    field: MotionField
    heading: float
    scene: FieldScene
    virtual: ActiveVirtualObstacles

    def at(self, points: Array) -> Array:
        """Return u_T at `points` (..., 2) in W [m]: (..., 2)."""
        return self.field.at(points, self.heading, self.scene, self.virtual)
