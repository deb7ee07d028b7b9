"""Events of a run: faults, collisions, falls, pushes, via points, goal, localization."""

from collections.abc import Iterator, Sequence

from hsr8.decisions import FrameRecord
from hsr8.record import Event
from hsr8.scenario.fault import Fault
from hsr8.world.truth.truth import CollisionCounter, Falls, Truth

SAME_TIME = 1e-6  # times closer than this are equal [s]


class EventWatch:
    """Turns records into events.

    Args:
        faults: faults of the scenario.
    """

    def __init__(self, faults: Sequence[Fault]) -> None:
        events = [(f.begin, f"{f.text()}: begins") for f in faults]
        events += [(f.end, f"{f.text()}: ends") for f in faults if f.end is not None]
        self._faults = sorted(events, key=lambda event: event[0])
        self._pushes = 0
        self._collisions = CollisionCounter()
        self._falls = Falls()
        self._index = 0
        self._lost = False
        self._done = False

    def look(self, truth: Truth, frame: FrameRecord | None) -> Iterator[Event]:
        """Yield the events since the last record; exhaust the iterator."""
        now = truth.time
        while self._faults and self._faults[0][0] <= now + SAME_TIME:
            time, text = self._faults.pop(0)
            yield Event(time, "fault", text)
        for push in truth.pushes:
            if push.number >= self._pushes:
                self._pushes = push.number + 1
                yield Event(push.begin, "push", push.text())
        if self._falls.add(now, fallen=truth.fallen):
            yield Event(now, "fall", "the robot has fallen")
        for collision in self._collisions.add(now, truth.contacts):
            text = f"{collision.robot_geom} touches {collision.name}"
            yield Event(now, "collision", text)
        if frame is None:
            return
        if frame.task.index > self._index:
            self._index = frame.task.index
            yield Event(now, "via_point", f"via point {self._index} passed")
        if frame.task.done and not self._done:
            self._done = True
            yield Event(now, "goal", "goal reached")
        if frame.belief.lost != self._lost:
            self._lost = frame.belief.lost
            if self._lost:
                yield Event(now, "lost", "localization is lost")
            else:
                yield Event(now, "relocalized", "localized again")
