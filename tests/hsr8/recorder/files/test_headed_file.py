import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.errors import UsageError
from hsr8.recorder.files.headed_file import HeadedWriter, read_headed

MAGIC = b"MAGIC123"
headers = st.dictionaries(st.text(max_size=5), st.integers() | st.lists(st.text(max_size=3)))
rows = st.lists(st.binary(min_size=8, max_size=8), max_size=5)


def write(file, header, contents):
    writer = HeadedWriter(file, MAGIC, header)
    for row in contents:
        writer.write(row)
    writer.close()


@given(header=headers, contents=rows, more=rows)
def test_header_and_rows_come_back_and_a_file_is_gone_on_with(
    tmp_path_factory, header, contents, more
):
    file = tmp_path_factory.mktemp("h") / "f"
    write(file, header, contents)
    write(file, header, more)
    assert read_headed(file, MAGIC, "list") == (header, b"".join(contents + more))


@given(header=headers)
def test_rows_are_aligned(tmp_path_factory, header):
    file = tmp_path_factory.mktemp("h") / "f"
    write(file, header, [])
    assert file.stat().st_size % 8 == 0


@given(header=headers, cut=st.integers(0, 200))
def test_a_file_cut_in_its_header_is_refused_and_never_misread(tmp_path_factory, header, cut):
    file = tmp_path_factory.mktemp("h") / "f"
    write(file, header, [b"eight ch"])
    content = file.read_bytes()
    file.write_bytes(content[:cut])
    if cut < len(content) - 8:
        with pytest.raises(UsageError, match=r"no whole header|is no list"):
            read_headed(file, MAGIC, "list")
    else:
        assert read_headed(file, MAGIC, "list")[0] == header


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"OTHER123" + bytes(8), "is no list"),
        (b"", "is no list"),
        (MAGIC[:-1] + b"2" + bytes(8), "is a list of format 2"),
        (MAGIC + bytes(7), "no whole header"),
        (MAGIC + struct.pack("<Q", 2) + b"[]", "no whole header"),
        (MAGIC + struct.pack("<Q", 2) + b"{x", "no whole header"),
        (MAGIC + struct.pack("<Q", 2**63) + b"{}", "no whole header"),
    ],
)
def test_another_or_a_damaged_file_is_refused(tmp_path, content, message):
    (tmp_path / "f").write_bytes(content)
    with pytest.raises(UsageError, match=message):
        read_headed(tmp_path / "f", MAGIC, "list")


def test_a_missing_file_is_told(tmp_path):
    with pytest.raises(UsageError, match="cannot read the list"):
        read_headed(tmp_path / "none", MAGIC, "list")
