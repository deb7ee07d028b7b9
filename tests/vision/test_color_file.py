import numpy as np
import pytest

from vision.color import COLOR_CLASSES, ColorTable
from vision.color_file import load_table, save_table
from vision.errors import VisionError


def test_a_table_comes_back_as_it_was(tmp_path) -> None:
    save_table(ColorTable(), tmp_path / "t.npz")
    back = load_table(tmp_path / "t.npz")
    assert np.array_equal(back.labels, ColorTable().labels)
    assert [c.name for c in back.classes] == list(COLOR_CLASSES)


NAMES = np.array(list(COLOR_CLASSES))


@pytest.mark.parametrize(
    ("arrays", "message"),
    [
        ({"names": NAMES}, "not a colour table"),
        ({"labels": np.zeros(1 << 15, np.uint8), "names": np.array(["pink"])}, "pink"),
        ({"labels": np.zeros(7, np.uint8), "names": NAMES}, "32768"),
        ({"labels": np.full(1 << 15, 8, np.uint8), "names": NAMES}, "label 8"),
    ],
)
def test_wrong_archives_are_refused(tmp_path, arrays, message) -> None:
    np.savez(tmp_path / "t.npz", **arrays)
    with pytest.raises(VisionError, match=message):
        load_table(tmp_path / "t.npz")


@pytest.mark.parametrize("content", [b"", b"no archive", b"PK\x03\x04 broken"])
def test_other_files_are_refused(tmp_path, content) -> None:
    (tmp_path / "t.npz").write_bytes(content)
    with pytest.raises(VisionError, match="not a colour table"):
        load_table(tmp_path / "t.npz")


def test_a_missing_file_is_named(tmp_path) -> None:
    with pytest.raises(VisionError, match=r"nowhere\.npz: No such file"):
        load_table(tmp_path / "nowhere.npz")
