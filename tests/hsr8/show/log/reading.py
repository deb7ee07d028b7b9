"""Reading of Rerun logs by tests."""

from types import SimpleNamespace

import numpy as np
from rerun.chunk import RrdReader


class Log:
    """Log in a file."""

    def __init__(self, file):
        self.chunks = list(RrdReader(str(file)).stream())

    def entities(self):
        return {str(chunk.entity_path) for chunk in self.chunks}

    def table(self, entity, component):
        """Return times [s], -inf of a static one, and rows of a component."""
        rows = []
        for chunk in self.chunks:
            batch = chunk.to_record_batch()
            if str(chunk.entity_path) != entity or component not in batch.schema.names:
                continue
            times = np.full(batch.num_rows, -np.inf)
            if not chunk.is_static:
                times = batch.column("sim_time").to_numpy().astype("timedelta64[ns]")
                times = times / np.timedelta64(1, "s")
            rows += zip(times, batch.column(component).to_pylist(), strict=True)
        rows.sort(key=lambda row: row[0])
        return SimpleNamespace(time=[time for time, _ in rows], rows=[row for _, row in rows])
