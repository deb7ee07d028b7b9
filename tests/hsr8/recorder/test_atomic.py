import json

import pytest

from hsr8.recorder import atomic


def test_what_is_not_finite_becomes_null_at_any_depth():
    value = {"a": float("nan"), "b": [1.0, float("inf")], "c": {"d": (float("-inf"), 2)}}
    assert json.loads(atomic.dumps(value)) == {"a": None, "b": [1.0, None], "c": {"d": [None, 2]}}


def test_a_failed_write_leaves_the_old_file(tmp_path):
    file = tmp_path / "x.json"
    atomic.write_json(file, {"old": 1})
    with pytest.raises(TypeError):
        atomic.write_json(file, {"new": object()})
    assert json.loads(file.read_text()) == {"old": 1}
    assert [p.name for p in tmp_path.iterdir()] == ["x.json"]
