"""The arms swing against the legs."""

from walking.parameters import ArmParameters


def arm_swing(feet_apart: float, parameters: ArmParameters) -> float:
    """Shoulder pitch of the left arm away from the ready posture; the right one mirrors it.

    Args:
        feet_apart: left foot ahead of the right foot along the heading [m].
        parameters: gain and limit.

    Returns:
        backward positive [rad].
    """
    limit = parameters.limit
    return min(limit, max(-limit, parameters.swing * feet_apart))
