import numpy as np
import pytest

from hsr8.scenario.sensors import CameraNoise
from hsr8.world.camera.image_noise import ImageNoise

SHAPE = (60, 80)


def make(seed=0, **noise):
    return ImageNoise(
        CameraNoise(**{"pixel": 0.0, "exposure": 0.0, **noise}), SHAPE, np.random.default_rng(seed)
    )


def grey(value=100):
    return np.full((*SHAPE, 3), value, np.uint8)


def test_no_noise_leaves_an_image_as_it_is():
    noise = make()
    assert np.array_equal(noise.apply(grey(), 0.0), grey())
    assert noise.light() == 1.0
    assert noise.missed(5, 0.0) == ()


def test_the_same_seed_spoils_alike_and_another_one_otherwise():
    images = [[make(seed, pixel=4.0).apply(grey(), 1.0)] for seed in (1, 1, 2)]
    assert np.array_equal(images[0], images[1])
    assert not np.array_equal(images[0], images[2])


@pytest.mark.parametrize("sigma", [1.0, 3.0, 10.0])
def test_grain_has_the_strength_asked_for_and_changes_from_image_to_image(sigma):
    noise = make(pixel=sigma)
    stack = np.array([noise.apply(grey(), 0.0) for _ in range(20)], float)
    assert abs(stack.mean() - 100.0) < 0.1
    assert stack.std() == pytest.approx(np.hypot(sigma, 12**-0.5), rel=0.03)
    assert not np.array_equal(stack[0], stack[1])


def test_shares_and_rates_are_kept_on_average():
    noise = make(exposure=0.05)
    missed = [len(noise.missed(50, 0.2)) for _ in range(200)]
    assert np.mean(missed) == pytest.approx(10.0, rel=0.05)
    lights = [noise.light() for _ in range(500)]
    assert np.std(lights) == pytest.approx(0.05, rel=0.1)


def test_false_blobs_are_painted_in_colors_of_things():
    noise = make()
    spoiled = noise.apply(grey(128), 20.0)
    painted = (spoiled != 128).any(axis=2)
    assert 0.02 < painted.mean() < 1.0
    colors = spoiled[painted].astype(int)
    assert np.all(colors.max(axis=1) > 1.5 * colors.min(axis=1))
