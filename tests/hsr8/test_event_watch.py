import numpy as np

from hsr8.event_watch import EventWatch
from hsr8.world.truth import Contact, Truth


def truth_with(time, *obstacles):
    contacts = tuple(Contact(o, False, "l_sole", 1.0, closing=False) for o in obstacles)
    empty = np.zeros(0)
    return Truth(
        time=time,
        qpos=empty,
        robot=empty,
        obstacle_positions=empty,
        obstacle_velocities=empty,
        contacts=contacts,
        clearance=1.0,
        joint_torque=empty,
        foot_force=empty,
        zmp=empty,
        fallen=False,
    )


def test_a_contact_that_goes_on_is_one_event_and_a_later_one_another():
    told = []
    watch = EventWatch(lambda kind, text: told.append(kind))
    for time in np.arange(0.0, 1.0, 0.02):
        watch.look(truth_with(time, 3), None)
    assert told == ["collision"]
    watch.look(truth_with(1.2, 3), None)
    assert told == ["collision"]
    watch.look(truth_with(1.9, 3), None)
    watch.look(truth_with(1.9, 4), None)
    assert told == ["collision"] * 3
