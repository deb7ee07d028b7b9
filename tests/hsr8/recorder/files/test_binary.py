import struct
from itertools import accumulate

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.errors import UsageError
from hsr8.recorder.files.binary import guarded, head, read_payloads, read_rows

MAGIC = b"MAGIC123"
payloads = st.lists(st.binary(min_size=1, max_size=40), min_size=1, max_size=4)
headers = st.dictionaries(st.text(max_size=5), st.integers() | st.lists(st.text(max_size=3)))
rows = st.lists(st.binary(min_size=8, max_size=8), max_size=5)


def write(file, contents):
    file.write_bytes(MAGIC + b"".join(map(guarded, contents)))


def read(file, *, whole=True):
    items = read_payloads(file, MAGIC, file="list", payload="item", whole=whole)
    return [content for _, content in items]


@given(contents=payloads, cut=st.integers(8, 200))
def test_a_cut_loses_only_the_payloads_behind_it(tmp_path_factory, contents, cut):
    file = tmp_path_factory.mktemp("g") / "f"
    write(file, contents)
    assert read(file) == contents
    ends = list(accumulate((8 + len(c) for c in contents), initial=len(MAGIC)))
    cut = min(cut, ends[-1])
    file.write_bytes(file.read_bytes()[:cut])
    kept = sum(end <= cut for end in ends[1:])
    assert read(file, whole=False) == contents[:kept]
    if cut not in ends:
        with pytest.raises(UsageError, match=f"cut off in item {kept}, at byte {ends[kept]}"):
            read(file)


@given(contents=payloads, data=st.data(), flip=st.integers(1, 255))
def test_a_damaged_payload_is_located(tmp_path_factory, contents, data, flip):
    file = tmp_path_factory.mktemp("g") / "f"
    write(file, contents)
    k = data.draw(st.integers(0, len(contents) - 1))
    start = len(MAGIC) + sum(8 + len(c) for c in contents[:k]) + 8
    offset = start + data.draw(st.integers(0, len(contents[k]) - 1))
    damaged = bytearray(file.read_bytes())
    damaged[offset] ^= flip
    file.write_bytes(damaged)
    with pytest.raises(UsageError, match=f"damaged in item {k}, at byte {start - 8}"):
        read(file, whole=False)


def test_a_missing_file_is_a_usage_error(tmp_path):
    with pytest.raises(UsageError, match="cannot read the list"):
        read(tmp_path / "none")


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
