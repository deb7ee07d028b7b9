"""Analytic camera: detections from the geometry of the cylinders, without rendering.

It needs no OpenGL. Occlusion, also by the robot's arms, image borders, range, noise and missed
detections are modelled; colours are always recognised. Panoramic cameras see past the arms, and
differ else in their field of view alone.
"""

from collections.abc import Sequence
from math import asin, atan2, cos, hypot, inf, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from hsr8.robots.model.normal_form import HEAD_CAMERA
from hsr8.scenario.fault import ticks
from hsr8.scenario.sensors import Camera
from hsr8.world.body.body import Body
from hsr8.world.camera.feed import CameraFaults
from hsr8.world.field.layout import Beacon, Layout, Obstacle
from hsr8.world.rotation import heading
from navigation.angles import wrap
from navigation.observation import CameraModel, shadow_at
from vision.color import COLOR_CLASSES
from vision.detection import Detection
from vision.view import View

Array = NDArray[np.float64]
Rows = NDArray[np.record]
Pose = tuple[float, float, float]

# Lengths are those in a world of scale 1.
OBSTACLE_RANGE = 4.5  # farther obstacles are not reported [m]
BEACON_RANGE = 5.5  # farther beacons are not reported [m]
DETECTION_RATE = 0.999  # fraction of visible objects that are detected
MAX_HIDDEN = 0.7  # hidden fraction of the width beyond which nothing is detected
# Errors as those of vision in full physics, measured by scripts/vision_study.py.
MIN_SIGMA = 0.002  # of the range [m]
RANGE_SIGMA = 0.0027  # per squared distance [1/m]
BEARING_SIGMA = 0.0009  # [rad]
RADIUS_SIGMA = 0.0018  # [m]
PART_RANGE_SIGMA = 0.0065  # of an obstacle cut by the border or partly hidden [1/m]
PART_SIDE_SIGMA = 0.012  # of its axis, across the line of sight [m]
PART_RADIUS_SIGMA = 0.010  # [m]
OBSTACLE_COLORS = tuple(c.name for c in COLOR_CLASSES.values() if c.kind == "obstacle")
MAX_HIDDEN_WHOLE = 0.04  # hidden fraction of the width up to which an object counts as whole
FALSE_RADIUS = 0.08  # of false detections [m]
FALSE_RANGE = (0.3, 2.5)  # distance of false detections [m]

Box = tuple[float, float, float, float, bool]
Range = tuple[float, float]
MIN_DEPTH = 0.05  # of a visible point in front of the camera [m]
MIN_VISIBLE = 2.0  # width and height of a visible cylinder inside the border [pixel]
MIN_COLOR = 3.0  # height of either colour of a beacon above and below its seam [pixel]
NO_BOX = (0.0, 0.0, 0.0, 0.0, False)
DISTANCE, HIDDEN, LEFT, TOP, RIGHT, BOTTOM, CUT = range(7)  # columns of a view


class AnalyticCamera:
    """Detects the cylinders of a layout by geometry.

    Args:
        layout: obstacles and beacons.
        settings: settings of the camera.
        camera: field of view, and what the robot's own body hides.
        rng: generator of noise and misses.
        faults: faults of the images.
    """

    def __init__(
        self,
        layout: Layout,
        settings: Camera,
        camera: CameraModel,
        rng: np.random.Generator,
        faults: CameraFaults,
    ) -> None:
        self._camera = camera
        self._scale = layout.scale
        self._height = layout.sizes.top  # of false detections [m]
        self._rng = rng
        self._fault_rng = rng.spawn(1)[0]
        self._panoramic = settings.panoramic
        self._half_fov = 0.5 * camera.horizontal_fov
        self._faults = faults
        self._cylinders: tuple[Obstacle | Beacon, ...] = (*layout.obstacles, *layout.beacons)
        self._positions = np.array([c.position for c in self._cylinders]).reshape(-1, 2)
        self._moving = slice(len(layout.static), len(layout.obstacles))
        self._sizes = np.array([(c.radius, c.height) for c in self._cylinders]).reshape(-1, 2)
        self._beacon = np.array([isinstance(c, Beacon) for c in self._cylinders], dtype=bool)
        self._view: Rows = np.zeros(1, View)
        self._view["middle"] = 0.5 * settings.width, 0.5 * settings.height
        self._view["focal"] = settings.pinhole.focal

    def capture(self, body: Body) -> tuple[Detection, ...]:
        """Return the detections in the present world, by distance and label."""
        body.update_kinematics()
        model, data = body.model, body.data
        camera_id, root = model.camera(HEAD_CAMERA).id, int(model.jnt_qposadr[0])
        # MuJoCo cameras look along -z with y up, frame C along +z with y down.
        rotation = data.cam_xmat[camera_id].reshape(3, 3) * (1.0, -1.0, -1.0)
        x, y = data.qpos[root : root + 2].tolist()
        robot = (x, y, heading(data.qpos[root + 3 : root + 7]))
        self._view["position"], self._view["rotation"] = data.cam_xpos[camera_id], rotation
        self._positions[self._moving] = body.movers()
        tick = ticks(body.time)
        detections = self._detect(robot, self._faults.missed(tick))
        detections += self._false_detections(robot, self._faults.false_detections(tick))
        if self._faults.black(tick):
            return ()
        return tuple(sorted(detections, key=lambda d: (d.distance, d.label)))

    def _detect(self, robot: Pose, missed: float) -> list[Detection]:
        """Return the detections of cylinders; a fault hides the fraction `missed`."""
        offsets = self._positions - self._view["position"][0, :2]
        order = np.argsort(np.hypot(offsets[:, 0], offsets[:, 1]), kind="stable")
        positions = self._positions[order]
        sizes, beacon = self._sizes[order], self._beacon[order]
        views = project_all(positions, sizes, beacon, self._view, self._panoramic)
        detections = []
        for i, row in zip(order.tolist(), views.tolist(), strict=True):
            cylinder, (distance, hidden, *box) = self._cylinders[i], row
            if distance <= cylinder.radius:
                continue
            limit = BEACON_RANGE if isinstance(cylinder, Beacon) else OBSTACLE_RANGE
            limit *= self._scale
            draw = self._rng.random()
            noise = self._rng.standard_normal(3)
            if distance > limit or hidden > MAX_HIDDEN or draw > DETECTION_RATE:
                continue
            if missed and self._fault_rng.random() < missed:
                continue
            x, y = self._positions[i].tolist()
            polar = _polar(x, y, robot)
            if isinstance(cylinder, Obstacle) and self._behind_body(polar, top=box[1]):
                continue
            in_sector = not self._panoramic or abs(wrap(polar[1])) <= self._half_fov
            if box[2] and in_sector:
                detections.append(
                    _detection(
                        polar,
                        cylinder,
                        box,
                        hidden=hidden,
                        noise=noise.tolist(),
                        scale=self._scale,
                    )
                )
        return detections

    def _behind_body(self, polar: tuple[float, float], *, top: float) -> bool:
        """Return whether the robot's body hides the foot of an obstacle whose top is cut off."""
        distance, bearing = polar
        if self._panoramic or top > 0.0:
            return False
        return distance < shadow_at(bearing, self._camera.shadow)

    def _false_detections(self, robot: Pose, mean: float) -> list[Detection]:
        """Return false detections of obstacles, `mean` on average."""
        rng, view = self._fault_rng, self._view[0]
        ahead = atan2(view.rotation[1, 2], view.rotation[0, 2]) - robot[2]
        detections = []
        for _ in range(int(rng.poisson(mean)) if mean else 0):
            color = OBSTACLE_COLORS[rng.integers(len(OBSTACLE_COLORS))]
            radius, height = FALSE_RADIUS * self._scale, self._height
            cylinder = Obstacle((0.0, 0.0), radius, height, color)
            distance = self._scale * rng.uniform(*FALSE_RANGE)
            polar = (distance, ahead + rng.uniform(-self._half_fov, self._half_fov))
            direction = polar[1] + robot[2]
            x = robot[0] + polar[0] * cos(direction) - float(view.position[0])
            y = robot[1] + polar[0] * sin(direction) - float(view.position[1])
            box = project(x, y, radius, height, False, view, self._panoramic)
            if box[2]:
                detections.append(
                    _detection(
                        polar,
                        cylinder,
                        box,
                        hidden=0.0,
                        noise=(0.0, 0.0, 0.0),
                        scale=self._scale,
                    )
                )
        return detections


def _polar(x: float, y: float, robot: Pose) -> tuple[float, float]:
    """Return distance [m] and bearing [rad] of a point from the robot."""
    x, y = x - robot[0], y - robot[1]
    return hypot(x, y), atan2(y, x) - robot[2]


def _deviations(distance: float, whole: bool) -> tuple[float, float, float]:
    """Return the standard deviations of range [m], bearing [rad] and radius [m]."""
    if whole:
        return max(MIN_SIGMA, RANGE_SIGMA * distance**2), BEARING_SIGMA, RADIUS_SIGMA
    sigma = max(MIN_SIGMA, PART_RANGE_SIGMA * distance**2)
    return sigma, PART_SIDE_SIGMA / distance, PART_RADIUS_SIGMA


def _detection(
    polar: tuple[float, float],
    cylinder: Obstacle | Beacon,
    box: Sequence[float],
    *,
    hidden: float,
    noise: Sequence[float],
    scale: float,
) -> Detection:
    """Return a noisy detection of a cylinder at true (distance, bearing) in R.

    `scale` is that of the world.
    """
    distance, true_bearing = polar
    left, top, right, bottom, cut = box
    beacon = isinstance(cylinder, Beacon)
    whole = beacon or (not cut and hidden <= MAX_HIDDEN_WHOLE)
    range_sigma, bearing_sigma, radius_sigma = _deviations(distance / scale, whole)
    range_sigma, radius_sigma = range_sigma * scale, radius_sigma * scale
    if beacon:
        radius_sigma = 0.0
    bearing = true_bearing + bearing_sigma * noise[1]
    radius = cylinder.radius + radius_sigma * noise[2]
    return Detection(
        kind="beacon" if beacon else "obstacle",
        label=cylinder.name if isinstance(cylinder, Beacon) else cylinder.color,
        bearing=atan2(sin(bearing), cos(bearing)),
        distance=max(0.05 * scale, distance + range_sigma * noise[0]),
        covariance=np.array([[range_sigma**2, 0.0], [0.0, bearing_sigma**2]]),
        radius=max(0.01 * scale, radius),
        radius_sigma=radius_sigma,
        by_radius=np.zeros(2),
        cut=bool(cut),
        occluded=hidden > MAX_HIDDEN_WHOLE,
        box=(int(left), int(top), int(right), int(bottom)),
    )


@compiled
def _panorama_box(x: float, y: float, radius: float, height: float, view: np.record) -> Box:
    """Return the box in a panorama around the forward axis; it contains every direction."""
    R, z = view.rotation, view.position[2]
    columns, rows = 2.0 * view.middle[0], 2.0 * view.middle[1]
    distance = sqrt(x * x + y * y)
    half = asin(min(1.0, radius / distance))
    left = wrap(atan2(y, x) - atan2(R[1, 2], R[0, 2]))
    column = columns * (0.5 - left / (2.0 * pi))
    reach = columns * half / (2.0 * pi)
    top = rows * (0.5 - atan2(height - z, distance) / pi)
    bottom = rows * (0.5 - atan2(-z, distance) / pi)
    return column - reach, top, column + reach, bottom, False


@compiled
def _image_box(x: float, y: float, radius: float, height: float, view: np.record) -> Box:
    """Return the box in a pinhole image and whether it is cut; `NO_BOX` if outside."""
    R, middle = view.rotation, view.middle
    width, rows = 2.0 * middle[0], 2.0 * middle[1]
    left, top, right, bottom = inf, inf, -inf, -inf
    ratio = radius / sqrt(x * x + y * y)
    for side in (-ratio, ratio):
        X, Y = x - side * y, y + side * x
        for level in (0.0, 0.5, 1.0):
            Z = level * height - view.position[2]
            depth = X * R[0, 2] + Y * R[1, 2] + Z * R[2, 2]
            if depth < MIN_DEPTH:
                return NO_BOX
            u = middle[0] + view.focal * (X * R[0, 0] + Y * R[1, 0] + Z * R[2, 0]) / depth
            v = middle[1] + view.focal * (X * R[0, 1] + Y * R[1, 1] + Z * R[2, 1]) / depth
            left, right = min(left, u), max(right, u)
            top, bottom = min(top, v), max(bottom, v)
    if (
        right < MIN_VISIBLE
        or left > width - MIN_VISIBLE
        or bottom < MIN_VISIBLE
        or top > rows - MIN_VISIBLE
    ):
        return NO_BOX
    return left, top, right, bottom, left < 0.0 or top < 0.0 or right > width or bottom > rows


@compiled
def _seam_rows(x: float, y: float, radius: float, height: float, view: np.record) -> Range:
    """Return the first and the last row of a beacon's seam, halfway up [pixel]."""
    R, first, last = view.rotation, inf, -inf
    ratio = radius / sqrt(x * x + y * y)
    for side, near in ((-ratio, 0.0), (ratio, 0.0), (0.0, ratio)):  # both edges, and the front
        X, Y = (1.0 - near) * x - side * y, (1.0 - near) * y + side * x
        Z = 0.5 * height - view.position[2]
        depth = X * R[0, 2] + Y * R[1, 2] + Z * R[2, 2]
        if depth < MIN_DEPTH:
            return -inf, inf
        v = view.middle[1] + view.focal * (X * R[0, 1] + Y * R[1, 1] + Z * R[2, 1]) / depth
        first, last = min(first, v), max(last, v)
    return first, last


@compiled
def project(
    x: float,
    y: float,
    radius: float,
    height: float,
    beacon: bool,
    view: np.record,
    panoramic: bool,
) -> Box:
    """Return left, top, right and bottom of a cylinder in the image [pixel], and whether it is cut.

    All are 0 if the cylinder is outside the image.

    Args:
        x: position of the axis from the camera [m].
        y: position of the axis from the camera [m].
        radius: [m].
        height: [m].
        beacon: whether the cylinder is a beacon, recognised by its seam with a part of both
            colours in the image.
        view: camera in W, a record of type `View`.
        panoramic: whether the camera is panoramic.
    """
    width, rows = 2.0 * view.middle[0], 2.0 * view.middle[1]
    if panoramic:
        left, top, right, bottom, cut = _panorama_box(x, y, radius, height, view)
    else:
        left, top, right, bottom, cut = _image_box(x, y, radius, height, view)
        if right == 0.0:
            return NO_BOX
        if beacon:
            first, last = _seam_rows(x, y, radius, height, view)
            if first < MIN_COLOR or last > rows - MIN_COLOR:
                return NO_BOX
    left, top = float(int(max(left, 0.0))), float(int(max(top, 0.0)))
    return left, top, min(width, int(right) + 1.0), min(rows, int(bottom) + 1.0), cut


@compiled
def project_all(
    positions: Array, sizes: Array, beacon: NDArray[np.bool_], cameras: Rows, panoramic: bool
) -> Array:
    """Return the view of every cylinder, from near to far.

    Args:
        positions: axes of the cylinders in W, sorted by distance from the camera (n, 2) [m].
        sizes: radii and heights (n, 2) [m].
        beacon: whether each cylinder is a beacon (n,).
        cameras: camera in W, a record of type `View` (1,).
        panoramic: whether the camera is panoramic.

    Returns:
        Distance from the camera [m], maximum fraction of the width that one nearer cylinder
        hides, and the box of each (n, 7).
    """
    n, camera = len(positions), cameras[0]
    views, azimuth, half = np.empty((n, 7)), np.empty(n), np.empty(n)
    for i in range(n):
        x, y = positions[i, 0] - camera.position[0], positions[i, 1] - camera.position[1]
        distance, radius = sqrt(x * x + y * y), sizes[i, 0]
        views[i] = 0.0
        views[i, DISTANCE] = distance
        half[i] = 0.0
        if distance <= radius:
            continue  # the camera is inside it
        azimuth[i], half[i] = atan2(y, x), asin(radius / distance)
        for j in range(i):
            if half[j] == 0.0:
                continue
            offset = wrap(azimuth[j] - azimuth[i])
            low, high = max(-half[i], offset - half[j]), min(half[i], offset + half[j])
            views[i, HIDDEN] = max(views[i, HIDDEN], (high - low) / (2.0 * half[i]))
        left, top, right, bottom, cut = project(
            x, y, radius, sizes[i, 1], beacon[i], camera, panoramic
        )
        views[i, LEFT], views[i, TOP], views[i, RIGHT], views[i, BOTTOM] = left, top, right, bottom
        views[i, CUT] = cut
    return views
