import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.errors import UsageError
from hsr8.recorder.files.binary import head, read_rows

MAGIC = b"MAGIC123"
headers = st.dictionaries(st.text(max_size=5), st.integers() | st.lists(st.text(max_size=3)))
rows = st.lists(st.binary(min_size=8, max_size=8), max_size=5)


@given(header=headers, contents=rows, cut=st.integers(0, 200))
def test_header_and_rows_are_read_and_a_cut_header_is_refused(
    tmp_path_factory, header, contents, cut
):
    file = tmp_path_factory.mktemp("h") / "f"
    start = head(MAGIC, header)
    assert len(start) % 8 == 0
    content = start + b"".join(contents)
    file.write_bytes(content)
    assert read_rows(file, MAGIC, "list") == (header, b"".join(contents))
    file.write_bytes(content[:cut])
    if cut < len(start):
        with pytest.raises(UsageError, match=r"incomplete header|not a list"):
            read_rows(file, MAGIC, "list")
    else:
        assert read_rows(file, MAGIC, "list")[0] == header


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"OTHER123" + bytes(8), "not a list"),
        (b"", "not a list"),
        (MAGIC[:-1] + b"2" + bytes(8), "list of format 2"),
        (MAGIC + bytes(7), "incomplete header"),
        (MAGIC + struct.pack("<Q", 2) + b"[]", "incomplete header"),
        (MAGIC + struct.pack("<Q", 2) + b"{x", "incomplete header"),
        (MAGIC + struct.pack("<Q", 2**63) + b"{}", "incomplete header"),
    ],
)
def test_another_or_a_damaged_file_is_refused(tmp_path, content, message):
    (tmp_path / "f").write_bytes(content)
    with pytest.raises(UsageError, match=message):
        read_rows(tmp_path / "f", MAGIC, "list")
