from hsr8.scenario.camera import Blackout, BrightnessStep, Camera


def test_images_are_black_from_the_start_of_a_blackout_to_its_end():
    camera = Camera(blackout=(Blackout(start=2.0, duration=1.0), Blackout(start=5.0)))
    assert [camera.black(t) for t in (1.99, 2.0, 2.99, 3.0, 5.5, 6.0)] == [
        *(False, True, True),
        *(False, True, False),
    ]


def test_a_brightness_step_stays_until_the_next():
    camera = Camera(
        brightness_step=(BrightnessStep(time=4.0, factor=1.5), BrightnessStep(time=2.0, factor=0.5))
    )
    assert [camera.light(t) for t in (0.0, 2.0, 3.9, 4.0, 99.0)] == [1.0, 0.5, 0.5, 1.5, 1.5]
