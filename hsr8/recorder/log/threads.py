"""Threads of a Rerun log: Rerun ends the whole process where it may not have them."""

import threading
from pathlib import Path

from hsr8.recorder.files.writing import failure

LOG_THREADS = 9  # two workers, one that frees memory, and two each of log, arrangement and sinks


def require_threads(folder: Path) -> None:
    """Start as many threads as a log takes, and end them again.

    Args:
        folder: of the run.

    Raises:
        RecordingFailed: the system does not grant them.
    """
    enough = threading.Event()
    threads = [threading.Thread(target=enough.wait) for _ in range(LOG_THREADS)]
    granted = 0
    try:
        for thread in threads:
            thread.start()
            granted += 1
    except RuntimeError as error:
        reason = f"the log takes {LOG_THREADS} threads, and the system grants {granted}"
        ways = "raise its limit (ulimit -u; pids.max of a container), or do without: --no-log"
        raise failure(folder, f"{reason}\n  {ways}") from error
    finally:
        enough.set()
        for thread in threads[:granted]:
            thread.join()
