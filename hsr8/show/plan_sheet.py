"""Plan of a world with a title, axes in metres and a legend."""

from collections.abc import Callable, Iterator
from math import ceil, floor

import cv2
import numpy as np
from numpy.typing import NDArray

from hsr8.show.image import Color, Image, draw_text, text_width
from hsr8.show.plan_view import FLOOR, INK, LANE, PAPER, PATH, ROBOT, ROUTE, PlanView

TITLE, LETTERS = 17, 13  # font sizes [pixel]
PAD, LINE = 14, 24  # margin and height of a row of the legend [pixel]
TICK = 5  # length of a tick [pixel]
MARGIN_LEFT, MARGIN_BELOW = 44, 44  # room for the numbers of the axes [pixel]
STEPS = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0)  # between ticks [m]
MAX_TICKS = 9  # along the longer side
RADIUS = 6  # of the symbols [pixel]
Array = NDArray[np.float64]
Symbol = Callable[[Image, tuple[int, int]], None]
"""Draws the symbol of an entry around a pixel."""


def plan_sheet(plan: PlanView, title: str) -> Image:
    """Return the plan below its title and above its legend (height, width, 3), RGB.

    Args:
        plan: plan to draw.
        title: one line, such as the name of the scenario and the seed.
    """
    plain = plan.draw()
    half = 0.5 * np.asarray(plan.layout.field_size)
    left, bottom = plan.pixel(-half)
    margin, below = max(0, MARGIN_LEFT - left), max(0, MARGIN_BELOW - (len(plain) - bottom))
    above = max(0, 2 * LETTERS - plan.pixel(half)[1])
    drawn = cv2.copyMakeBorder(
        plain, above, below, margin, margin, cv2.BORDER_CONSTANT, value=PAPER
    )
    _draw_axes(drawn, plan, (margin, above))
    width = drawn.shape[1]
    entries = [*_entries(plan)]
    cell = 5 * RADIUS + PAD + max(text_width(text, LETTERS) for text, _ in entries)
    columns = max(1, (width - PAD) // cell)
    rows = -(-len(entries) // columns)
    top = TITLE + 2 * PAD
    page = np.full((top + len(drawn) + rows * LINE + PAD, width, 3), PAPER, np.uint8)
    draw_text(page, (PAD, PAD + TITLE), title, INK, TITLE, strong=True)
    page[top : top + len(drawn)] = drawn
    for k, (text, symbol) in enumerate(entries):
        column = PAD + k % columns * cell + 2 * RADIUS
        row = top + len(drawn) + k // columns * LINE + LINE // 2
        symbol(page, (column, row))
        draw_text(page, (column + 3 * RADIUS, row + LETTERS // 3), text, INK, LETTERS)
    return page


def _draw_axes(image: Image, plan: PlanView, offset: tuple[int, int]) -> None:
    """Draw ticks in metres along the lower and the left border of the field.

    Args:
        image: image to draw into.
        plan: the plan in it.
        offset: column and row of the plan in the image [pixel].
    """

    def pixel(at: Array) -> tuple[int, int]:
        u, v = plan.pixel(at)
        return u + offset[0], v + offset[1]

    half = 0.5 * np.asarray(plan.layout.field_size)
    longer = 2.0 * float(half.max())
    step = next((s for s in STEPS if longer / s <= MAX_TICKS), STEPS[-1])
    gap = TICK + 3
    for axis, side in enumerate(half.tolist()):
        for k in range(ceil(-side / step), floor(side / step) + 1):
            at = -half
            at[axis] = k * step
            u, v = pixel(at)
            tip = (u, v + TICK) if axis == 0 else (u - TICK, v)
            cv2.line(image, (u, v), tip, INK, 1)
            text = f"{k * step:g}"
            if axis == 0:
                draw_text(image, (u, v + gap + LETTERS), text, INK, LETTERS, side="middle")
            else:
                draw_text(image, (u - gap, v + LETTERS // 3), text, INK, LETTERS, side="right")
    right, bottom = pixel(half * (1.0, -1.0))
    left, top = pixel(half * (-1.0, 1.0))
    draw_text(image, (right, bottom + gap + 2 * LETTERS + 4), "x [m]", INK, LETTERS, side="right")
    draw_text(image, (left, top - gap), "y [m]", INK, LETTERS, side="right")


def _entries(plan: PlanView) -> Iterator[tuple[str, Symbol]]:
    """Yield text and symbol of everything in the plan."""
    layout = plan.layout
    yield "robot at the start", _disc(ROBOT, INK)
    if len(layout.waypoints) > 1 or layout.endless:
        yield "via point, in order", _disc(ROUTE, ROUTE, RADIUS // 2)
    if len(layout.waypoints) and not layout.endless:
        yield "goal", _goal
    if layout.static:
        yield "obstacle", _disc(LANE, LANE)
    if layout.movers:
        yield "mover, its motion in 2 s and its lane", _mover
    if plan.certified:
        yield "collision-free path, a dot every 10 s", _path
    if layout.beacons:
        yield "beacon", _beacon
    if layout.bumps:
        yield "bump", _disc(FLOOR, INK)


def _disc(fill: Color, rim: Color, radius: int = RADIUS) -> Symbol:
    def draw(image: Image, at: tuple[int, int]) -> None:
        cv2.circle(image, at, radius, fill, -1, cv2.LINE_AA)
        cv2.circle(image, at, radius, rim, 1, cv2.LINE_AA)

    return draw


def _goal(image: Image, at: tuple[int, int]) -> None:
    cv2.circle(image, at, RADIUS + 1, ROUTE, 1, cv2.LINE_AA)
    cv2.circle(image, at, RADIUS // 2, ROUTE, -1, cv2.LINE_AA)


def _mover(image: Image, at: tuple[int, int]) -> None:
    (u, v), r = at, RADIUS
    cv2.line(image, (u - 2 * r, v), (u + 2 * r - 2, v), LANE, 1)
    _disc(LANE, INK)(image, at)
    cv2.arrowedLine(image, at, (u + 2 * r - 2, v), INK, 1, cv2.LINE_AA, 0, 0.4)


def _path(image: Image, at: tuple[int, int]) -> None:
    u, v = at
    cv2.line(image, (u - 2 * RADIUS, v), (u + 2 * RADIUS - 4, v), PATH, 2)
    cv2.circle(image, at, RADIUS // 2, PATH, -1, cv2.LINE_AA)


def _beacon(image: Image, at: tuple[int, int]) -> None:
    _disc((203, 30, 140), (203, 30, 140))(image, at)
    _disc((20, 145, 160), (20, 145, 160), RADIUS // 2)(image, at)
