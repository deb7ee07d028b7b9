import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vision.color import COLOR_CLASSES, ColorClass, ColorTable
from vision.errors import VisionError

TABLE = ColorTable()
NAMES = ("", *COLOR_CLASSES)


def label_of(rgb: tuple[float, ...], light: float) -> str:
    pixel = np.clip(np.round(255.0 * light * np.array(rgb)), 0, 255).astype(np.uint8)
    return NAMES[TABLE.classify(pixel[None, None])[0, 0]]


@pytest.mark.parametrize("name", COLOR_CLASSES)
@pytest.mark.parametrize("brightness", [0.4, 0.6, 0.8, 1.0, 1.3, 1.6])
@pytest.mark.parametrize("shade", [0.4, 0.7, 1.0])
def test_painted_objects_keep_their_class_in_any_light(
    name: str, brightness: float, shade: float
) -> None:
    assert label_of(COLOR_CLASSES[name].rgb, brightness * shade) == name


@pytest.mark.parametrize("color", COLOR_CLASSES.values(), ids=lambda c: c.name)
def test_paint_is_never_so_bright_that_strong_light_clips_it(color: ColorClass) -> None:
    assert all(0.05 <= channel <= 0.65 for channel in color.rgb)


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


@pytest.mark.parametrize(
    "image",
    [
        np.zeros((4, 4, 3)),
        np.zeros((4, 4), np.uint8),
        np.zeros((4, 4, 4), np.uint8),
        np.zeros((0, 4, 3), np.uint8),
    ],
    ids=["float", "grey", "rgba", "empty"],
)
def test_only_rgb_images_are_classified(image: np.ndarray) -> None:
    with pytest.raises(VisionError, match=r"\(height, width, 3\)"):
        TABLE.classify(image)


def test_a_view_that_is_not_contiguous_is_classified_like_its_copy() -> None:
    image = np.random.default_rng(1).integers(0, 256, (20, 30, 3), dtype=np.uint8)
    assert np.array_equal(TABLE.classify(image[::2, ::-1]), TABLE.classify(image[::2, ::-1].copy()))
