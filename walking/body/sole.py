"""Sole of a foot."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Sole:
    """Rectangle of a sole in the foot frame.

    Attributes:
        centre: middle of the sole ahead of the ankle [m].
        half_length: half of its length [m].
        half_width: half of its width [m].
    """

    centre: float
    half_length: float
    half_width: float

    def pressed(self, forward: float, side: float) -> "Sole":
        """Return the part of the sole that weak ankles can press on the floor.

        A ZMP at a distance from the ankle needs a torque of that distance times the weight.

        Args:
            forward: distance from the ankle that the pitch joint can hold [m].
            side: distance that the roll joint can hold [m].
        """
        front, back = self.centre + self.half_length, self.centre - self.half_length
        if front <= forward and -back <= forward and self.half_width <= side:
            return self
        front, back = min(front, forward), max(back, -forward)
        return Sole(0.5 * (front + back), 0.5 * (front - back), min(self.half_width, side))
