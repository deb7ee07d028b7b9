import json
import os
from concurrent.futures import ThreadPoolExecutor

import pytest

from hsr8.files import atomic


def test_numbers_that_are_not_finite_become_null():
    value = {"a": float("nan"), "b": [1.0, float("inf")], "c": {"d": (float("-inf"), 2)}}
    assert json.loads(atomic.dumps(value)) == {"a": None, "b": [1.0, None], "c": {"d": [None, 2]}}


def test_any_file_name_is_preserved(tmp_path):
    name = os.fsdecode(b"a\xffb\xc3\xbc")
    atomic.write_json(tmp_path / "x.json", {"command": name})
    text = (tmp_path / "x.json").read_text(encoding="utf-8")
    assert json.loads(text) == {"command": name}
    assert "ü" in text


def test_a_failed_write_leaves_the_old_file(tmp_path):
    file = tmp_path / "x.json"
    atomic.write_json(file, {"old": 1})
    with pytest.raises(TypeError):
        atomic.write_json(file, {"new": object()})
    assert json.loads(file.read_text()) == {"old": 1}
    assert [p.name for p in tmp_path.iterdir()] == ["x.json"]


def test_writers_of_one_file_do_not_disturb_each_other(tmp_path):
    file = tmp_path / "x.txt"
    with ThreadPoolExecutor(4) as pool:
        for future in [pool.submit(atomic.write_text, file, str(k)) for k in range(200)]:
            future.result()
    assert file.read_text() in map(str, range(200))
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize("target", ["kept.txt", "new.txt", "x.txt"])
def test_a_link_is_replaced_and_never_followed(tmp_path, target):
    outside, inside = tmp_path / "outside", tmp_path / "inside"
    outside.mkdir()
    inside.mkdir()
    (outside / "kept.txt").write_text("as it was")
    file = inside / "x.txt"
    file.symlink_to("x.txt" if target == file.name else outside / target)
    atomic.write_text(file, "new")
    assert not file.is_symlink()
    assert file.read_text() == "new"
    assert [path.read_text() for path in outside.iterdir()] == ["as it was"]


def test_a_full_disk_overwrites_no_file_behind_a_link(tmp_path, monkeypatch):
    (tmp_path / "kept.json").write_text("{}")
    (tmp_path / "x.json").symlink_to("kept.json")
    monkeypatch.setattr(atomic, "write_text", lambda *_: (_ for _ in ()).throw(OSError(28, "full")))
    with pytest.raises(OSError, match="link"):
        atomic.overwrite_json(tmp_path / "x.json", {"new": 1})
    assert (tmp_path / "kept.json").read_text() == "{}"


@pytest.mark.parametrize("kind", ["file", "folder"])
def test_an_interrupted_draft_leaves_the_target(tmp_path, kind):
    target = tmp_path / "target"
    if kind == "file":
        target.write_text("old")

    def write():
        with atomic.draft(target) as new:
            assert new.name == target.name
            if kind == "folder":
                new.mkdir()
            (new / "part" if kind == "folder" else new).write_text("new")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write()
    assert [path.read_text() for path in tmp_path.iterdir()] == ["old"] * (kind == "file")
