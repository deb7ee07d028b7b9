import numpy as np

from hsr8.event_watch import EventWatch
from hsr8.world.truth.truth import Contact, Truth


def truth_with(time, *obstacles):
    contacts = tuple(
        Contact(o, f"beacon {o}", False, "l_sole", 1.0, closing=False) for o in obstacles
    )
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


def test_a_contact_is_told_with_the_name_of_what_is_touched():
    (event,) = EventWatch(()).look(truth_with(0.0, 3), None)
    assert event.text == "l_sole touches beacon 3"


def test_a_contact_that_goes_on_is_one_event_and_a_later_one_another():
    watch = EventWatch(())

    def events(time, obstacle):
        return [event.kind for event in watch.look(truth_with(time, obstacle), None)]

    assert events(0.0, 3) == ["collision"]
    for time in np.arange(0.02, 1.0, 0.02):
        assert events(time, 3) == []
    assert events(1.2, 3) == []
    assert events(1.9, 3) == events(1.9, 4) == ["collision"]
