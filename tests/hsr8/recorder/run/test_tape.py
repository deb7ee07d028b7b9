import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from hsr8.errors import UsageError
from hsr8.recorder.files.binary import guarded
from hsr8.recorder.run.tape import MAGIC, TapeWriter, read_tape


def rows(joints):
    shape = st.tuples(st.integers(1, 3), st.just(joints))
    return hnp.arrays(np.float64, shape, elements=st.floats(allow_nan=False, width=64))


# Blocks of one tape, for robots of any number of joints.
TAPES = st.integers(1, 40).flatmap(lambda joints: st.lists(rows(joints), min_size=1, max_size=3))


def write(file, blocks):
    tape = TapeWriter(file, blocks[0].shape[1])
    tick = 0
    for rows in blocks:
        tape.mark(tick, b"world%d" % tick, b"robot")
        for row in rows:
            tape.add(row)
        tick += len(rows)
    tape.mark(tick, b"end", b"robot")
    tape.close()


@given(blocks=TAPES)
def test_round_trip_is_exact(tmp_path_factory, blocks):
    file = tmp_path_factory.mktemp("t") / "tape.bin"
    write(file, blocks)
    *back, end = read_tape(file, whole=True)
    assert [b.setpoints.tobytes() for b in back] == [rows.tobytes() for rows in blocks]
    assert [b.tick for b in back] == np.cumsum([0, *map(len, blocks)])[:-1].tolist()
    assert end.setpoints.shape == (0, blocks[0].shape[1])
    assert len({b.world for b in (*back, end)}) == len(back) + 1


def test_world_and_robot_have_separate_hashes(tmp_path):
    def hashes(world, robot):
        file = tmp_path / f"{world!r}{robot!r}"
        file.unlink(missing_ok=True)
        tape = TapeWriter(file, 26)
        tape.mark(0, world, robot)
        tape.close()
        (block,) = read_tape(file, whole=True)
        return block.world, block.robot

    first = hashes(b"a", b"b")
    assert hashes(b"a", b"b") == first
    assert hashes(b"a", b"c")[0] == first[0]
    assert hashes(b"a", b"c")[1] != first[1]
    assert hashes(b"x", b"b")[0] != first[0]


def test_a_second_mark_without_ticks_replaces_the_first(tmp_path):
    tape = TapeWriter(tmp_path / "t", 26)
    tape.mark(0, b"a", b"")
    tape.mark(0, b"b", b"")
    tape.close()
    assert len(read_tape(tmp_path / "t", whole=True)) == 1


@given(cut=st.integers(9, 1000), whole=st.booleans())
def test_a_cut_tape_loses_only_its_last_block(tmp_path_factory, cut, whole):
    file = tmp_path_factory.mktemp("t") / "tape.bin"
    write(file, [np.ones((2, 26)), np.ones((1, 26))])
    content = file.read_bytes()
    head = 8 + 8 + 4 + 2 * 16  # bytes of a block without ticks
    ends = [8, 8 + head + 2 * 208, 8 + 2 * head + 3 * 208, len(content)]
    assert ends[-1] == ends[-2] + head
    cut = min(cut, len(content))
    file.write_bytes(content[:cut])
    if whole and cut not in ends:
        with pytest.raises(UsageError, match="cut off"):
            read_tape(file, whole=True)
    else:
        assert len(read_tape(file, whole=whole)) == sum(end <= cut for end in ends[1:])


@given(offset=st.integers(8, 500), value=st.integers(1, 255))
def test_damage_is_never_read_as_data(tmp_path_factory, offset, value):
    file = tmp_path_factory.mktemp("t") / "tape.bin"
    write(file, [np.ones((2, 26)), np.ones((1, 26))])
    content = bytearray(file.read_bytes())
    content[offset] ^= value
    file.write_bytes(content)
    with pytest.raises(UsageError, match=r"damaged|cut off"):
        read_tape(file, whole=True)


@pytest.mark.parametrize(
    ("counts", "block"),
    [((0,), 0), ((-1,), 0), ((-26,), 0), ((26, 13), 1), ((26, 25), 1), ((2**31 - 1,), 0)],
)
def test_an_impossible_number_of_joints_is_refused(tmp_path, counts, block):
    file = tmp_path / "tape.bin"
    setpoints = np.ones((1, 26)).tobytes()
    payloads = (struct.pack("<qi", k, n) + bytes(32) + setpoints for k, n in enumerate(counts))
    file.write_bytes(MAGIC + b"".join(map(guarded, payloads)))
    with pytest.raises(UsageError, match=f"damaged in block {block}"):
        read_tape(file, whole=True)
