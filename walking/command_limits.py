"""What became of a command: what was asked, what is given, and what stood in the way."""

from enum import StrEnum

from walking.command import Command
from walking.value import comparable_value


class Limit(StrEnum):
    """A reason to give less than was asked."""

    SPEED = "speed"
    COMBINED_SPEED = "combined speed"
    ACCELERATION = "acceleration"
    STEP_LENGTH = "step length"
    STEP_SIDE = "step side"
    STEP_TURN = "step turn"
    CLEARANCE = "clearance"
    REACH = "reach"
    TIMING = "timing"
    SWING_HEIGHT = "swing height"
    SETTLING = "settling"
    BALANCE = "balance"
    LANDING_FROZEN = "landing frozen"
    ZMP_REGION = "zmp region"
    LANDING_SPEED = "landing speed"
    FALLEN = "fallen"


@comparable_value
class CommandLimits:
    """One tick's answer to the command.

    Attributes:
        asked: the command.
        given: what the footsteps to come obey; of the other kind only while it may not change
            over.
        limits: constraints that bound in this tick, in the order in which they are applied; for
            the footstep under way, too, which may be past obeying what is given. None when the
            command is obeyed: to the control tick in time, and to the millimetre (see
            `FootstepPlanner.same`) in the landing under way.
    """

    commanded: Command
    applied: Command
    limits: tuple[Limit, ...]

    @property
    def limited(self) -> bool:
        """Whether anything but the command itself is given."""
        return bool(self.limits)
