"""Measures of a robot, by which its walk scales, and those of HSR-VIII."""

from dataclasses import astuple, dataclass


@dataclass(frozen=True, slots=True)
class RobotMeasures:
    """Measures of a robot.

    Attributes:
        leg: hip to sole along the straight leg [m].
        hip: half the distance between the hips [m].
        sole: half the width of a sole [m].
        time: √(height / g) of the pendulum that the robot is for its base [s].
        weight: of the robot [N].
        ankle: compliance of an ankle's servo: what it gives way under the weight's moment
            about the ankle, the pendulum as the lever [rad/rad].
    """

    leg: float
    hip: float
    sole: float
    time: float
    weight: float
    ankle: float

    def values(self) -> tuple[float, ...]:
        """All of them, in order."""
        return astuple(self)


HSR_VIII = RobotMeasures(
    leg=0.245, hip=0.035, sole=0.03, time=0.146737, weight=53.955, ankle=0.0949724
)
"""The robot for which the defaults of the parameters were chosen."""
