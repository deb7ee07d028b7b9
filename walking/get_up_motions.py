"""Motions of HSR-VIII from lying to a squat, tuned in full physics.

From the front. The arms reach overhead and push the chest up while the legs fold. The hip flexes to
97° only, so the robot sits on its heels with the centre of mass 60 mm behind the knees, stable
without the arms. It leans back, tucks the toes under, rolls over them onto its soles and stops in
a squat. Only the push needs the full torque of the shoulders, 1.5 N·m.

From the back. A leg swings across and turns the trunk over to the front.

Their success rate is on the page on walking of the results.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

Angles = tuple[float, ...]

# In the order of `walking.body.tree.JOINT_NAMES`; mirroring changes the sign of roll and yaw.
_LEG_MIRROR = (-1.0, -1.0, 1.0, 1.0, 1.0, -1.0)
_ARM_MIRROR = (1.0, -1.0, -1.0, 1.0, -1.0, -1.0)

POINTED = 0.9  # ankle with the instep on the floor [rad]
TUCKED = -1.2  # ankle with the toes under the heel [rad]
FLEXED = -1.7  # hip, fully flexed [rad]
FOLDED = 2.3  # knee, fully flexed [rad]


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
        name: name of the posture.
        legs: left and right leg, each (6,), outward angles positive [rad].
        arms: left and right arm, each (6,), outward angles positive [rad].
        time: time of the motion to it [s].
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


@dataclass(frozen=True, slots=True)
class Motions:
    """Sequences of key postures.

    Attributes:
        rise: motion from the front to a squat.
        roll: motion from the back over the left side to the front.
        from_side: index of the first posture of `roll` when lying on the left side.
    """

    rise: tuple[KeyPosture, ...]
    roll: tuple[KeyPosture, ...]
    from_side: int


_RISE = (
    symmetric("arms apart", leg(ankle=POINTED), arm(0.0, 1.57), 0.4),
    symmetric("arms turned", leg(ankle=POINTED), arm(-2.6, 1.57), 0.41),
    symmetric("arms overhead", leg(-1.0, 2.0, POINTED), arm(-2.6, 0.2), 0.5, 0.1),
    symmetric(
        "push up",
        leg(FLEXED, FOLDED, POINTED),
        arm(-0.3, 0.1),
        0.4,
        0.4,
        until=1.2,
        pitch=(0.0, 1.5),
    ),
    symmetric("on heels", leg(-0.75, FOLDED, POINTED), arm(-0.3, 0.3), 0.4, 0.6, pitch=(-0.4, 0.4)),
    symmetric(
        "toes tucked", leg(0.3, FOLDED, TUCKED), arm(-0.3, 0.3), 0.5, 0.3, pitch=(-1.0, -0.3)
    ),
    symmetric("roll back", leg(0.43, FOLDED, TUCKED), arm(-0.15, 0.3), 0.33, 0.2, until=-0.65),
    symmetric("squat", leg(-1.45, FOLDED, -0.94), arm(-1.9, 0.3), 0.35, 0.25, pitch=(-0.6, 1.0)),
)

_TURNED_OVER = (leg(0.7, 0.45, yaw=-0.9, roll=0.25), leg(-0.6, 1.85, yaw=-0.9, roll=-0.5))
_DOWN_ARM, _LIFTED_ARM, _CROSSING_ARM = arm(-2.6, 0.1), arm(-1.5, 0.3), arm(-1.5, -0.3, -0.5)

_ROLL = (
    KeyPosture(
        "leg drawn up",
        (leg(0.3, 0.0, yaw=0.9, roll=-0.5), leg(-1.7, 1.05, yaw=0.55)),
        (_DOWN_ARM, _LIFTED_ARM),
        0.43,
    ),
    KeyPosture(
        "leg across",
        (leg(0.7, 0.35, yaw=0.9), leg(-1.0, 0.5, yaw=-0.75, roll=-0.15)),
        (_DOWN_ARM, _CROSSING_ARM),
        0.45,
        0.27,
    ),
    KeyPosture("turned over", _TURNED_OVER, (_DOWN_ARM, _CROSSING_ARM), 0.73, 0.3),
    KeyPosture("arms out", _TURNED_OVER, (arm(-2.6, 1.57), arm(-1.5, 1.57)), 0.4, 0.1),
    symmetric("legs apart", leg(roll=0.6), arm(-2.6, 1.57), 0.8, 0.1),
)

MOTIONS = Motions(rise=_RISE, roll=_ROLL, from_side=1)
