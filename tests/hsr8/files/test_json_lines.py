import json

import pytest

from hsr8.errors import UsageError
from hsr8.files.json_lines import read_lines


def test_a_cut_line_is_left_out(tmp_path):
    file = tmp_path / "lines.jsonl"
    file.write_text('{"a": 1}\n{"a": 2}\n{"a": ')
    assert list(read_lines(file, json.loads)) == [{"a": 1}, {"a": 2}]


@pytest.mark.parametrize("damaged", [b"{", b'{"b": 1}', b"[1]", b"\xff\xfe"])
def test_a_damaged_line_is_named(tmp_path, damaged):
    file = tmp_path / "lines.jsonl"
    file.write_bytes(b'{"a": 1}\n' + damaged + b"\n")
    with pytest.raises(UsageError, match=r"lines\.jsonl:2"):
        list(read_lines(file, lambda line: json.loads(line)["a"]))
