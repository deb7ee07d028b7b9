import numpy as np
import pytest

from hsr8.show.canvas import MARGIN, Canvas, framed

FIELD = (4.0, 2.0)
PAPER, RED, BLUE = (255, 255, 255), (200, 0, 0), (0, 0, 200)


@pytest.fixture
def canvas():
    """A hundred pixels a metre."""
    width, height = (100 * framed(FIELD)).round().astype(int).tolist()
    return Canvas(FIELD, (width, height), PAPER)


def _at(image, x, y):
    """Colour at a point of W [m]."""
    row, column = round(0.5 * image.shape[0] - 100 * y), round(0.5 * image.shape[1] + 100 * x)
    return tuple(image[row, column].tolist())


def _centre(image, color):
    """Of the pixels of a colour, in W [m]."""
    rows, columns = np.nonzero((image == color).all(axis=-1))
    x = (columns.mean() - 0.5 * image.shape[1]) / 100
    return x, (0.5 * image.shape[0] - rows.mean()) / 100


@pytest.mark.parametrize("at", [(0.0, 0.0), (1.5, -0.7), (-2.0, 1.0)])
def test_x_is_to_the_right_and_y_is_up(canvas, at):
    canvas.disc(at, 0.1, RED)
    assert _centre(canvas.image, RED) == pytest.approx(at, abs=0.01)
    covered = (canvas.image == RED).all(axis=-1).sum() / 1e4
    assert covered == pytest.approx(np.pi * 0.1**2, rel=0.15)


def test_the_field_lies_within_its_margin(canvas):
    canvas.field(RED, RED, 1)
    rows, columns = np.nonzero((canvas.image == RED).all(axis=-1))
    for pixels, side in ((rows, 0), (columns, 1)):
        assert pixels.min() == pytest.approx(100 * MARGIN, abs=1.5)
        assert canvas.image.shape[side] - pixels.max() == pytest.approx(100 * MARGIN, abs=1.5)


def test_an_image_of_any_shape_shows_the_whole_field():
    for size in ((600, 100), (100, 600)):
        canvas = Canvas(FIELD, size, PAPER)
        canvas.field(RED, RED, 1)
        assert canvas.image.shape == (size[1], size[0], 3)
        edge = np.concatenate([canvas.image[[0, -1]].reshape(-1, 3), canvas.image[:, 0]])
        assert (edge == PAPER).all()


def test_a_copy_is_independent(canvas):
    other = canvas.copy()
    other.disc((0.0, 0.0), 0.5, RED)
    assert (canvas.image == PAPER).all()


def test_areas_can_be_transparent(canvas):
    corners = ((-1.0, -0.5), (1.0, -0.5), (1.0, 0.5), (-1.0, 0.5))
    canvas.area(corners, RED)
    canvas.area(corners, BLUE, opacity=0.5)
    assert _at(canvas.image, 0.0, 0.0) == (100, 0, 100)


def test_the_top_of_a_beacon_is_drawn_on_its_bottom(canvas):
    canvas.beacon((1.0, 0.0), RED, BLUE)
    assert _at(canvas.image, 1.0, 0.0) == RED
    top, bottom = ((canvas.image == c).all(axis=-1).sum() for c in (RED, BLUE))
    assert top > 20
    assert bottom > 20


def test_an_ellipse_turns_counter_clockwise(canvas):
    canvas.ellipse((0.0, 0.0), (0.6, 0.1), np.radians(30.0), RED)
    rows, columns = np.nonzero((canvas.image != PAPER).any(axis=-1))
    x, y = columns - columns.mean(), rows.mean() - rows
    spread = np.cov(x, y)
    assert 0.5 * np.arctan2(2 * spread[0, 1], spread[0, 0] - spread[1, 1]) == pytest.approx(
        np.radians(30.0), abs=0.03
    )


def test_drawings_far_outside_are_left_out(canvas):
    canvas.line(((0.0, 0.0), (1e9, 0.0)), RED)
    assert (canvas.image[canvas.image.shape[0] // 2, -1] != PAPER).any()
    canvas.disc((-1e9, 1e9), 0.1, BLUE)
    assert not (canvas.image == BLUE).all(axis=-1).any()
