"""A world seen from above, as a picture for people."""

from dataclasses import replace
from itertools import pairwise

import numpy as np

from hsr8.render.canvas import Canvas, Color, Image, Point, framed
from hsr8.scenario.world import ROBOT_RADIUS
from hsr8.world.field.certificate import Certificate
from hsr8.world.field.layout import Layout, Obstacle
from hsr8.world.field.motion import Appearing, Circle, Line, MotionLaw, Shuttle
from hsr8.world.field.passage import Passage
from hsr8.world.field.wander import Wander
from vision.color import COLOR_CLASSES

INK = (60, 58, 55)
PAPER = (246, 246, 244)
FLOOR = (226, 225, 221)
WHITE = (255, 255, 255)
LANE = (150, 147, 142)
ROUTE = (235, 125, 20)
WAY = (20, 125, 160)
ROBOT = (250, 250, 250)
FEW = 12  # more way points than this are shown paler and without their numbers
AHEAD = 60.0  # the lane of a mover that never turns is drawn so far ahead [s]
BEAT = 10.0  # the certificate's way has a mark every so often [s]
WAY_WIDTH, WAY_DOT = 2, 0.025  # of the certificate's way [pixel, m]


class PlanView:
    """Draws a layout, x of W to the right and y up.

    Args:
        layout: to draw.
        size: of the longer side of the picture [pixel].
        certificate: whose way is drawn; None for none.
    """

    def __init__(
        self, layout: Layout, size: int = 900, certificate: Certificate | None = None
    ) -> None:
        self._layout = layout
        self._way = np.zeros((0, 4)) if certificate is None else certificate.path
        extent = framed(layout.field_size)
        width, height = np.ceil(extent * (size / extent.max())).astype(int).tolist()
        self._canvas = Canvas(layout.field_size, (width, height), PAPER)

    def draw(self) -> Image:
        """Picture (height, width, 3), RGB."""
        canvas = self._canvas
        canvas.field(FLOOR, INK, 2)
        for bump in self._layout.bumps:
            canvas.ring(bump.place, bump.radius, INK)
        for obstacle in self._layout.obstacles:
            if obstacle.motion is not None:
                self._lane(obstacle.motion)
        self._route()
        self._certificate()
        for i, obstacle in enumerate(self._layout.obstacles):
            self._obstacle(i, obstacle)
        for beacon in self._layout.beacons:
            canvas.beacon(beacon.position, _rgb(beacon.top), _rgb(beacon.bottom))
        self._robot()
        self._numbers()
        return canvas.image

    def _obstacle(self, number: int, obstacle: Obstacle) -> None:
        law = obstacle.motion
        if isinstance(law, Appearing):  # it is drawn where it appears
            obstacle = replace(obstacle, position=law.position(law.start), motion=law.law)
            law = law.law
        self._canvas.disc(obstacle.position, obstacle.radius, _rgb(obstacle.color))
        if law is not None:
            # One that waits shows where it will go.
            depart = law.depart if isinstance(law, Passage) else 0.0
            self._arrow(obstacle.position, law.velocity(depart + 1e-6))
            self._canvas.ring(obstacle.position, obstacle.radius, INK)
        self._canvas.text(obstacle.position, str(number), WHITE, centred=True)

    def _route(self) -> None:
        places = [np.asarray(self._layout.start[:2]), *self._layout.waypoints]
        last = len(places) - 1
        color = ROUTE if last < FEW else tuple((np.add(ROUTE, FLOOR) // 2).tolist())
        for leg in pairwise(places):
            self._canvas.line(leg, color)
        for k, place in enumerate(places[1:], start=1):
            if k == last and not self._layout.endless:
                self._canvas.ring(place, 0.10, ROUTE)
                if self._layout.goal_heading is not None:
                    heading = self._layout.goal_heading
                    self._arrow(place, (0.12 * np.cos(heading), 0.12 * np.sin(heading)), ROUTE)
            self._canvas.disc(place, 0.035, ROUTE)

    def _numbers(self) -> None:
        """Numbers of the points, side by side where the robot comes by again."""
        numbers: dict[tuple[float, float], list[str]] = {}
        for k, (x, y) in enumerate(self._layout.waypoints.tolist(), start=1):
            numbers.setdefault((x, y), []).append(str(k))
        if len(self._layout.waypoints) <= FEW:
            for at, passed in numbers.items():
                self._canvas.text(at, ",".join(passed), ROUTE, size=0.5)

    def _certificate(self) -> None:
        """The way that was found, with a mark for every ten seconds."""
        if len(self._way) == 0:
            return
        times = np.arange(0.0, self._way[-1, 0], BEAT)
        self._canvas.line(self._way[:, 1:3], WAY, WAY_WIDTH)
        marks = [np.interp(times, self._way[:, 0], self._way[:, k]) for k in (1, 2)]
        for mark in np.stack(marks, axis=1):
            self._canvas.disc(mark, WAY_DOT, WAY)

    def _lane(self, law: MotionLaw) -> None:
        if isinstance(law, Appearing):
            law = law.law
        if isinstance(law, Shuttle | Passage):
            self._canvas.line((law.start, law.end), LANE)
        elif isinstance(law, Line):
            ahead = np.asarray(law.start) + AHEAD * np.asarray(law.rate)
            self._canvas.line((law.start, ahead), LANE)
        elif isinstance(law, Circle):
            self._canvas.ring(law.centre, law.radius, LANE)
        elif isinstance(law, Wander):
            self._canvas.outline(law.track, LANE)

    def _robot(self) -> None:
        x, y, heading = self._layout.start
        self._canvas.disc((x, y), ROBOT_RADIUS, ROBOT)
        self._canvas.ring((x, y), ROBOT_RADIUS, INK)
        self._arrow((x, y), (0.1 * np.cos(heading), 0.1 * np.sin(heading)))

    def _arrow(self, tail: Point, velocity: Point, color: Color = INK) -> None:
        """Arrow of two seconds of `velocity`."""
        self._canvas.arrow(tail, np.add(tail, 2.0 * np.asarray(velocity)), color)


def _rgb(color: str) -> Color:
    return tuple(round(255 * channel) for channel in COLOR_CLASSES[color].rgb)
