"""Outbox: objects arrive whole and in order; it neither waits for a reader nor outlives one."""

import os
import threading
from multiprocessing import get_context

import numpy as np
import pytest

from hsr8.ros.outbox import Outbox


@pytest.fixture
def pipe():
    reader, writer = get_context("spawn").Pipe(duplex=False)
    yield reader, Outbox(writer, 5)
    reader.close()


def test_objects_wait_up_to_the_limit_and_arrive_in_order(pipe):
    reader, outbox = pipe
    large = os.urandom(1 << 20)  # more than the pipe takes
    sent = [outbox.put((k, large)) for k in range(9)]
    assert sent[:5] == [True] * 5
    assert not sent[-1]
    received = []

    def read():
        while len(received) < sum(sent) + 1:
            received.append(reader.recv())

    thread = threading.Thread(target=read)
    thread.start()
    while not outbox.put("last"):
        pass
    outbox.close(60.0)
    thread.join()
    assert received == [(k, large) for k in range(sum(sent))] + ["last"]


def test_arrays_arrive_equal(pipe):
    reader, outbox = pipe
    rows = [("ticks", {"time": 0.5, "gyro": np.arange(3.0)})]
    assert outbox.put(rows)
    (_, values), *_ = reader.recv()
    assert values["time"] == 0.5
    assert np.array_equal(values["gyro"], np.arange(3.0))


def test_a_reader_that_is_gone_is_reported(pipe):
    reader, outbox = pipe
    reader.close()
    with pytest.raises(BrokenPipeError):
        outbox.put("lost")
