"""Outbox: objects for another process, written without waiting and without a thread."""

import fcntl
import os
import pickle
import select
import struct
import time
from collections import deque
from contextlib import suppress
from multiprocessing.connection import Connection
from typing import Any

PIPE_SIZE = 1 << 20  # an image fits, the most that the kernel grants without privileges [byte]
HEADER = struct.Struct("!i")  # length of an object, as `Connection.recv` expects it


class Outbox:
    """Bounded queue in front of a pipe that the other process reads with `Connection.recv`.

    Args:
        connection: end of the pipe.
        limit: maximum number of objects that wait.

    Raises:
        BrokenPipeError: from every method, the other process is gone.
    """

    def __init__(self, connection: Connection, limit: int) -> None:
        self._connection, self._limit = connection, limit
        self._waiting: deque[memoryview] = deque()
        os.set_blocking(connection.fileno(), False)
        with suppress(OSError):
            fcntl.fcntl(connection.fileno(), fcntl.F_SETPIPE_SZ, PIPE_SIZE)

    def put(self, content: Any) -> bool:
        """Send an object; return False if too many wait already."""
        self._flush()
        if len(self._waiting) >= self._limit:
            return False
        data = pickle.dumps(content, pickle.HIGHEST_PROTOCOL)
        self._waiting.append(memoryview(HEADER.pack(len(data)) + data))
        self._flush()
        return True

    def close(self, timeout: float) -> None:
        """Send the objects that wait, for at most a `timeout` [s], and close the pipe."""
        end = time.monotonic() + timeout
        while self._waiting and (left := end - time.monotonic()) > 0.0:
            select.select([], [self._connection], [], left)
            self._flush()
        self._connection.close()

    def _flush(self) -> None:
        """Write as much as the pipe takes."""
        with suppress(BlockingIOError):
            while self._waiting:
                first = self._waiting[0]
                if (sent := os.write(self._connection.fileno(), first)) < len(first):
                    self._waiting[0] = first[sent:]
                else:
                    self._waiting.popleft()
