import os

import numpy as np
import pytest

from vision.color import COLOR_CLASSES, ColorTable
from vision.color_file import MAX_SIZE, load_table, save_table
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


def test_only_small_regular_files_are_read(tmp_path) -> None:
    os.mkfifo(tmp_path / "fifo.npz")
    (tmp_path / "zero.npz").symlink_to("/dev/zero")
    (tmp_path / "folder.npz").mkdir()
    for name in ("fifo", "zero", "folder"):
        with pytest.raises(VisionError, match="not a regular file"):
            load_table(tmp_path / f"{name}.npz")
    (tmp_path / "long.npz").write_bytes(bytes(MAX_SIZE + 1))
    np.savez_compressed(tmp_path / "bomb.npz", labels=np.zeros(MAX_SIZE, np.uint8), names=NAMES)
    assert (tmp_path / "bomb.npz").stat().st_size < MAX_SIZE
    for name in ("long", "bomb"):
        with pytest.raises(VisionError, match="not a colour table"):
            load_table(tmp_path / f"{name}.npz")


def test_a_missing_file_is_named(tmp_path) -> None:
    with pytest.raises(VisionError, match=r"nowhere\.npz: No such file"):
        load_table(tmp_path / "nowhere.npz")
