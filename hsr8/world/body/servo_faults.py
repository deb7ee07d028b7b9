"""Faults on the way to the servos: set-points that stay or come late."""

from collections import deque
from collections.abc import Sequence

from hsr8.scenario.fault import Fault, ServoDelay, ServoFault, ticks
from walking.targets import JointTargets


class ServoFaults:
    """Spoils set-points, one fault after the other in the order of the scenario.

    Args:
        faults: of the scenario; those of other parts are left to them.
    """

    def __init__(self, faults: Sequence[Fault]) -> None:
        self._faults = [f for f in faults if isinstance(f, ServoFault)]
        most = max(
            (ticks(f.magnitude) for f in self._faults if isinstance(f, ServoDelay)), default=0
        )
        self._asked: deque[JointTargets] = deque(maxlen=most + 1)
        self._told: JointTargets | None = None
        self._held: dict[int, JointTargets] = {}

    def apply_fault(self, targets: JointTargets, tick: int) -> JointTargets:
        """What the servos are told when `targets` are asked for in control tick `tick`."""
        if not self._faults:
            return targets
        self._asked.append(targets)
        position, offset = targets.position.copy(), targets.offset.copy()
        for number, fault in enumerate(self._faults):
            if not fault.acts(tick):
                continue
            if isinstance(fault, ServoDelay):
                then = self._asked[max(0, len(self._asked) - 1 - ticks(fault.magnitude))]
            else:
                then = self._held.setdefault(number, self._told or targets)
            position[fault.joints] = then.position[fault.joints]
            offset[fault.joints] = then.offset[fault.joints]
        self._told = JointTargets(position, offset)
        return self._told
