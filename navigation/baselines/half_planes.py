"""Half-planes of allowed velocities: those of ORCA, and the best velocity in all of them.

J. van den Berg, S. Guy, M. Lin, D. Manocha, "Reciprocal n-body collision avoidance",
Robotics Research 2011 (ISRR 2009); the linear program after de Berg et al., "Computational
Geometry", chapter 4.
"""

from dataclasses import dataclass
from math import hypot, sqrt

Velocity = tuple[float, float]

_PARALLEL = 1e-9


@dataclass(frozen=True, slots=True)
class HalfPlane:
    """Velocities to the left of a line.

    Attributes:
        x, y: point of the line [m/s].
        dx, dy: unit vector along it.
    """

    x: float
    y: float
    dx: float
    dy: float

    def depth(self, v: Velocity) -> float:
        """Return the depth of `v` on the forbidden side, negative if it is allowed [m/s]."""
        return self.dx * (self.y - v[1]) - self.dy * (self.x - v[0])


def orca_plane(
    position: Velocity,
    relative: Velocity,
    own: Velocity,
    *,
    radius: float,
    horizon: float,
    footstep: float,
    responsibility: float,
) -> HalfPlane:
    """Return the half-plane of velocities without collision with one disc within `horizon`.

    Args:
        position: position of the disc relative to the robot [m].
        relative: velocity of the robot relative to the disc [m/s].
        own: velocity of the robot [m/s].
        radius: collision distance [m].
        horizon: collision-free time [s].
        footstep: time in which an overlap must end [s].
        responsibility: fraction of the change of relative velocity taken by the robot.
    """
    px, py = position
    vx, vy = relative
    square = px * px + py * py
    apart = square > radius * radius
    time = horizon if apart else footstep
    wx, wy = vx - px / time, vy - py / time
    along = wx * px + wy * py
    norm = hypot(wx, wy)
    if not apart or (along < 0.0 and along * along > radius * radius * norm * norm):
        # The cut-off arc of the cone is nearest.
        nx, ny = (wx / norm, wy / norm) if norm > _PARALLEL else _away(px, py)
        dx, dy = ny, -nx
        change = radius / time - norm
        ux, uy = change * nx, change * ny
    else:
        leg = sqrt(max(0.0, square - radius * radius))
        if px * wy - py * wx > 0.0:
            dx, dy = (px * leg - py * radius) / square, (px * radius + py * leg) / square
        else:
            dx, dy = -(px * leg + py * radius) / square, -(py * leg - px * radius) / square
        on = vx * dx + vy * dy
        ux, uy = on * dx - vx, on * dy - vy
    return HalfPlane(own[0] + responsibility * ux, own[1] + responsibility * uy, dx, dy)


def _away(px: float, py: float) -> Velocity:
    """Return the unit vector away from a disc at (px, py), any for its centre."""
    norm = hypot(px, py)
    return (-px / norm, -py / norm) if norm > _PARALLEL else (-1.0, 0.0)


def solve(planes: list[HalfPlane], hard: int, desired: Velocity, v_max: float) -> Velocity:
    """Return the velocity nearest to `desired` in all half-planes and the disc of radius `v_max`.

    If there is none, the first `hard` half-planes hold and the maximum violation of the others
    is minimized.

    Args:
        planes: half-planes.
        hard: number of hard half-planes, which must have a common velocity.
        desired: desired velocity [m/s].
        v_max: maximum speed [m/s].
    """
    best, failed = _nearest(planes, desired, v_max)
    if failed == len(planes):
        return best
    return _min_violation(planes, hard, failed, best, v_max)


def _on_line(
    planes: list[HalfPlane], index: int, desired: Velocity, v_max: float, *, extreme: bool
) -> Velocity | None:
    """Return the best velocity on the line of one half-plane allowed by those before it."""
    p = planes[index]
    dot = p.x * p.dx + p.y * p.dy
    discriminant = dot * dot + v_max * v_max - p.x * p.x - p.y * p.y
    if discriminant < 0.0:
        return None
    root = sqrt(discriminant)
    low, high = -dot - root, -dot + root
    for q in planes[:index]:
        denominator = p.dx * q.dy - p.dy * q.dx
        numerator = q.dx * (p.y - q.y) - q.dy * (p.x - q.x)
        if abs(denominator) <= _PARALLEL:
            if numerator < 0.0:
                return None
            continue
        t = numerator / denominator
        if denominator >= 0.0:
            high = min(high, t)
        else:
            low = max(low, t)
        if low > high:
            return None
    if extreme:
        t = high if desired[0] * p.dx + desired[1] * p.dy > 0.0 else low
    else:
        t = min(high, max(low, p.dx * (desired[0] - p.x) + p.dy * (desired[1] - p.y)))
    return p.x + t * p.dx, p.y + t * p.dy


def _nearest(
    planes: list[HalfPlane], desired: Velocity, v_max: float, *, extreme: bool = False
) -> tuple[Velocity, int]:
    """Return the best velocity and the index of the first half-plane it cannot satisfy.

    With `extreme`, the best velocity is the farthest along the unit vector `desired`.
    """
    speed = hypot(*desired)
    if extreme:
        best = (desired[0] * v_max, desired[1] * v_max)
    elif speed > v_max:
        best = (desired[0] * v_max / speed, desired[1] * v_max / speed)
    else:
        best = desired
    for index, plane in enumerate(planes):
        if plane.depth(best) > 0.0:
            on_line = _on_line(planes, index, desired, v_max, extreme=extreme)
            if on_line is None:
                return best, index
            best = on_line
    return best, len(planes)


def _min_violation(
    planes: list[HalfPlane], hard: int, begin: int, best: Velocity, v_max: float
) -> Velocity:
    """Return the velocity with the minimum of the maximum violation of soft half-planes."""
    worst = 0.0
    for index in range(max(begin, hard), len(planes)):
        plane = planes[index]
        if plane.depth(best) <= worst:
            continue
        projected = planes[:hard]
        for q in planes[hard:index]:
            between = _bisector(plane, q)
            if between is not None:
                projected = [*projected, between]
        candidate, failed = _nearest(projected, (-plane.dy, plane.dx), v_max, extreme=True)
        if failed == len(projected):
            best = candidate
        worst = plane.depth(best)
    return best


def _bisector(p: HalfPlane, q: HalfPlane) -> HalfPlane | None:
    """Return the half-plane that violates `q` no more than `p`; None if all velocities do."""
    cross = p.dx * q.dy - p.dy * q.dx
    if abs(cross) <= _PARALLEL:
        if p.dx * q.dx + p.dy * q.dy > 0.0:
            return None
        x, y = 0.5 * (p.x + q.x), 0.5 * (p.y + q.y)
    else:
        t = (q.dx * (p.y - q.y) - q.dy * (p.x - q.x)) / cross
        x, y = p.x + t * p.dx, p.y + t * p.dy
    dx, dy = q.dx - p.dx, q.dy - p.dy
    norm = hypot(dx, dy)
    return HalfPlane(x, y, dx / norm, dy / norm)
