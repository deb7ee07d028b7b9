"""Measures of a robot that its walk scales with, and those of HSR-VIII."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class RobotMeasures:
    """Measures of a robot.

    Attributes:
        leg: hip to sole along the straight leg [m].
        hip: half the distance between the hips [m].
        sole: half the width of a sole [m].
        time: √(height / g) of the equivalent pendulum, see `RobotModel.pendulum_height` [s].
        weight: of the robot [N].
        ankle: relative compliance of an ankle servo, weight times pendulum height over
            stiffness [rad/rad].
    """

    leg: float
    hip: float
    sole: float
    time: float
    weight: float
    ankle: float


HSR_VIII = RobotMeasures(
    leg=0.245, hip=0.035, sole=0.03, time=0.146737, weight=53.955, ankle=0.0949724
)
"""Robot that the default parameters were tuned for."""
