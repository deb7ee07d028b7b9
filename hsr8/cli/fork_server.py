"""A process that has loaded everything once, and forks another for every run it is asked for.

python -m hsr8.cli.fork_server DESCRIPTOR

The descriptor is a socket that keeps messages apart (SOCK_SEQPACKET). Messages are JSON:

    {"run": 7, "words": ["run", "quick"]}   with two files: standard output and error of the run
    {"run": 7, "signal": 15}                sends it a signal
    {"ready": true}                         answer: everything is loaded
    {"run": 7, "code": -9}                  answer: it has ended
    {"run": 7, "error": "..."}              answer: it could not be forked

It ends when the other side of the socket is closed, and its runs end with it. When it forks it
has one thread, no OpenGL context and no Rerun, which starts threads when it is imported.
"""

import atexit
import gc
import json
import os
import selectors
import socket
import sys
from contextlib import suppress
from typing import Any

from hsr8.cli.loading import loading
from hsr8.cli.main import entry
from hsr8.evaluation.sweep.fork_server import LONGEST
from hsr8.parent_watch import ORPHAN, end_with_parent

# A short run loads what a run loads, compiled kernels too, which come from the disk one by one.
FIRST = ("robot.body=kinematic", "camera.source=analytic", "duration=1.0")


def main(arguments: list[str]) -> int:
    """Serve the socket of `arguments`; in a process that it forked, run the command."""
    with socket.socket(fileno=int(arguments[0])) as channel:
        channel.set_inheritable(False)
        load_everything()
        _tell(channel, {"ready": True})
        words = serve(channel)
    if words is None:
        return 0
    code = entry(words)
    # As `multiprocessing` leaves its processes: there is no use in taking down what all share.
    atexit._run_exitfuncs()
    os._exit(code)


def load_everything() -> None:
    """Import what a run needs, and load its kernels."""
    with loading():
        import hsr8.cli.recorded_run  # noqa: F401, PLC0415  MuJoCo was to wait for the backend
        from hsr8.loop import Simulation  # noqa: PLC0415
        from hsr8.scenario.loader import load_scenario  # noqa: PLC0415

    Simulation(load_scenario("quick", FIRST, 0), 0).run()
    gc.collect()
    gc.freeze()  # collections leave alone what all runs share


def serve(channel: socket.socket) -> list[str] | None:
    """Fork what is asked for.

    Args:
        channel: to who asks.

    Returns:
        In a forked process the words of its command line; in this one None, when nobody is
        there any more.
    """
    runs: dict[int, int] = {}  # process by number of the run
    with selectors.DefaultSelector() as waiting:
        waiting.register(channel, selectors.EVENT_READ)
        while True:
            for key, _ in waiting.select():
                if key.data is not None:  # a run has ended
                    waiting.unregister(key.fileobj)
                    os.close(key.fd)
                    _, status = os.waitpid(runs.pop(key.data), 0)
                    code = os.waitstatus_to_exitcode(status)
                    _tell(channel, {"run": key.data, "code": code})
                    continue
                message, files, _, _ = socket.recv_fds(channel, LONGEST, 2)
                if not message:
                    return None
                asked = json.loads(message)
                number: int = asked["run"]
                if "signal" in asked:
                    if number in runs:
                        os.kill(runs[number], asked["signal"])
                    continue
                process = _forked(files)
                if process == 0:
                    words: list[str] = asked["words"]
                    return words
                if isinstance(process, str):
                    _tell(channel, {"run": number, "error": process})
                    continue
                runs[number] = process
                waiting.register(os.pidfd_open(process), selectors.EVENT_READ, number)


def _forked(files: list[int]) -> int | str:
    """Fork a process with these output files; its id, 0 in itself, or why there is none."""
    parent = os.getpid()
    try:
        process = os.fork()
        if process == 0:
            _become_a_run(parent, files)
    except OSError as error:
        return f"cannot fork: {error.strerror}"
    finally:
        for file in files:
            os.close(file)
    return process


def _become_a_run(parent: int, files: list[int]) -> None:
    """What tells a run's process from the one that forked it."""
    os.setsid()
    if not end_with_parent(parent):
        os._exit(ORPHAN)
    for file, stream in zip(files, (1, 2), strict=True):
        os.dup2(file, stream)


def _tell(channel: socket.socket, message: dict[str, Any]) -> None:
    with suppress(OSError):  # nobody listens any more: the next thing received says so, too
        channel.send(json.dumps(message).encode())


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
