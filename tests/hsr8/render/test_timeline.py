import numpy as np

from hsr8.render.timeline import AHEAD, DONE, HEIGHT, MARKS, Timeline


def strip_at(time, events=()):
    image = np.zeros((40, 101, 3), np.uint8)
    Timeline(10.0, 20.0).draw(image, time, events)
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
