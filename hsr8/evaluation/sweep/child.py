"""Process of one run, whose result comes through a pipe: its crash or hang ends only this run.

    python -m hsr8.evaluation.sweep.child DESCRIPTOR

does the job that is pickled on standard input and sends its result to a file descriptor.
"""

import os
import pickle
import signal
import sys
import time as clock
from collections.abc import Callable, Iterator
from multiprocessing.connection import Connection

from hsr8.evaluation.sweep.job import Job, RunResult, complete, run_job, unfinished

Work = Callable[[Job], Iterator[RunResult]]


class Child:
    """Process of a run, as its executor knows it.

    Args:
        job: the run.
        results: end of the pipe that receives the parts of the result.

    Attributes:
        ended: whether the process has sent its result or has closed the pipe.
    """

    def __init__(self, job: Job, results: "Connection[object, RunResult]") -> None:
        self.job = job
        self.results = results
        self.ended = False
        self._started = clock.monotonic()
        self._result = unfinished(job)
        self._complete = False

    @property
    def remaining_time(self) -> float:
        """Wall time to the limit of the run [s], at least 0."""
        return max(0.0, self._started + self.job.timeout - clock.monotonic())

    def receive(self, timeout: float = 0.0) -> bool:
        """Receive a part of the result; return whether there was one.

        Args:
            timeout: maximum time to wait for the part [s].
        """
        if self.ended or not self.results.poll(timeout):
            return False
        try:
            part = self.results.recv()
        except (EOFError, OSError, pickle.UnpicklingError):  # the process died
            self.ended = True
            return False
        self._result |= part
        self.ended = self._complete = "outcome" in part
        return True

    def close(self, exit_code: int | None) -> RunResult:
        """Return the result after the end of the process.

        Args:
            exit_code: exit code of the process, negative for a signal; None after the limit.
        """
        while self.receive():
            pass
        self.results.close()
        self._result["process_s"] = clock.monotonic() - self._started
        if not self._complete:
            self._result["error"] = self._ending(exit_code)
        return complete(self.job, self._result)

    def _ending(self, exit_code: int | None) -> str:
        if exit_code is None:
            return f"stopped at the wall-clock limit of {self.job.timeout:g} s"
        if exit_code < 0:
            return f"killed by {signal.Signals(-exit_code).name}"
        return f"exit code {exit_code} without a result"


def serve(job: Job, results: "Connection[RunResult, object]", work: Work = run_job) -> None:
    """Do a job in this process and send the parts of its result; print nothing."""
    null = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):
        os.dup2(null, stream)
    for part in work(job):
        results.send(part)
    results.close()


if __name__ == "__main__":
    serve(pickle.load(sys.stdin.buffer), Connection(int(sys.argv[1]), readable=False))
