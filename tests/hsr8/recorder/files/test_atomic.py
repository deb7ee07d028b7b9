import json
import os

import pytest

from hsr8.recorder.files import atomic


def test_numbers_that_are_not_finite_become_null():
    value = {"a": float("nan"), "b": [1.0, float("inf")], "c": {"d": (float("-inf"), 2)}}
    assert json.loads(atomic.dumps(value)) == {"a": None, "b": [1.0, None], "c": {"d": [None, 2]}}


def test_any_file_name_is_preserved(tmp_path):
    name = os.fsdecode(b"a\xffb\xc3\xbc")
    atomic.write_json(tmp_path / "x.json", {"command": name})
    text = (tmp_path / "x.json").read_text(encoding="utf-8")
    assert json.loads(text) == {"command": name}
    assert "ü" in text


def test_a_text_with_any_file_name_is_written(tmp_path):
    atomic.write_text(tmp_path / "crash.txt", os.fsdecode(b"no file a\xffb"))
    assert (tmp_path / "crash.txt").read_bytes() == rb"no file a\udcffb"


def test_a_failed_write_leaves_the_old_file(tmp_path):
    file = tmp_path / "x.json"
    atomic.write_json(file, {"old": 1})
    with pytest.raises(TypeError):
        atomic.write_json(file, {"new": object()})
    assert json.loads(file.read_text()) == {"old": 1}
    assert [p.name for p in tmp_path.iterdir()] == ["x.json"]
