"""Recorder: run folder and Rerun log, both listeners of the loop."""

import os

# hsr8 reports a log that cannot be written; Rerun would report it a second time.
os.environ.setdefault("RUST_LOG", "warn,re_log_encoding=off,re_sdk=off")
# By default Rerun starts a thread per processor, which its log does not need.
os.environ.setdefault("TOKIO_WORKER_THREADS", "2")
