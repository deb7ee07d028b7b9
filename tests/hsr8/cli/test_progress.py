import io
from types import SimpleNamespace

from hsr8.cli.progress import Progress
from hsr8.simulation.record import Event

COLLISION = Event(3.0, "collision", "l_sole touches obstacle 1")


def tick(record=None, *events):
    return SimpleNamespace(record=record, events=events)


def test_without_a_terminal_there_is_a_plain_line_every_ten_seconds(walk):
    stream = io.StringIO()
    with Progress(30.0, stream) as progress:
        for record in walk(25.0):
            progress.show(tick(record))
        progress.show(tick(None, COLLISION))
    lines = stream.getvalue().splitlines()
    assert [line.split()[0] for line in lines] == ["10.0", "20.0"]
    assert "\x1b" not in stream.getvalue()


def test_the_line_has_time_counts_and_situation(fake):
    progress = Progress(30.0, io.StringIO())
    record = fake.record(2.0, frame=fake.frame(2.0, index=3))
    progress.show(tick(record, COLLISION))
    line = progress.line(record)
    assert "2.0 / 30.0 s" in line
    assert "via points   3" in line
    assert "collisions 1" in line
    assert "free" in line


def test_a_lost_robot_is_called_lost(fake):
    progress = Progress(30.0, io.StringIO())
    record = fake.record(2.0, frame=fake.frame(2.0, lost=True))
    progress.show(tick(record))
    assert progress.line(record).endswith("planner lost")
