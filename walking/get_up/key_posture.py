"""Key postures between lying and standing."""

from __future__ import annotations

from dataclasses import dataclass, replace

Angles = tuple[float, ...]

# In the order of `joints.JOINT_NAMES`; mirroring changes the sign of roll and yaw.
_LEG_MIRROR = (-1.0, -1.0, 1.0, 1.0, 1.0, -1.0)
_ARM_MIRROR = (1.0, -1.0, -1.0, 1.0, -1.0, -1.0)


def leg(
    pitch: float = 0.0, knee: float = 0.0, ankle: float = 0.0, yaw: float = 0.0, roll: float = 0.0
) -> Angles:
    """Return the angles of a leg (6,) [rad]; hip yaw and roll are positive outward."""
    return yaw, roll, pitch, knee, ankle, 0.0


def arm(pitch: float = 0.0, roll: float = 0.15, elbow: float = 0.0) -> Angles:
    """Return the angles of an arm (6,) [rad]; the roll is positive outward."""
    return pitch, roll, 0.0, elbow, 0.0, 0.0


@dataclass(frozen=True, slots=True)
class KeyPosture:
    """Key posture with its timing and required attitude.

    Attributes:
        name: of the posture.
        legs: left and right leg, each (6,), outward angles positive [rad].
        arms: left and right arm, each (6,), outward angles positive [rad].
        time: of the motion to it [s].
        hold: time in the posture [s].
        until: pitch of the trunk below which the next posture starts at once [rad].
        pitch: required range of the trunk's pitch at the end [rad].
    """

    name: str
    legs: tuple[Angles, Angles]
    arms: tuple[Angles, Angles]
    time: float
    hold: float = 0.0
    until: float | None = None
    pitch: tuple[float, float] | None = None

    def angles(self) -> list[float]:
        """Return the angles of all joints, the head straight (n,) [rad]."""
        right_leg = [m * a for m, a in zip(_LEG_MIRROR, self.legs[1], strict=True)]
        right_arm = [m * a for m, a in zip(_ARM_MIRROR, self.arms[1], strict=True)]
        return [*self.legs[0], *right_leg, 0.0, 0.0, *self.arms[0], *right_arm]

    def mirrored(self) -> KeyPosture:
        """Return the posture mirrored left to right."""
        return replace(self, legs=self.legs[::-1], arms=self.arms[::-1])


def symmetric(
    name: str,
    both_legs: Angles,
    both_arms: Angles,
    time: float,
    hold: float = 0.0,
    *,
    until: float | None = None,
    pitch: tuple[float, float] | None = None,
) -> KeyPosture:
    """Return a left-right symmetric posture."""
    legs, arms = (both_legs, both_legs), (both_arms, both_arms)
    return KeyPosture(name, legs, arms, time, hold, until, pitch)


STRAIGHT = symmetric("straight", leg(), arm(), 0.5)
