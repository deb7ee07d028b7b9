"""Drive: the latest command before a time is in force, and replays of the same commands agree."""

from math import nan

from hypothesis import given
from hypothesis import strategies as st

from hsr8.simulation.decisions import DriveCommand
from hsr8.simulation.drive import TIMEOUT, Drive

TICKS = [0.005 * k for k in range(400)]
velocities = st.tuples(*[st.floats(-1.0, 1.0)] * 3)
gazes = st.tuples(*[st.floats(-1.0, 1.0)] * 2)
commands = st.lists(
    st.builds(DriveCommand, st.sampled_from(TICKS), velocities)
    | st.builds(DriveCommand, st.sampled_from(TICKS), st.just((nan,) * 3), gazes),
    max_size=8,
).map(lambda some: sorted(some, key=lambda command: command.time))


def in_force(drive, time):
    """Return velocity, and pan and tilt at a time."""
    gaze = drive.gaze(time)
    return drive.at(time).velocity, gaze and (gaze.pan, gaze.tilt)


@given(commands, st.sampled_from(TICKS))
def test_the_latest_velocity_before_a_tick_is_in_force_until_the_timeout(some, time):
    before = [c for c in some if c.time < time and c.velocity[0] == c.velocity[0]]
    drive = Drive(some)
    if before and time - before[-1].time <= TIMEOUT:
        assert drive.at(time).velocity == before[-1].velocity
    else:
        assert drive.at(time).velocity == (0.0, 0.0, 0.0)


@given(commands, st.sampled_from(TICKS))
def test_the_latest_gaze_before_a_tick_stays_in_force(some, time):
    before = [c.gaze for c in some if c.time < time and c.gaze[0] == c.gaze[0]]
    assert in_force(Drive(some), time)[1] == (before[-1] if before else None)


@given(commands)
def test_commands_that_arrive_during_a_run_are_those_of_its_record(some):
    drive, arriving, recorded, live = Drive(), list(some), [], []
    for time in TICKS:
        live.append(in_force(drive, time))
        recorded += drive.take()
        while arriving and arriving[0].time <= time:
            drive.add(arriving.pop(0))
    again = Drive([*recorded, *drive.take()])
    assert [in_force(again, time) for time in TICKS] == live
