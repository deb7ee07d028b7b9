"""A world seen from above, as a picture for people."""

from itertools import pairwise

import numpy as np

from hsr8.world.canvas import Canvas, Colour, Image, Point, framed
from hsr8.world.layout import Layout
from hsr8.world.motion import Circle, Line, Shuttle
from hsr8.world.passage import Passage
from hsr8.world.wander import Wander
from vision.colour import COLOUR_CLASSES

INK = (60, 58, 55)
PAPER = (246, 246, 244)
FLOOR = (226, 225, 221)
WHITE = (255, 255, 255)
ROUTE = (235, 125, 20)
ROBOT = (250, 250, 250)
FEW = 12  # more way points than this are shown paler and without their numbers
AHEAD = 60.0  # the lane of a mover that never turns is drawn so far ahead [s]


class PlanView:
    """Draws a layout, x of W to the right and y up.

    Args:
        layout: to draw.
        size: of the longer side of the picture [pixel].
    """

    def __init__(self, layout: Layout, size: int = 900) -> None:
        self._layout = layout
        extent = framed(layout.field_size)
        width, height = np.ceil(extent * (size / extent.max())).astype(int).tolist()
        self._canvas = Canvas(layout.field_size, (width, height), PAPER)

    def draw(self) -> Image:
        """Picture (height, width, 3), RGB."""
        canvas = self._canvas
        canvas.field(FLOOR, INK, 2)
        self._route()
        for obstacle in self._layout.obstacles:
            if obstacle.motion is not None:
                self._lane(obstacle.motion)
        for i, obstacle in enumerate(self._layout.obstacles):
            canvas.disc(obstacle.position, obstacle.radius, _rgb(obstacle.colour))
            if obstacle.motion is not None:
                self._arrow(obstacle.position, obstacle.motion.velocity(0.0))
            canvas.text(obstacle.position, str(i), WHITE, centred=True)
        for beacon in self._layout.beacons:
            canvas.beacon(beacon.position, _rgb(beacon.top), _rgb(beacon.bottom))
        self._robot()
        return canvas.image

    def _route(self) -> None:
        places = [np.asarray(self._layout.start[:2]), *self._layout.waypoints]
        last = len(places) - 1
        colour = ROUTE if last < FEW else tuple((np.add(ROUTE, FLOOR) // 2).tolist())
        for leg in pairwise(places):
            self._canvas.line(leg, colour)
        for k, place in enumerate(places[1:], start=1):
            if k == last and not self._layout.endless:
                self._canvas.ring(place, 0.10, ROUTE)
                if self._layout.goal_heading is not None:
                    heading = self._layout.goal_heading
                    self._arrow(place, (0.12 * np.cos(heading), 0.12 * np.sin(heading)), ROUTE)
            self._canvas.disc(place, 0.035, ROUTE)
            if last <= FEW:
                self._canvas.text(place, str(k), ROUTE)

    def _lane(self, law: object) -> None:
        if isinstance(law, Shuttle):
            self._canvas.line((law.start, law.end), INK)
        elif isinstance(law, Line):
            ahead = np.asarray(law.start) + AHEAD * np.asarray(law.rate)
            self._canvas.line((law.start, ahead), INK)
        elif isinstance(law, Circle):
            self._canvas.ring(law.centre, law.radius, INK)
        elif isinstance(law, Passage):
            self._canvas.line((law.start, law.end), INK)
        elif isinstance(law, Wander):
            self._canvas.outline(law.track, INK)

    def _robot(self) -> None:
        x, y, heading = self._layout.start
        self._canvas.disc((x, y), 0.12, ROBOT)
        self._canvas.ring((x, y), 0.12, INK)
        self._arrow((x, y), (0.1 * np.cos(heading), 0.1 * np.sin(heading)))

    def _arrow(self, tail: Point, velocity: Point, colour: Colour = INK) -> None:
        """Arrow of two seconds of `velocity`."""
        self._canvas.arrow(tail, np.add(tail, 2.0 * np.asarray(velocity)), colour)


def _rgb(colour: str) -> Colour:
    return tuple(round(255 * channel) for channel in COLOUR_CLASSES[colour].rgb)
