"""Key postures: what the joints are driven to on the way from lying to standing."""

from __future__ import annotations

from dataclasses import dataclass

Angles = tuple[float, ...]

# In the order of `joints.JOINT_NAMES`; in a mirror, roll and yaw change their sign.
_LEG_MIRROR = (-1.0, -1.0, 1.0, 1.0, 1.0, -1.0)
_ARM_MIRROR = (1.0, -1.0, -1.0, 1.0, -1.0, -1.0)


def leg(
    pitch: float = 0.0, knee: float = 0.0, ankle: float = 0.0, yaw: float = 0.0, roll: float = 0.0
) -> Angles:
    """Angles of a leg (6,) [rad]; hip yaw and roll are positive outward."""
    return yaw, roll, pitch, knee, ankle, 0.0


def arm(pitch: float = 0.0, roll: float = 0.15, elbow: float = 0.0) -> Angles:
    """Angles of an arm (6,) [rad]; the roll is positive outward."""
    return pitch, roll, 0.0, elbow, 0.0, 0.0


@dataclass(frozen=True, slots=True)
class KeyPosture:
    """A posture, the way to it and what must have come of it.

    Attributes:
        name: for people.
        legs: left and right leg, each (6,), outward angles positive [rad].
        arms: left and right arm, each (6,), outward angles positive [rad].
        time: of the motion to it [s].
        hold: time that it is held [s].
        until: pitch of the trunk below which the next posture begins at once [rad].
        pitch: between which bounds the trunk's pitch must be at the end [rad].
    """

    name: str
    legs: tuple[Angles, Angles]
    arms: tuple[Angles, Angles]
    time: float
    hold: float = 0.0
    until: float | None = None
    pitch: tuple[float, float] | None = None

    def angles(self) -> list[float]:
        """Angles of all joints, the head straight (26,) [rad]."""
        right_leg = [m * a for m, a in zip(_LEG_MIRROR, self.legs[1], strict=True)]
        right_arm = [m * a for m, a in zip(_ARM_MIRROR, self.arms[1], strict=True)]
        return [*self.legs[0], *right_leg, 0.0, 0.0, *self.arms[0], *right_arm]

    def mirrored(self) -> KeyPosture:
        """The posture seen in a mirror."""
        return KeyPosture(
            self.name,
            self.legs[::-1],
            self.arms[::-1],
            self.time,
            self.hold,
            self.until,
            self.pitch,
        )


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
    """A posture that is its own mirror image."""
    legs, arms = (both_legs, both_legs), (both_arms, both_arms)
    return KeyPosture(name, legs, arms, time, hold, until, pitch)


STRAIGHT = symmetric("straight", leg(), arm(), 0.5)
