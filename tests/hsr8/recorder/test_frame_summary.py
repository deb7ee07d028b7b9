import pytest

from hsr8.recorder.frame_summary import from_line, to_line


@pytest.fixture
def line(fake):
    frame = fake.frame(0.6, (0.1, 0.2, 0.3), index=2)
    return to_line(frame, fake.record(0.6, (0.11, 0.2, 0.3)).truth)


def test_round_trip_keeps_what_the_dashboard_shows(line):
    frame = from_line(line)
    assert frame.time == 0.6
    assert frame.pose == (0.1, 0.2, 0.3)
    assert frame.truth == (0.11, 0.2, 0.3)
    assert frame.covariance == (1e-4, 0.0, 1e-4)
    assert frame.passed == 2
    assert frame.psi == (0.2, 0.4, 0.6, 0.1)
    assert frame.virtual_obstacles == ((1.0, 0.2, 0.2),)
    assert [t.motion for t in frame.tracks] == ["static", "static", "moving"]
    assert [t.visible for t in frame.tracks] == [True, False, False]
    assert frame.tracks[2].velocity == (0.0, 0.1)
    assert frame.tracks[0].covariance == (4e-4, 0.0, 1e-4)


def test_a_line_is_one_line_and_short(line):
    assert "\n" not in line
    assert len(line) < 1000
