"""Velocity to footholds."""

from math import cos, sin

from walking.parameters import GaitParameters, LimitParameters
from walking.robot_model import Sole
from walking.state import Footstep

Velocity = tuple[float, float, float]

STILL: Velocity = (0.0, 0.0, 0.0)
PLACE_TOLERANCE = 1e-3  # of a foothold that counts as parallel [m, rad]


class FootstepPlanner:
    """Places footholds for a velocity, one at a time.

    The foot on the side of a lateral or turning motion opens the stance by twice the motion
    of one footstep, the other foot closes it again; so the feet never cross and the mean
    velocity is the commanded one.

    Args:
        gait: timing, stance, clearance.
        limits: longest footstep and reach.
        sole: rectangle of the soles.
    """

    def __init__(self, gait: GaitParameters, limits: LimitParameters, sole: Sole) -> None:
        self._gait = gait
        self._limits = limits
        self._sole = sole
        self._velocity: Velocity = STILL
        self._rest = (self._stride(STILL, -1.0), self._stride(STILL, 1.0))
        self._strides = self._rest

    def opening_left(self, velocity: Velocity) -> bool | None:
        """Whether the left foot opens the stance for `velocity`; None when neither does."""
        _, left, turn = velocity
        tendency = left / self._limits.lateral + turn / self._limits.turn
        return None if tendency == 0.0 else tendency > 0.0

    def landing(self, support: Footstep, velocity: Velocity) -> Footstep:
        """Next foothold of the other foot.

        Args:
            support: the foot on the floor.
            velocity: forward, left, turn [m/s, m/s, rad/s].
        """
        if velocity != self._velocity:
            self._velocity = velocity
            self._strides = (self._stride(velocity, -1.0), self._stride(velocity, 1.0))
        x, y, turned = self._strides[0 if support.left else 1]
        return self._at(support, x, y, turned)

    def _stride(self, velocity: Velocity, side: float) -> tuple[float, float, float]:
        """Landing in the frame of the support foot; `side` is that of the swing foot."""
        forward, left, turn = velocity
        gait, limits = self._gait, self._limits
        time = gait.footstep_time
        dx = min(limits.step_forward, max(-limits.step_forward, forward * time))
        dy = 2.0 * left * time if left * side > 0.0 else 0.0
        dy = min(limits.step_side, max(-limits.step_side, dy))
        turned = 2.0 * turn * time if turn * side > 0.0 else 0.0
        turned = min(limits.step_turn, max(-limits.step_turn, turned))
        # The middle of the stance moves along the chord of the arc, then the foot stands
        # beside it in the new direction.
        ch, sh = cos(0.5 * turned), sin(0.5 * turned)
        stance = side * gait.half_stance
        x = ch * dx - sh * dy - stance * sin(turned)
        y = stance + sh * dx + ch * dy + stance * cos(turned)
        return x, self._clear(y, turned, side), turned

    def reachable(self, support: Footstep, landing: Footstep, dx: float, dy: float) -> Footstep:
        """`landing` moved by dx, dy [m], kept within reach and clear of the support foot."""
        limits = self._limits
        side = 1.0 if landing.left else -1.0
        c, s = cos(support.yaw), sin(support.yaw)
        wx, wy = landing.x + dx - support.x, landing.y + dy - support.y
        x, y = c * wx + s * wy, c * wy - s * wx
        centre = side * 2.0 * self._gait.half_stance
        norm = (x / limits.reach_forward) ** 2 + ((y - centre) / limits.reach_side) ** 2
        if norm > 1.0:
            scale = norm**-0.5
            x, y = x * scale, centre + (y - centre) * scale
        turned = landing.yaw - support.yaw
        return self._at(support, x, self._clear(y, turned, side), turned)

    def sequence(
        self, support: Footstep, landing: Footstep, velocity: Velocity, *, moving: bool
    ) -> tuple[list[Footstep], bool]:
        """Footholds from `landing` on, and whether the walk ends after the last.

        Args:
            support: the foot on the floor.
            landing: where the other foot is about to land.
            velocity: forward, left, turn [m/s, m/s, rad/s].
            moving: whether more than closing the stance is wanted.
        """
        steps = [landing]
        before, last = support, landing
        while len(steps) < self._gait.preview_steps:
            if not moving and self.parallel(before, last):
                return steps, True
            before, last = last, self.landing(last, velocity)
            steps.append(last)
        return steps, False

    def parallel(self, support: Footstep, other: Footstep) -> bool:
        """Whether the two feet stand side by side as for standing."""
        rest = self._at(support, *self._rest[0 if support.left else 1])
        return (
            abs(other.x - rest.x) < PLACE_TOLERANCE
            and abs(other.y - rest.y) < PLACE_TOLERANCE
            and abs(other.yaw - rest.yaw) < PLACE_TOLERANCE
        )

    def _clear(self, y: float, turned: float, side: float) -> float:
        """Lateral landing with every corner clear of the strip of the support foot."""
        sole = self._sole
        heel = sole.centre - sole.half_length
        toe = sole.centre + sole.half_length
        s = side * sin(turned)
        inner = min(s * heel, s * toe) - sole.half_width * cos(turned)
        nearest = sole.half_width + self._gait.foot_clearance - inner
        return side * max(side * y, nearest)

    @staticmethod
    def _at(support: Footstep, x: float, y: float, turned: float) -> Footstep:
        c, s = cos(support.yaw), sin(support.yaw)
        return Footstep(
            left=not support.left,
            x=support.x + c * x - s * y,
            y=support.y + s * x + c * y,
            yaw=support.yaw + turned,
        )
