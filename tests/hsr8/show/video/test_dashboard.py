import numpy as np
import pytest

from hsr8.scenario.loader import load_scenario
from hsr8.show.video.dashboard import AHEAD, DONE, HEIGHT, MARKS, Dashboard, draw_timeline
from hsr8.show.video.run_video import VideoOptions


@pytest.fixture
def drawn(shown, layout):
    frame = shown()

    def draw(size, collisions=0, state="free"):
        board = Dashboard(
            layout, load_scenario("quick"), (0.0, 1.0), size, 1.0, kinds={"collision"}
        )
        scene = np.full((*board.scene_size[::-1], 3), (200, 0, 0), np.uint8)
        camera = np.full((*board.camera_size[::-1], 3), (0, 200, 0), np.uint8)
        image = board.draw(
            scene,
            camera,
            frame,
            time=0.6,
            movers=np.array([[1.0, 1.0]]),
            trail=np.zeros((0, 2)),
            events=[(0.1, "collision")] * collisions,
            state=state,
        )
        return image, board

    return draw


@pytest.mark.parametrize("size", [(64, 64), (1280, 720), (400, 1000)])
def test_scene_and_camera_are_shown_at_any_size(drawn, size):
    image, board = drawn(size)
    assert image.shape == (size[1], size[0], 3)
    width, height = board.scene_size
    red = (image[:height, :width] == (200, 0, 0)).all(axis=-1)
    green = (image[: board.camera_size[1], -board.camera_size[0] :] == (0, 200, 0)).all(axis=-1)
    assert red.mean() > 0.7
    assert green.mean() > 0.3
    assert abs(board.camera_size[0] / board.camera_size[1] - 4 / 3) < 0.1 or size[0] > size[1] * 1.7


def test_collisions_are_shown(drawn):
    calm, alarmed = drawn((1280, 720))[0], drawn((1280, 720), collisions=2)[0]
    rows, columns = np.nonzero((calm != alarmed)[:-10].any(axis=-1))  # above the timeline
    assert rows.min() > 660
    assert columns.max() - columns.min() < 60


@pytest.mark.parametrize("size", [VideoOptions().size, (1920, 1080)])
def test_values_have_names_from_the_default_size_on(drawn, size):
    image, board = drawn(size)
    width, height = board.scene_size
    band = image[height:, :width]
    names = band[: round(0.4 * len(band))].max(axis=2) > 100
    assert names.any(axis=0).sum() > width // 10
    assert names[:, width // 2 :].any()


def strip_at(time, events=()):
    image = np.zeros((40, 101, 3), np.uint8)
    draw_timeline(image, (10.0, 20.0), time, events)
    assert not image[: -round(HEIGHT * 40)].any()
    return [tuple(pixel) for pixel in image[-1].tolist()]


def test_elapsed_time_is_bright():
    strip = strip_at(15.0)
    assert strip[:50] == [DONE] * 50
    assert strip[51:] == [AHEAD] * 50


def test_events_are_marked_at_their_time_and_falls_on_top():
    events = [
        (12.0, "push"),
        (12.0, "fall"),
        (18.0, "push"),
        (19.0, "unheard of"),
        (5.0, "push"),
    ]
    strip = strip_at(10.0, events)
    assert strip[20] == MARKS["fall"]
    assert strip[82] == MARKS["push"]
    assert MARKS["push"] not in strip[:70]
    assert set(strip) == {AHEAD, MARKS["fall"], MARKS["push"]}
