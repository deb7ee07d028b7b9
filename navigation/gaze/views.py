"""Value per time of every view of the head."""

from math import cos, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.record import record_class

Array = NDArray[np.float64]
Looks = NDArray[np.record]

MIN_DEPTH = 0.05  # of a visible point, relative to its distance [1]
WIDER = 1.002  # margin for rounding, of the squared half width of an image at any tilt [1]


@record_class
class Look:
    """Request of a look."""

    x: float  # position in R [m]
    y: float
    weight: float  # [1]
    urgency: float  # now [1]
    rate: float  # of the urgency [1/s]
    top: float  # height of the point that a view must show [m]
    foot_value: float  # value of a view of the foot without that point [1]
    tall: bool  # whether the point is above the obstacles, which then never hide it


@compiled
def move_time(angle: float, speed: float, rate: float, acceleration: float) -> float:
    """Return the duration of the fastest move that ends at rest [s].

    Args:
        angle: angle of the move [rad].
        speed: speed at its beginning [rad/s].
        rate: maximum rate [rad/s].
        acceleration: maximum angular acceleration [rad/s²].
    """
    stopping = 0.5 * speed * abs(speed) / acceleration  # angle of a full stop
    sign = 1.0 if angle >= stopping else -1.0
    angle, speed = sign * angle, sign * speed
    peak = sqrt(max(0.0, acceleration * angle + 0.5 * speed * speed))
    if peak <= rate:
        return (2.0 * peak - speed) / acceleration
    ramps = (2.0 * rate * rate - speed * speed) / (2.0 * acceleration)
    return (2.0 * rate - speed) / acceleration + (angle - ramps) / rate


@compiled
def saccade_times(pans: Array, tilts: Array, neck: Array) -> Array:
    """Return the duration of the saccade to every view (pans, tilts) [s]; see `view_values`."""
    pan, pan_rate, tilt, tilt_rate, rate, acceleration = neck
    times = np.empty((len(pans), len(tilts)))
    for p in range(len(pans)):
        pan_time = move_time(pans[p] - pan, pan_rate, rate, acceleration)
        for t in range(len(tilts)):
            tilt_time = move_time(tilts[t] - tilt, tilt_rate, rate, acceleration)
            times[p, t] = max(pan_time, tilt_time)
    return times


@compiled
def turned(angles: Array) -> Array:
    """Return cosines and sines of angles (n,) [rad]: (2, n)."""
    result = np.empty((2, len(angles)))
    for i in range(len(angles)):
        result[0, i], result[1, i] = cos(angles[i]), sin(angles[i])
    return result


@compiled
def in_image(ahead: float, aside: float, up: float, c: float, s: float, lens: Array) -> bool:
    """Return whether a point is in the image of the head camera.

    Args:
        ahead: distance from the camera along the pan [m].
        aside: absolute distance across the pan [m].
        up: height above the camera [m].
        c: cosine of the tilt.
        s: sine of the tilt.
        lens: tangents of half the fields of view (2,).
    """
    depth = ahead * c + up * s
    across = (depth >= MIN_DEPTH) & (aside <= lens[0] * depth)
    return bool(across & (abs(up * c - ahead * s) <= lens[1] * depth))


@compiled
def add_look(
    values: Array,
    times: Array,
    look: np.record,
    panned: Array,
    tilted: Array,
    eye: Array,
    lens: Array,
    max_urgency: float,
) -> None:
    """Add the value of a look to the views that show it; see `view_values`.

    Args:
        values: values of the views (pans, tilts).
        times: durations of the saccades (pans, tilts) [s].
        look: record of type `Look`.
        panned: cosines and sines of the pans (2, pans).
        tilted: cosines and sines of the tilts (2, tilts).
        eye: distance of the camera from the pan axis, and its height [m] (2,).
        lens: tangents of half the fields of view (2,).
        max_urgency: maximum urgency [1].
    """
    x, y, weight, height, foot_value = look.x, look.y, look.weight, eye[1], look.foot_value
    up = look.top - height
    highest, widest = max(height, abs(up)), WIDER * lens[0] * lens[0]
    urgency = min(max_urgency, look.urgency)
    steady = weight * urgency * sqrt(urgency)
    for p in range(panned.shape[1]):
        c, s = panned[0, p], panned[1, p]
        ahead, aside = c * x + s * y - eye[0], abs(c * y - s * x)
        if aside * aside > widest * (ahead * ahead + highest * highest):
            continue  # in no image of this pan
        if ahead < 0.0 and ahead * ahead + aside * aside > height * height:
            continue
        value, saccade = values[p], times[p]
        # Without jumps, the compiler evaluates several tilts at once.
        for t in range(tilted.shape[1]):
            c, s = tilted[0, t], tilted[1, t]
            top = in_image(ahead, aside, up, c, s, lens)
            foot = in_image(ahead, aside, -height, c, s, lens)
            part = 1.0 if top else (foot_value if foot else 0.0)
            worth = steady
            if look.rate > 0.0:
                urgency = min(max_urgency, look.urgency + look.rate * saccade[t])
                worth = weight * urgency * sqrt(urgency)
            value[t] += part * worth


@compiled
def view_values(
    pans: Array,
    tilts: Array,
    looks: Looks,
    eye: Array,
    lens: Array,
    neck: Array,
    look_time: float,
    max_urgency: float,
    turn: Array,
) -> Array:
    """Return the value of every view over the time of its saccade and look (tilts, pans) [1/s].

    The value of a look is weight x min(max_urgency, urgency + rate x time)^1.5 at the end of the
    saccade. The head keeps the direction of a view while the body turns; a view that it cannot
    keep until the end of the look is worth nothing.

    Args:
        pans: pans of the views [rad].
        tilts: tilts of the views [rad].
        looks: records of type `Look` (n,).
        eye: distance of the camera from the pan axis, and its height [m] (2,).
        lens: tangents of half the fields of view (2,).
        neck: present pan [rad] and its rate [rad/s], the same of the tilt, maximum rate [rad/s]
            and acceleration [rad/s²] (6,).
        look_time: duration of a look [s].
        max_urgency: maximum urgency [1].
        turn: turn rate of the body [rad/s] and maximum pan [rad] (2,).
    """
    times = saccade_times(pans, tilts, neck)
    values = np.zeros_like(times)
    panned, tilted = turned(pans), turned(tilts)
    for i in range(len(looks)):
        add_look(values, times, looks[i], panned, tilted, eye, lens, max_urgency)
    result = np.empty((len(tilts), len(pans)))
    for p in range(len(pans)):
        for t in range(len(tilts)):
            duration = times[p, t] + look_time
            kept = abs(pans[p] - turn[0] * duration) <= turn[1]
            result[t, p] = values[p, t] / duration if kept else 0.0
    return result
