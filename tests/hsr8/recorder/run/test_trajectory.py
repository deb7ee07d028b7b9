import struct
from contextlib import closing

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsr8.errors import UsageError
from hsr8.recorder.run.trajectory import TrajectoryWriter, read_trajectory, rows_at


def _write(path, rows, nq=5, movers=2):
    rng = np.random.default_rng(1)
    qpos, places = rng.normal(size=(rows, nq)), rng.normal(size=(rows, movers, 2))
    with closing(TrajectoryWriter(path, nq, movers)) as writer:
        for k in range(rows):
            writer.extend([0.02 * k], qpos[k : k + 1], places[k : k + 1])
    return qpos, places


@pytest.mark.parametrize("movers", [0, 2])
def test_round_trip_is_exact(tmp_path, movers):
    qpos, places = _write(tmp_path / "t", 7, movers=movers)
    back = read_trajectory(tmp_path / "t")
    assert len(back) == 7
    assert np.array_equal(back.time, 0.02 * np.arange(7))
    assert np.array_equal(back.qpos, qpos)
    assert np.array_equal(back.movers, places)


@given(cut=st.integers(0, 400))
def test_a_cut_file_loses_only_the_cut_rows(tmp_path_factory, cut):
    file = tmp_path_factory.mktemp("cut") / "t"
    qpos, _ = _write(file, 6)
    whole = file.read_bytes()
    row = 8 * (1 + 5 + 4)
    header = len(whole) - 6 * row
    kept = max(len(whole) - cut, header)
    file.write_bytes(whole[:kept])
    back = read_trajectory(file)
    assert len(back) == (kept - header) // row
    assert np.array_equal(back.qpos, qpos[: len(back)])


@pytest.mark.parametrize("content", [b"", b"HSR8", b"something else entirely"])
def test_other_files_are_refused(tmp_path, content):
    (tmp_path / "t").write_bytes(content)
    with pytest.raises(UsageError, match="not a trajectory"):
        read_trajectory(tmp_path / "t")


@pytest.mark.parametrize("rest", [20, 32 + 7])  # the second: all but the last of the padding
def test_a_file_cut_in_its_header_is_refused(tmp_path, rest):
    _write(tmp_path / "t", 1)
    (tmp_path / "t").write_bytes((tmp_path / "t").read_bytes()[:rest])
    with pytest.raises(UsageError, match="header"):
        read_trajectory(tmp_path / "t")


def test_a_missing_file_is_a_usage_error(tmp_path):
    with pytest.raises(UsageError, match="cannot read"):
        read_trajectory(tmp_path / "none")


def test_rows_at_takes_the_last_row_not_after_the_time():
    time = 0.02 * np.arange(5)
    assert rows_at(time, [0.0, 0.019, 0.02, 0.06, 9.0, -1.0]).tolist() == [0, 0, 1, 3, 4, 0]


def test_a_header_without_sizes_is_refused(tmp_path):
    (tmp_path / "t").write_bytes(b"HSR8TRJ1" + struct.pack("<Q", 2) + b"{}")
    with pytest.raises(UsageError, match="header"):
        read_trajectory(tmp_path / "t")
