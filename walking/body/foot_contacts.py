"""Foot contacts, gait phase and footsteps from the measured loads of the feet."""

from walking.parameters import CONTROL_PERIOD, GRAVITY, LIGHT_LOAD, GaitParameters
from walking.phase import Phase

CONTACT_LOAD = 2.0 * LIGHT_LOAD  # of the weight; a lifted foot with more of it has landed [1]


class FootContacts:
    """Contacts of the feet with the floor, by their load with hysteresis.

    A footstep is completed when a foot lands that was lifted for a minimum time. The robot stands
    when both feet have been on the floor for longer than a footstep; it starts standing.

    Args:
        mass: of the robot [kg].
        gait: duration of a footstep and minimum time of a foot in the air.

    Attributes:
        on_floor: whether the left and the right foot are on the floor.
        step_count: completed footsteps.
        phase: gait phase; with both feet in the air the last one.
    """

    def __init__(self, mass: float, gait: GaitParameters) -> None:
        weight = mass * GRAVITY
        self._lifted, self._landed = LIGHT_LOAD * weight, CONTACT_LOAD * weight
        self._min_ticks = gait.min_swing_time / CONTROL_PERIOD
        self._step_ticks = gait.footstep_time / CONTROL_PERIOD
        self._in_air = [0, 0]  # ticks since each foot was lifted
        self._both: float = self._step_ticks  # ticks since both are on the floor
        self.on_floor = [True, True]
        self.step_count = 0
        self.phase = Phase.STANDING

    def update(self, left: float, right: float) -> None:
        """Run one tick, given the load of each foot [N]."""
        for side, load in enumerate((left, right)):
            self._in_air[side] = 0 if self.on_floor[side] else self._in_air[side] + 1
            if self.on_floor[side]:
                self.on_floor[side] = load >= self._lifted
            elif load > self._landed:
                self.on_floor[side] = True
                self.step_count += self._in_air[side] >= self._min_ticks
        both = all(self.on_floor)
        self._both = self._both + 1 if both else 0
        if both:
            standing = self._both > self._step_ticks
            self.phase = Phase.STANDING if standing else Phase.DOUBLE_SUPPORT
        elif any(self.on_floor):
            self.phase = Phase.LEFT_SUPPORT if self.on_floor[0] else Phase.RIGHT_SUPPORT
