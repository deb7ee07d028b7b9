import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.vision.scene import CAMERA, at, beacon, paint, pose
from vision.color import (
    COLOR_CLASSES,
    TABLE_SIZE,
    ColorClass,
    ColorTable,
    labels_of,
    load_table,
    save_table,
)
from vision.color_learning import IGNORED, learn
from vision.detector import Detector
from vision.errors import VisionError
from vision.parameters import VisionParameters

TABLE = ColorTable()
NAMES = ("", *COLOR_CLASSES)


def label_of(rgb: tuple[float, ...], light: float) -> str:
    pixel = np.clip(np.round(255.0 * light * np.array(rgb)), 0, 255).astype(np.uint8)
    return NAMES[TABLE.classify(pixel[None, None])[0, 0]]


@pytest.mark.parametrize("name", COLOR_CLASSES)
@pytest.mark.parametrize("brightness", [0.4, 1.0, 1.6])
@pytest.mark.parametrize("shade", [0.4, 1.0])
def test_painted_objects_keep_their_class_in_any_light(
    name: str, brightness: float, shade: float
) -> None:
    assert label_of(COLOR_CLASSES[name].rgb, brightness * shade) == name


@given(
    grey=st.integers(0, 255),
    tint=st.tuples(*[st.floats(0.92, 1.0)] * 3),
    light=st.floats(0.15, 1.0),
)
def test_greys_and_pale_floors_have_no_class(
    grey: int, tint: tuple[float, float, float], light: float
) -> None:
    assert label_of(tuple(t * grey / 255.0 for t in tint), light) == ""


def test_classes_that_claim_the_same_color_are_refused() -> None:
    red = COLOR_CLASSES["red"]
    pink = ColorClass("pink", "obstacle", (0.6, 0.1, 0.2), (160.0, 175.0))
    with pytest.raises(VisionError, match=r"'red'.*'pink'"):
        ColorTable({"red": red, "pink": pink})


RNG = np.random.default_rng(0)


def test_labels_are_those_of_the_rgb555_code_that_opencv_makes():
    image = RNG.integers(0, 256, (37, 53, 3)).astype(np.uint8)
    table = RNG.integers(0, 8, TABLE_SIZE).astype(np.uint8)
    codes = cv2.cvtColor(image, cv2.COLOR_RGB2BGR555).view(np.uint16).reshape(image.shape[:2])
    labels = labels_of(image, table)
    assert np.array_equal(labels, table[codes])


def test_a_table_comes_back_as_it_was(tmp_path) -> None:
    save_table(ColorTable(), tmp_path / "t.npz")
    back = load_table(tmp_path / "t.npz")
    assert np.array_equal(back.labels, ColorTable().labels)
    assert [c.name for c in back.classes] == list(COLOR_CLASSES)


STORED = np.array(list(COLOR_CLASSES))


@pytest.mark.parametrize(
    ("arrays", "message"),
    [
        ({"names": STORED}, "not a colour table"),
        ({"labels": np.zeros(1 << 15, np.uint8), "names": np.array(["pink"])}, "pink"),
        ({"labels": np.zeros(7, np.uint8), "names": STORED}, "32768"),
        ({"labels": np.full(1 << 15, 8, np.uint8), "names": STORED}, "label 8"),
    ],
)
def test_wrong_archives_are_refused(tmp_path, arrays, message) -> None:
    np.savez(tmp_path / "t.npz", **arrays)
    with pytest.raises(VisionError, match=message):
        load_table(tmp_path / "t.npz")


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
