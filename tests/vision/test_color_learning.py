import numpy as np
import pytest

from tests.vision.scene import CAMERA, at, beacon, paint, pose
from vision.color import COLOR_CLASSES, ColorTable, save_table
from vision.color_learning import IGNORED, learn
from vision.detector import Detector
from vision.errors import VisionError
from vision.parameters import VisionParameters

VIEW = pose(tilt=-0.3)
SCENE = [
    at(0.8, -25.0, "red"),
    at(0.9, -9.0, "green"),
    at(1.0, 7.0, "blue"),
    at(0.9, 24.0, "violet"),
    *beacon(2.2, -0.3, "yellow", "cyan"),
    *beacon(2.3, 0.7, "cyan", "magenta"),
    *beacon(2.2, 0.3, "magenta", "yellow"),
]


def noisy(image: np.ndarray, seed: int, sigma: float = 3.0) -> np.ndarray:
    grain = np.random.default_rng(seed).normal(0.0, sigma, image.shape)
    return np.clip(np.round(image + grain), 0, 255).astype(np.uint8)


@pytest.fixture(scope="module")
def learnt() -> ColorTable:
    image = paint(SCENE, VIEW)
    return learn([(noisy(image, 1), ColorTable().classify(image))])


@pytest.mark.parametrize("brightness", [0.5, 1.0, 1.6])
def test_a_learned_table_gives_the_detections_of_the_built_in_one(
    learnt, tmp_path, brightness
) -> None:
    save_table(learnt, tmp_path / "colours.npz")
    with_table = VisionParameters(color_table=str(tmp_path / "colours.npz"))
    image = noisy(paint(SCENE, VIEW, brightness), 2)
    result, expected = (
        {d.label: d for d in Detector(CAMERA, parameters).detect(image, VIEW)}
        for parameters in (with_table, VisionParameters())
    )
    assert result.keys() == expected.keys()
    assert len(result) == 7
    for label, d in expected.items():
        assert result[label].distance == pytest.approx(
            d.distance, abs=3.0 * d.covariance[0, 0] ** 0.5
        )


def test_colors_unlike_every_label_are_background(learnt) -> None:
    orange = np.full((4, 4, 3), (200, 100, 20), np.uint8)
    assert not learnt.classify(orange).any()
    assert not learnt.classify(np.full((4, 4, 3), 5, np.uint8)).any()


def test_unlabelled_pixels_are_ignored() -> None:
    image = paint(SCENE, VIEW)
    labels = ColorTable().classify(image)
    labels[labels == 1] = IGNORED
    assert not (learn([(image, labels)]).labels == 1).any()


@pytest.mark.parametrize(
    ("labels", "message"),
    [
        (np.zeros((4, 5), np.uint8), "shape"),
        (np.full((4, 4), len(COLOR_CLASSES) + 1, np.uint8), "got label"),
        (np.zeros((4, 4), np.uint8), "background"),
    ],
)
def test_wrong_labels_are_refused(labels: np.ndarray, message: str) -> None:
    with pytest.raises(VisionError, match=message):
        learn([(np.full((4, 4, 3), 90, np.uint8), labels)])
