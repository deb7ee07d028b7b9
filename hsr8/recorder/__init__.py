"""Recorder: run folder and Rerun log, both listeners of the loop."""

import os

# A log that cannot be written is told by us, once; Rerun would tell it too, in its own way.
os.environ.setdefault("RUST_LOG", "warn,re_log_encoding=off,re_sdk=off")
# It takes a thread for every processor unless told otherwise, though it has no work for them.
os.environ.setdefault("TOKIO_WORKER_THREADS", "2")
