import io
from types import SimpleNamespace

from hsr8.cli.progress import Progress
from hsr8.record import Event

COLLISION = Event(3.0, "collision", "l_sole touches obstacle 1")
HIDE_CURSOR, SHOW_CURSOR, ERASE_LINE = "\x1b[?25l", "\x1b[?25h", "\x1b[2K"


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


def test_a_terminal_gets_a_live_line_that_is_erased(fake, monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    stream = io.StringIO()
    monkeypatch.setattr("hsr8.cli.progress.REFRESH", 0.0)
    with Progress(30.0, stream) as progress:
        assert HIDE_CURSOR not in stream.getvalue(), "the cursor is hidden only once the run begins"
        progress.show(tick(fake.record(2.0)))
        progress.show(tick(None, Event(1.0, "fall", "the robot has fallen")))
        assert "2.0 / 30.0 s" in stream.getvalue()
        before = len(stream.getvalue())
    assert "the robot has fallen" in stream.getvalue()
    assert ERASE_LINE in stream.getvalue()[before:]
    assert stream.getvalue().count(HIDE_CURSOR) == stream.getvalue().count(SHOW_CURSOR) == 1
