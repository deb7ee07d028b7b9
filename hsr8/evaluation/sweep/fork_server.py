"""Processes forked from one that has loaded everything: a run begins at once.

The other side of the socket is `hsr8.cli.fork_server`, which says what the messages are.
"""

import itertools
import json
import signal
import socket
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from concurrent.futures import Future
from contextlib import suppress
from threading import Event, Lock, Thread
from typing import IO, Any

from hsr8.evaluation.sweep.process import environment

COMMAND = [sys.executable, "-P", "-m", "hsr8.cli.fork_server"]
LONGEST = 1 << 16  # of a message [bytes]
LOADING = 300.0  # it has loaded by then, or hangs, wall time [s]
SAID = 2000  # characters kept of what it said at its end


class ForkServer:
    """The process that forks; it begins to load when it is made.

    Raises:
        OSError: here and in `start`, there is no process, no file, or no server any more.
    """

    def __init__(self) -> None:
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._said = tempfile.TemporaryFile()  # noqa: SIM115  closed by `close`
        with theirs:
            self._process = subprocess.Popen(
                [*COMMAND, str(theirs.fileno())],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=self._said,
                env=environment(),
                pass_fds=[theirs.fileno()],
                start_new_session=True,  # Ctrl-C is the sweep's to answer
            )
        self._channel = ours
        self._loaded = Event()
        self._gone = ""
        self._lock = Lock()
        self._numbers = itertools.count()
        self._ends: dict[int, Future[int]] = {}
        self._listener = Thread(target=self._listen, daemon=True)
        self._listener.start()

    @property
    def pid(self) -> int:
        """Process id."""
        return self._process.pid

    @property
    def gone(self) -> bool:
        """Whether it has ended."""
        return bool(self._gone)

    def start(self, words: Sequence[str]) -> "ForkedProcess":
        """Run the command line ``hsr8 WORDS`` in a process of its own."""
        number, end = next(self._numbers), Future[int]()
        process = ForkedProcess(self, number, end)
        message = json.dumps({"run": number, "words": list(words)}).encode()
        with self._lock:
            if self._gone:
                raise OSError(self._gone)
            self._ends[number] = end
        try:
            socket.send_fds(self._channel, [message], [file.fileno() for file in process.files])
        except OSError:
            with self._lock:
                self._ends.pop(number, None)
            raise
        return process

    def wait_until_loaded(self) -> None:
        """Wait until it can fork, or has ended; not for ever."""
        self._loaded.wait(LOADING)

    def send_signal(self, number: int, which: int) -> None:
        """Send a signal to a run; while it loads there are none, and it ends."""
        if not self._loaded.is_set():
            self._process.kill()
            return
        with suppress(OSError):  # it has ended, and its runs with it
            self._channel.send(json.dumps({"run": number, "signal": which}).encode())

    def close(self) -> None:
        """End it, and what it still runs."""
        self._process.kill()
        self._listener.join()
        self._channel.close()
        self._said.close()

    def _listen(self) -> None:
        """Hand on what has ended; at the server's own end, that all have."""
        while message := self._received():
            told: dict[str, Any] = json.loads(message)
            if "ready" in told:
                self._loaded.set()
                continue
            with self._lock:
                end = self._ends.pop(told["run"])
            if "code" in told:
                end.set_result(told["code"])
            else:
                end.set_exception(OSError(told["error"]))
        code = self._process.wait()
        self._said.seek(0)
        said = self._said.read().decode(errors="replace").strip()[-SAID:]
        with self._lock:
            self._gone = f"the process that forks the runs ended ({code}){': ' if said else ''}"
            self._gone += said
            left = list(self._ends.values())
            self._ends.clear()
        self._loaded.set()
        for end in left:
            end.set_exception(OSError(self._gone))

    def _received(self) -> bytes:
        try:
            return self._channel.recv(LONGEST)
        except OSError:  # killed with a message of ours unread
            return b""


class ForkedProcess:
    """A run in a process forked by `server`.

    Args:
        server: that forks it.
        number: of the run.
        end: told its exit code, or that there is none.
    """

    def __init__(self, server: ForkServer, number: int, end: "Future[int]") -> None:
        self._server = server
        self._number = number
        self._end = end
        # Not pipes: nobody has to read while it writes.
        self.files: list[IO[bytes]] = [
            tempfile.TemporaryFile()  # noqa: SIM115  closed by `communicate`
            for _ in range(2)
        ]

    @property
    def returncode(self) -> int | None:
        """Exit code, or that of the signal that killed it, negative; None while it runs."""
        if not self._end.done():
            return None
        return -signal.SIGKILL if self._end.exception() is not None else self._end.result()

    def communicate(self, *, timeout: float | None = None) -> tuple[str, str]:
        """Wait for the end; what it wrote to standard output and error.

        What all runs are forked from loads once; that is not the time of the first of them.

        Raises:
            OSError: it has no end of its own: it could not be forked, or the server is gone.
            subprocess.TimeoutExpired: it takes longer than `timeout` [s].
        """
        self._server.wait_until_loaded()
        try:
            self._end.result(timeout)
        except TimeoutError:
            raise subprocess.TimeoutExpired("hsr8", timeout or 0.0) from None
        except OSError:
            for file in self.files:
                file.close()
            raise
        texts = []
        for file in self.files:
            with file:
                file.seek(0)
                texts.append(file.read().decode(errors="replace"))
        return texts[0], texts[1]

    def terminate(self) -> None:
        """Ask it to end."""
        self._server.send_signal(self._number, signal.SIGTERM)

    def kill(self) -> None:
        """End it."""
        self._server.send_signal(self._number, signal.SIGKILL)
