"""Batches of tables, as the recorder passes them to a log."""

from hsr8.recording.recorded import FrameSampler, Throttle, image_row
from hsr8.recording.recorder import IMAGES
from hsr8.recording.rows import TABLES
from hsr8.recording.table import Table
from hsr8.simulation.record import Event


def batch_of(records, events=(), *, full=False):
    """Return the tables of records and of events: time, kind and text."""
    records, sampler = list(records), FrameSampler()
    rates = IMAGES["full" if full else "standard"]
    due = Throttle(rates.period)
    frames = [record.frame for record in records if record.frame is not None]
    images = [f for f in frames if f.image is not None and due.due(f.time)]
    objects = {
        "records": records,
        "frames": [*map(sampler.sample, frames)],
        "events": [Event(*event) for event in events],
        "images": [image_row(frame, 75) for frame in images],
    }
    return {
        name: Table.from_objects(name, TABLES[name], content)
        for name, content in objects.items()
        if content
    }
