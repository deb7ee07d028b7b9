"""Compiled part of the risk gaze: the value per time of every view of the head."""

from math import cos, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Array = NDArray[np.float64]

MIN_DEPTH = 0.05  # of a visible point, relative to its distance [1]
BESIDE = 1.001  # a point that far beyond the widest border is in no image, despite rounding [1]


@compiled
def move_time(angle: float, speed: float, rate: float, acceleration: float) -> float:
    """Return the duration of the fastest move that ends at rest [s].

    Args:
        angle: of the move [rad].
        speed: at its beginning [rad/s].
        rate: maximum rate [rad/s].
        acceleration: maximum angular acceleration [rad/s²].
    """
    stopping = 0.5 * speed * abs(speed) / acceleration  # angle of a full stop
    sign = 1.0 if angle >= stopping else -1.0
    angle, speed = sign * angle, sign * speed
    peak = sqrt(max(0.0, acceleration * angle + 0.5 * speed * speed))
    if peak <= rate:
        return float((2.0 * peak - speed) / acceleration)
    ramps = (2.0 * rate * rate - speed * speed) / (2.0 * acceleration)
    return float((2.0 * rate - speed) / acceleration + (angle - ramps) / rate)


@compiled
def hidden(x: float, y: float, discs: Array, edge: float) -> bool:
    """Return whether a nearer disc hides a point of the floor.

    Args:
        x: of the point, from the robot [m].
        y: of the point [m].
        discs: x, y, radius (m, 3) [m].
        edge: distance from a disc's centre within which the point is on the disc [m].
    """
    for j in range(len(discs)):
        ax, ay, radius = discs[j, 0], discs[j, 1], discs[j, 2]
        dx, dy = ax - x, ay - y
        if x * ax + y * ay <= ax * ax + ay * ay or dx * dx + dy * dy <= edge * edge:
            continue
        across = x * ay - y * ax
        if across * across < radius * radius * (x * x + y * y):
            return True
    return False


@compiled
def in_image(ahead: float, aside: float, up: float, tilt: tuple[float, float], lens: Array) -> bool:
    """Return whether a point is in the image of the head camera.

    Args:
        ahead: from the camera along the pan [m].
        aside: across the pan [m].
        up: above the camera [m].
        tilt: its cosine and sine.
        lens: tangents of half the fields of view (2,).
    """
    depth = ahead * tilt[0] + up * tilt[1]
    if depth < MIN_DEPTH or abs(aside) > lens[0] * depth:
        return False
    return bool(abs(up * tilt[0] - ahead * tilt[1]) <= lens[1] * depth)


@compiled
def visible_part(
    ahead: float,
    aside: float,
    height: float,
    top: float,
    credit: float,
    tilt: tuple[float, float],
    lens: Array,
) -> float:
    """Return the value of what an image shows of an upright object, 1 for its top.

    Args:
        ahead: from the camera along the pan [m].
        aside: across the pan [m].
        height: of the camera [m].
        top: height of the top of the object [m].
        credit: value of the foot alone; negative where the image must show foot and top.
        tilt: of the camera, its cosine and sine.
        lens: tangents of half the fields of view (2,).
    """
    if credit < 0.0 and not in_image(ahead, aside, -height, tilt, lens):
        return 0.0
    if in_image(ahead, aside, top - height, tilt, lens):
        return 1.0
    return credit if credit > 0.0 and in_image(ahead, aside, -height, tilt, lens) else 0.0


@compiled
def view_values(
    pans: Array,
    tilts: Array,
    looks: Array,
    discs: Array,
    eye: Array,
    lens: Array,
    neck: Array,
    limits: Array,
    turn: Array,
) -> Array:
    """Return the value of every view over the time of its saccade and look (tilts, pans) [1/s].

    The value of a look is weight x min(max_urgency, base + rate x time)^exponent at the end of
    the saccade. The head keeps the direction of a view while the body turns; a view that it
    cannot keep until the end of the look is worth nothing.

    Args:
        pans: of the views [rad].
        tilts: of the views [rad].
        looks: position in R [m], weight, base, rate [1/s], height of the top [m], and value of a
            view of the foot without the top, negative where a view must show both (n, 7).
        discs: that hide the looks behind them, see `hidden`.
        eye: distance of the camera from the pan axis, and its height [m] (2,).
        lens: tangents of half the fields of view (2,).
        neck: present pan [rad] and its rate [rad/s], the same of the tilt, maximum rate [rad/s]
            and acceleration [rad/s²] (6,).
        limits: duration of a look [s], maximum urgency and its exponent, edge of a disc [m] (4,).
        turn: turn rate of the body [rad/s] and maximum pan [rad] (2,).
    """
    look_time, max_urgency, exponent, edge = limits
    times = saccade_times(pans, tilts, neck)
    values = np.zeros_like(times)
    tilted = np.array([(cos(tilt), sin(tilt)) for tilt in tilts])
    panned = np.array([(cos(pan), sin(pan)) for pan in pans])
    for i in range(len(looks)):
        x, y, weight, base = looks[i, 0], looks[i, 1], looks[i, 2], looks[i, 3]
        rate, top, credit = looks[i, 4], looks[i, 5], looks[i, 6]
        if credit >= 0.0 and hidden(x, y, discs, edge):
            continue
        steady = weight * min(max_urgency, base) ** exponent
        farthest_up = max(eye[1], abs(top - eye[1]))
        for p in range(len(pans)):
            c, s = panned[p]
            ahead, aside = c * x + s * y - eye[0], c * y - s * x
            if ahead < 0.0 and ahead * ahead + aside * aside > eye[1] * eye[1]:
                continue
            if abs(aside) > BESIDE * lens[0] * sqrt(ahead * ahead + farthest_up * farthest_up):
                continue  # at every tilt
            for t in range(len(tilts)):
                part = visible_part(ahead, aside, eye[1], top, credit, tilted[t], lens)
                if part > 0.0 and rate > 0.0:
                    urgency = min(max_urgency, base + rate * times[t, p])
                    values[t, p] += part * weight * urgency**exponent
                elif part > 0.0:
                    values[t, p] += part * steady
    for p, pan in enumerate(pans):
        for t in range(len(tilts)):
            duration = times[t, p] + look_time
            kept = abs(pan - turn[0] * duration) <= turn[1]
            values[t, p] = values[t, p] / duration if kept else 0.0
    return values


@compiled
def saccade_times(pans: Array, tilts: Array, neck: Array) -> Array:
    """Return the duration of the saccade to every view (tilts, pans) [s]; see `view_values`."""
    pan, pan_rate, tilt, tilt_rate, rate, acceleration = neck
    times = np.empty((len(tilts), len(pans)))
    for p in range(len(pans)):
        pan_time = move_time(pans[p] - pan, pan_rate, rate, acceleration)
        for t in range(len(tilts)):
            tilt_time = move_time(tilts[t] - tilt, tilt_rate, rate, acceleration)
            times[t, p] = max(pan_time, tilt_time)
    return times
