"""Servo faults: frozen and delayed setpoints."""

from collections import deque
from collections.abc import Sequence

from hsr8.scenario.fault import Fault, ServoDelay, ServoFault, ticks
from walking.targets import JointTargets


class ServoFaults:
    """Applies servo faults in the order of the scenario.

    Args:
        faults: of the scenario; faults of other parts are ignored.
        names: of the robot's joints.
    """

    def __init__(self, faults: Sequence[Fault], names: Sequence[str]) -> None:
        self._names = names
        self._faults = [f for f in faults if isinstance(f, ServoFault)]
        delays = [ticks(f.magnitude) for f in self._faults if isinstance(f, ServoDelay)]
        self._commanded: deque[JointTargets] = deque(maxlen=max(delays, default=0) + 1)
        self._applied: JointTargets | None = None
        self._frozen: dict[int, JointTargets] = {}

    def apply_fault(self, targets: JointTargets, tick: int) -> JointTargets:
        """Return the targets that reach the servos in control tick `tick`."""
        if not self._faults:
            return targets
        self._commanded.append(targets)
        position, setpoint = targets.position.copy(), targets.setpoint.copy()
        for number, fault in enumerate(self._faults):
            if not fault.acts(tick):
                continue
            if isinstance(fault, ServoDelay):
                then = self._commanded[max(0, len(self._commanded) - 1 - ticks(fault.magnitude))]
            else:
                then = self._frozen.setdefault(number, self._applied or targets)
            joints = fault.joints(self._names)
            position[joints], setpoint[joints] = then.position[joints], then.setpoint[joints]
        self._applied = JointTargets(position, setpoint)
        return self._applied
