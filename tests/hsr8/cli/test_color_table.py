import json

import cv2
import numpy as np
import pytest

from hsr8.cli.color_table import main, mask_colors
from hsr8.cli.options import ColorTable
from hsr8.errors import UsageError
from hsr8.scenario.loader import load_scenario
from vision.color import load_table


@pytest.fixture
def image_path(tmp_path):
    """A red square on grey with its mask; returns the path of the image."""
    rng = np.random.default_rng(0)
    image = rng.normal(140.0, 3.0, (40, 50, 3))
    mask = np.zeros((40, 50, 3), np.uint8)
    image[10:20, 10:30] = rng.normal((150.0, 25.0, 22.0), 3.0, (10, 20, 3))
    mask[10:20, 10:30] = mask_colors()["red"]
    cv2.imwrite(str(tmp_path / "a.png"), image[:, :, ::-1].astype(np.uint8))
    cv2.imwrite(str(tmp_path / "a.mask.png"), mask[:, :, ::-1])
    return tmp_path / "a.png"


def test_a_learned_table_is_used_in_a_scenario(image_path, tmp_path, capsys):
    out = tmp_path / "colours.npz"
    assert main(ColorTable((image_path,), out, json=True)) == 0
    rows = {r["class"]: r for r in json.loads(capsys.readouterr().out)["classes"]}
    assert rows["red"]["pixels"] == 200
    assert rows["red"]["recognized"] > 0.99
    assert rows["background"]["recognized"] > 0.99
    assert load_table(out).labels.max() == 1
    assert load_scenario("quick", [f"vision.color_table={out}"]).vision.color_table == str(out)
    assert main(ColorTable((image_path,), out)) == 0
    assert "red" in capsys.readouterr().out


def test_an_unknown_mask_color_is_refused_with_its_pixel(image_path):
    path = image_path.with_name("a.mask.png")
    mask = cv2.imread(str(path))
    mask[3, 7] = (0, 0, 250)
    cv2.imwrite(str(path), mask)
    with pytest.raises(UsageError, match=r"\(7, 3\).*\(250, 0, 0\).*red"):
        main(ColorTable((image_path,)))
