"""Plan of a world with obstacles, lanes, route and certificate."""

from dataclasses import replace
from itertools import pairwise
from math import inf

import numpy as np

from hsr8.scenario.track import Track
from hsr8.show.canvas import Canvas, Point, framed
from hsr8.show.image import Color, Image, draw_text
from hsr8.world.field.certificate import Certificate
from hsr8.world.field.layout import Layout, Obstacle
from hsr8.world.field.motion import Circle, Line, MotionLaw, Passage, Shuttle, Wander
from vision.color import COLOR_CLASSES

INK = (60, 58, 55)
PAPER = (246, 246, 244)
FLOOR = (226, 225, 221)
WHITE = (255, 255, 255)
LANE = (150, 147, 142)
ROUTE = (235, 125, 20)
PATH = (20, 125, 160)
ROBOT = (250, 250, 250)
MAX_LABELS = 12  # more via points than this are pale and without numbers
AHEAD = 60.0  # length of the lane of a mover that never turns [s]
TRACK_STEP = 0.05  # of the line along a recorded track [m]
MARK_PERIOD = 10.0  # between two marks on the path of the certificate [s]
PATH_WIDTH, PATH_DOT = 2, 0.025  # of the path of the certificate [pixel, m]
POINT, GOAL, HEADING = 0.035, 0.10, 0.12  # sizes of a via point, the goal and an arrow [m]
NUMBER, LABEL = 12, 15  # font sizes of obstacles and via points [pixel]


class PlanView:
    """Plan of a layout, x of W to the right and y up.

    Args:
        layout: layout to draw.
        radius: radius of the robot [m].
        size: size of the longer side of the image [pixel].
        certificate: certificate whose path is drawn, if any.

    Attributes:
        layout: the layout.
    """

    def __init__(
        self,
        layout: Layout,
        radius: float,
        size: int = 900,
        certificate: Certificate | None = None,
    ) -> None:
        self.layout, self._radius, self._scale = layout, radius, layout.scale
        self._path = np.zeros((0, 4)) if certificate is None else certificate.path
        extent = framed(layout.field_size, layout.scale)
        width, height = np.ceil(extent * (size / extent.max())).astype(int).tolist()
        self._canvas = Canvas(layout.field_size, (width, height), PAPER, layout.scale)

    @property
    def certified(self) -> bool:
        """Whether the path of a certificate is drawn."""
        return len(self._path) > 0

    def pixel(self, at: Point) -> tuple[int, int]:
        """Return column and row of a point."""
        return self._canvas.pixel(at)

    def draw(self) -> Image:
        """Return the image (height, width, 3), RGB."""
        canvas = self._canvas
        canvas.field(FLOOR, INK, 2)
        for bump in self.layout.bumps:
            canvas.ring(bump.position, bump.radius, INK)
        for obstacle in self.layout.obstacles:
            if obstacle.motion is not None:
                self._lane(obstacle.motion)
        self._route()
        self._certificate()
        for i, obstacle in enumerate(self.layout.obstacles):
            self._obstacle(i, obstacle)
        for beacon in self.layout.beacons:
            canvas.beacon(beacon.position, _rgb(beacon.top), _rgb(beacon.bottom))
        self._robot()
        self._numbers()
        return canvas.image

    def _obstacle(self, number: int, obstacle: Obstacle) -> None:
        motion = obstacle.motion
        if isinstance(motion, Track) and not motion.present(0.0):
            return
        if motion is not None and obstacle.present[0] > 0.0:
            obstacle = replace(obstacle, position=motion.position(obstacle.present[0]))
        self._canvas.disc(obstacle.position, obstacle.radius, _rgb(obstacle.color))
        if motion is not None:
            depart = motion.depart if isinstance(motion, Passage) else 0.0
            self._arrow(obstacle.position, motion.velocity(depart + 1e-6))
            self._canvas.ring(obstacle.position, obstacle.radius, INK)
        u, v = self._canvas.pixel(obstacle.position)
        at = u, v + round(0.4 * NUMBER)
        draw_text(self._canvas.image, at, str(number), WHITE, NUMBER, side="middle")

    def _route(self) -> None:
        points = [np.asarray(self.layout.start[:2]), *self.layout.waypoints]
        last = len(points) - 1
        color = ROUTE if last < MAX_LABELS else tuple((np.add(ROUTE, FLOOR) // 2).tolist())
        for leg in pairwise(points):
            self._canvas.line(leg, color)
        for k, point in enumerate(points[1:], start=1):
            if k == last and not self.layout.endless:
                self._canvas.ring(point, GOAL * self._scale, ROUTE)
                if self.layout.goal_heading is not None:
                    heading, length = self.layout.goal_heading, HEADING * self._scale
                    arrow = (length * np.cos(heading), length * np.sin(heading))
                    self._arrow(point, arrow, ROUTE)
            self._canvas.disc(point, POINT * self._scale, ROUTE)

    def _numbers(self) -> None:
        """Draw the numbers of the via points and the goal, joined at points visited repeatedly."""
        numbers: dict[tuple[float, float], list[str]] = {}
        points = self.layout.waypoints.tolist()
        goal = 0 if self.layout.endless else len(points)
        for k, (x, y) in enumerate(points, start=1):
            numbers.setdefault((x, y), []).append("goal" if k == goal else str(k))
        if len(points) <= MAX_LABELS:
            for at, names in numbers.items():
                u, v = self._canvas.pixel(at)
                if "goal" in names:  # next to the ring
                    u, v = self._canvas.pixel((at[0] + GOAL * self._scale, at[1]))
                    v += LABEL
                draw_text(self._canvas.image, (u + 7, v - 6), ",".join(names), ROUTE, LABEL)

    def _certificate(self) -> None:
        """Draw the path of the certificate with a mark every ten seconds."""
        if not self.certified:
            return
        times = np.arange(0.0, self._path[-1, 0], MARK_PERIOD)
        self._canvas.line(self._path[:, 1:3], PATH, PATH_WIDTH)
        marks = [np.interp(times, self._path[:, 0], self._path[:, k]) for k in (1, 2)]
        for mark in np.stack(marks, axis=1):
            self._canvas.disc(mark, PATH_DOT * self._scale, PATH)

    def _lane(self, motion: MotionLaw) -> None:
        if isinstance(motion, Shuttle | Passage):
            self._canvas.line((motion.start, motion.end), LANE)
        elif isinstance(motion, Line):
            ahead = np.asarray(motion.start) + AHEAD * np.asarray(motion.rate)
            self._canvas.line((motion.start, ahead), LANE)
        elif isinstance(motion, Circle):
            self._canvas.ring(motion.centre, motion.radius, LANE)
        elif isinstance(motion, Wander):
            self._canvas.line(motion.track, LANE, closed=True)
        elif isinstance(motion, Track):
            self._canvas.line(motion.sampled(-inf, inf, TRACK_STEP * self._scale)[1], LANE)

    def _robot(self) -> None:
        x, y, heading = self.layout.start
        self._canvas.disc((x, y), self._radius, ROBOT)
        self._canvas.ring((x, y), self._radius, INK)
        length = HEADING * self._scale
        self._arrow((x, y), (length * np.cos(heading), length * np.sin(heading)))

    def _arrow(self, tail: Point, velocity: Point, color: Color = INK) -> None:
        """Draw an arrow of two seconds of `velocity`."""
        self._canvas.arrow(tail, np.add(tail, 2.0 * np.asarray(velocity)), color)


def _rgb(color: str) -> Color:
    return tuple(round(255 * channel) for channel in COLOR_CLASSES[color].rgb)
