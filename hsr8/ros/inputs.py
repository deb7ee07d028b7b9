"""Messages that drive the robot: their topics, and the commands in them."""

from collections.abc import Callable, Collection
from dataclasses import dataclass
from math import isfinite
from typing import Any

MAX_NUMBER = 100.0  # of a velocity or an angle [m/s, rad/s, rad]
MAX_SIZE = 65536  # of a message [byte]

Command = tuple[float, float, float] | dict[str, float]
"""Velocity vx, vy, wz in R [m/s, m/s, rad/s], or angles by joint [rad]."""


@dataclass(frozen=True, slots=True)
class Input:
    """Topic with commands.

    Attributes:
        name: name of the topic.
        kind: type of its messages.
        command: function that returns the command in a message.
    """

    name: str
    kind: str
    command: Callable[[Any], Command]

    def read(self, store: Any, payload: bytes, joints: Collection[str]) -> Command:
        """Return the command in a serialized message.

        Args:
            store: definitions of the message types.
            payload: message in CDR.
            joints: names of the joints of the robot; others are left out.

        Raises:
            ValueError: the message is malformed or has an invalid number.
        """
        if len(payload) > MAX_SIZE:
            raise ValueError(f"got {len(payload)} bytes; expected at most {MAX_SIZE}")
        try:
            command = self.command(store.deserialize_cdr(payload, self.kind))
        except Exception as error:  # whatever bytes from the network lead to
            raise ValueError(f"malformed message, {error}") from error
        if isinstance(command, dict):
            command = {name: angle for name, angle in command.items() if name in joints}
        numbers = command.values() if isinstance(command, dict) else command
        for number in numbers:
            if not (isfinite(number) and abs(number) <= MAX_NUMBER):
                raise ValueError(f"got {number:g}; expected -{MAX_NUMBER:g} to {MAX_NUMBER:g}")
        return command


def _twist(twist: Any) -> Command:
    return float(twist.linear.x), float(twist.linear.y), float(twist.angular.z)


def _joints(names: list[str], positions: Any) -> Command:
    return dict(zip(names, map(float, positions), strict=True))


INPUTS = (
    Input("/cmd_vel", "geometry_msgs/msg/Twist", _twist),
    Input("/cmd_vel", "geometry_msgs/msg/TwistStamped", lambda message: _twist(message.twist)),
    Input(
        "/head/command",
        "sensor_msgs/msg/JointState",
        lambda message: _joints(message.name, message.position),
    ),
    Input(
        "/head/command",
        "trajectory_msgs/msg/JointTrajectory",
        lambda message: _joints(message.joint_names, message.points[-1].positions),
    ),
)
"""Topics that drive the robot; of a trajectory the last point counts."""
DRIVEN = {topic.name for topic in INPUTS}
