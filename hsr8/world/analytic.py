"""A camera without pixels: cylinders projected geometrically, seen with known noise.

An all-round one differs in its field of view alone: occlusion, range, noise and misses stay.

It yields the same detections as vision would and needs no OpenGL. Occlusion, borders,
range and missed detections are modelled; colours are taken as recognised.
"""

from dataclasses import dataclass
from math import asin, atan2, cos, hypot, pi, sin

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.camera import Camera
from hsr8.scenario.fault import ticks
from hsr8.world.body import Body
from hsr8.world.camera import HEAD_CAMERA
from hsr8.world.camera_faults import CameraFaults
from hsr8.world.layout import Layout
from hsr8.world.rotation import heading
from vision.camera import PinholeCamera
from vision.colour import COLOUR_CLASSES
from vision.detection import Detection

Array = NDArray[np.float64]

OBSTACLE_RANGE = 3.0  # farther obstacles are not reported [m]
BEACON_RANGE = 5.0  # farther beacons are not reported [m]
DETECTED = 0.97  # share of visible things that are detected
HIDDEN = 0.7  # hidden share of the width beyond which nothing is detected
BEARING_SIGMA = 0.008  # [rad]
RANGE_SIGMA = 0.010  # at no distance [m]
RANGE_SIGMA_RATE = 0.015  # and per metre
RADIUS_SIGMA = 0.006  # [m]
OBSTACLE_COLOURS = tuple(c.name for c in COLOUR_CLASSES.values() if c.kind == "obstacle")
CUT_FACTOR = 3.0  # a thing cut by the border is located so much worse
FALSE_RADIUS, FALSE_HEIGHT = 0.08, 0.30  # of what is not there [m]
FALSE_RANGE = (0.3, 2.5)  # where things seem to be that are not there [m]


@dataclass(frozen=True, slots=True)
class _Thing:
    kind: str
    label: str
    radius: float
    height: float


class AnalyticCamera:
    """Detects the cylinders of a layout by geometry.

    Args:
        layout: obstacles and beacons.
        camera: intrinsics.
        rng: generator of noise and misses.
        settings: whether it sees all around.
        faults: of the images.
    """

    def __init__(
        self,
        layout: Layout,
        camera: PinholeCamera,
        rng: np.random.Generator,
        settings: Camera | None = None,
        faults: CameraFaults | None = None,
    ) -> None:
        self._camera = camera
        self._rng = rng
        self._fault_rng = rng.spawn(1)[0]
        self._settings = settings or Camera()
        self._faults = faults or CameraFaults()
        self._movers = layout.motion()
        static = layout.obstacles[: len(layout.obstacles) - len(self._movers)]
        self._static = np.array([o.position for o in static], dtype=float).reshape(-1, 2)
        self._posts = np.array([b.position for b in layout.beacons], dtype=float).reshape(-1, 2)
        self._things = [
            *(_Thing("obstacle", o.colour, o.radius, o.height) for o in layout.obstacles),
            *(_Thing("beacon", b.name, b.radius, b.height) for b in layout.beacons),
        ]
        self._index: tuple[int, int] | None = None

    def capture(self, body: Body) -> tuple[Detection, ...]:
        """Detections of the world as it is now, by distance and label."""
        body.update_kinematics()
        model, data = body.model, body.data
        if self._index is None:
            root = int(model.joint("root").qposadr[0])
            self._index = (model.camera(HEAD_CAMERA).id, root)
        camera_id, root = self._index
        position = data.cam_xpos[camera_id]
        # MuJoCo's camera looks along -z with y up; ours along +z with y down.
        rotation = data.cam_xmat[camera_id].reshape(3, 3) * (1.0, -1.0, -1.0)
        robot = np.array([*data.qpos[root : root + 2], heading(data.qpos[root + 3 : root + 7])])
        places = np.concatenate([self._static, self._movers.positions(body.time), self._posts])
        tick = ticks(body.time)
        found = self._detect(places, position, rotation, robot, self._faults.missed(tick))
        found += self._not_there(position, rotation, robot, self._faults.ghosts(tick))
        if self._faults.black(tick):
            return ()
        return tuple(sorted(found, key=lambda d: (d.distance, d.label)))

    def _detect(
        self, places: Array, position: Array, rotation: Array, robot: Array, missed: float
    ) -> list[Detection]:
        offsets = places - position[:2]
        ranges = np.hypot(offsets[:, 0], offsets[:, 1])
        spans: list[tuple[float, float]] = []  # azimuth and half width, nearer first
        found = []
        for i in np.argsort(ranges, kind="stable").tolist():
            thing, distance = self._things[i], float(ranges[i])
            if distance <= thing.radius:
                continue
            azimuth = atan2(offsets[i, 1], offsets[i, 0])
            half = asin(thing.radius / distance)
            hidden = _hidden_share(azimuth, half, spans)
            spans.append((azimuth, half))
            limit = BEACON_RANGE if thing.kind == "beacon" else OBSTACLE_RANGE
            draw = self._rng.random()
            noise = self._rng.standard_normal(3)
            if distance > limit or hidden > HIDDEN or draw > DETECTED:
                continue
            if missed and self._fault_rng.random() < missed:
                continue
            box = self._seen_box(places[i], thing, position, rotation)
            if box is None:
                continue
            x, y = (places[i] - robot[:2]).tolist()
            polar = (hypot(x, y), atan2(y, x) - float(robot[2]))
            found.append(_detection(polar, thing, box, hidden=hidden, noise=noise))
        return found

    def _not_there(
        self, position: Array, rotation: Array, robot: Array, mean: float
    ) -> list[Detection]:
        """Detections of obstacles that are not there, so many on average."""
        rng = self._fault_rng
        ahead = atan2(rotation[1, 2], rotation[0, 2]) - float(robot[2])
        half = pi if self._settings.all_round else 0.5 * self._camera.horizontal_fov
        found = []
        for _ in range(int(rng.poisson(mean)) if mean else 0):
            colour = OBSTACLE_COLOURS[rng.integers(len(OBSTACLE_COLOURS))]
            thing = _Thing("obstacle", colour, FALSE_RADIUS, FALSE_HEIGHT)
            polar = (rng.uniform(*FALSE_RANGE), ahead + rng.uniform(-half, half))
            direction = polar[1] + float(robot[2])
            place = robot[:2] + polar[0] * np.array([cos(direction), sin(direction)])
            box = self._seen_box(place, thing, position, rotation)
            if box is not None:
                found.append(_detection(polar, thing, box, hidden=0.0, noise=np.zeros(3)))
        return found

    def _seen_box(
        self, place: Array, thing: _Thing, position: Array, rotation: Array
    ) -> tuple[int, int, int, int, bool] | None:
        if self._settings.all_round:
            return self._panorama_box(place, thing, position, rotation)
        return self._box(place, thing, position, rotation)

    def _panorama_box(
        self, place: Array, thing: _Thing, position: Array, rotation: Array
    ) -> tuple[int, int, int, int, bool]:
        """Box of a cylinder in a panorama about the camera's forward; nothing is out of it."""
        width, height = self._camera.width, self._camera.height
        x, y = (place - position[:2]).tolist()
        distance = hypot(x, y)
        half = asin(min(1.0, thing.radius / distance))
        left = atan2(y, x) - atan2(rotation[1, 2], rotation[0, 2])
        column = width * (0.5 - atan2(sin(left), cos(left)) / (2.0 * pi))
        reach = width * half / (2.0 * pi)
        top, bottom = (
            height * (0.5 - atan2(z - float(position[2]), distance) / pi)
            for z in (thing.height, 0.0)
        )
        return (
            max(0, int(column - reach)),
            int(top),
            min(width, int(column + reach) + 1),
            int(bottom) + 1,
            False,
        )

    def _box(
        self, place: Array, thing: _Thing, position: Array, rotation: Array
    ) -> tuple[int, int, int, int, bool] | None:
        """Pixel box of a cylinder and whether the border cuts it; None when out of the image."""
        offset = place - position[:2]
        distance = hypot(*offset.tolist())
        side = np.array([-offset[1], offset[0]]) * (thing.radius / distance)
        corners = np.array(
            [
                [*(place + s * side), z]
                for s in (-1.0, 1.0)
                for z in (0.0, 0.5 * thing.height, thing.height)
            ]
        )
        local = (corners - position) @ rotation
        if (local[:, 2] < 0.05).any():
            return None
        pixels = self._camera.project(local)
        left, top = pixels.min(axis=0).tolist()
        right, bottom = pixels.max(axis=0).tolist()
        width, height = self._camera.width, self._camera.height
        if right < 2 or left > width - 2 or bottom < 2 or top > height - 2:
            return None
        if thing.kind == "beacon" and (top < 0 or bottom > height):
            return None  # its two colours name it only when both are seen
        cut = left < 0 or top < 0 or right > width or bottom > height
        return (
            max(0, int(left)),
            max(0, int(top)),
            min(width, int(right) + 1),
            min(height, int(bottom) + 1),
            cut,
        )


def _detection(
    polar: tuple[float, float],
    thing: _Thing,
    box: tuple[int, int, int, int, bool],
    *,
    hidden: float,
    noise: Array,
) -> Detection:
    """A noisy look at a thing at true (distance, bearing) in R."""
    distance, true_bearing = polar
    factor = CUT_FACTOR if box[4] else 1.0 + 2.0 * hidden
    range_sigma = factor * (RANGE_SIGMA + RANGE_SIGMA_RATE * distance)
    bearing_sigma = factor * BEARING_SIGMA
    bearing = true_bearing + bearing_sigma * float(noise[1])
    beacon = thing.kind == "beacon"
    radius = thing.radius + (0.0 if beacon else factor * RADIUS_SIGMA * float(noise[2]))
    return Detection(
        kind="beacon" if beacon else "obstacle",
        label=thing.label,
        bearing=atan2(sin(bearing), cos(bearing)),
        distance=max(0.05, distance + range_sigma * float(noise[0])),
        covariance=np.diag([range_sigma**2, bearing_sigma**2]),
        radius=max(0.01, radius),
        radius_sigma=0.0 if beacon else factor * RADIUS_SIGMA,
        cut=box[4],
        occluded=hidden > 0.1,
        box=box[:4],
    )


def _hidden_share(azimuth: float, half: float, nearer: list[tuple[float, float]]) -> float:
    """Largest share of an angular interval that one nearer interval covers."""
    worst = 0.0
    for other, other_half in nearer:
        offset = atan2(sin(other - azimuth), cos(other - azimuth))
        low, high = max(-half, offset - other_half), min(half, offset + other_half)
        worst = max(worst, (high - low) / (2.0 * half))
    return worst
