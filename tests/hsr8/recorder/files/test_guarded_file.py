from itertools import accumulate
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.errors import RecordingFailed, UsageError
from hsr8.recorder.files.guarded_file import GuardedWriter, read_payloads

MAGIC = b"MAGIC123"
payloads = st.lists(st.binary(min_size=1, max_size=40), min_size=1, max_size=4)


def write(file, contents):
    writer = GuardedWriter(file, MAGIC)
    for content in contents:
        writer.write(content)
    writer.close()


def read(file, *, whole=True):
    found = read_payloads(file, MAGIC, file="list", payload="item", whole=whole)
    return [content for _, content in found]


@given(contents=payloads, more=payloads)
def test_what_is_written_is_read_and_gone_on_with(tmp_path_factory, contents, more):
    file = tmp_path_factory.mktemp("g") / "f"
    write(file, contents)
    assert read(file) == contents
    write(file, more)
    assert read(file) == contents + more


@given(contents=payloads, cut=st.integers(8, 200))
def test_a_cut_costs_the_payloads_from_there_on(tmp_path_factory, contents, cut):
    file = tmp_path_factory.mktemp("g") / "f"
    write(file, contents)
    ends = list(accumulate((8 + len(c) for c in contents), initial=len(MAGIC)))
    cut = min(cut, ends[-1])
    file.write_bytes(file.read_bytes()[:cut])
    kept = sum(end <= cut for end in ends[1:])
    assert read(file, whole=False) == contents[:kept]
    if cut not in ends:
        with pytest.raises(UsageError, match=f"cut off in item {kept}, at byte {ends[kept]}"):
            read(file)


@given(contents=payloads, data=st.data(), flip=st.integers(1, 255))
def test_a_changed_payload_is_named(tmp_path_factory, contents, data, flip):
    file = tmp_path_factory.mktemp("g") / "f"
    write(file, contents)
    k = data.draw(st.integers(0, len(contents) - 1))
    start = len(MAGIC) + sum(8 + len(c) for c in contents[:k]) + 8
    place = start + data.draw(st.integers(0, len(contents[k]) - 1))
    damaged = bytearray(file.read_bytes())
    damaged[place] ^= flip
    file.write_bytes(damaged)
    with pytest.raises(UsageError, match=f"damaged in item {k}, at byte {start - 8}"):
        read(file, whole=False)


def test_another_file_is_refused(tmp_path):
    with pytest.raises(UsageError, match="cannot read the list"):
        read(tmp_path / "none")
    (tmp_path / "other").write_bytes(b"something else")
    with pytest.raises(UsageError, match="is no list"):
        read(tmp_path / "other")
    (tmp_path / "old").write_bytes(MAGIC[:-1] + b"2")
    with pytest.raises(UsageError, match="is a list of format 2"):
        read(tmp_path / "old")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_full_disk_is_told_when_it_is_flushed():
    writer = GuardedWriter(Path("/dev/full"), b"")
    writer.write(b"x")
    with pytest.raises(RecordingFailed):
        writer.flush()
    with pytest.raises(RecordingFailed):
        writer.close()
