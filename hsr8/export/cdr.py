"""ROS 2 messages in CDR."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import cos, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

Stamps = NDArray[np.int64]
Contents = dict[str, Any]
"""Fields of a message by name; those left out are zero or empty."""

PLANE = np.ix_([0, 1, 5], [0, 1, 5])  # x, y and yaw among the six axes of ROS covariances
BASE, NAME, ARRAY, SEQUENCE = 1, 2, 3, 4  # values of rosbags.interfaces.Nodetype


@dataclass(frozen=True)
class Messages:
    """Serializer of messages.

    Args:
        store: definitions of the message types, a `rosbags.typesys.store.Typestore`.
    """

    store: Any

    def one(self, kind: str, contents: Contents) -> bytes:
        """Return a message.

        Args:
            kind: type, such as ``nav_msgs/msg/Odometry``.
            contents: its fields.
        """
        return bytes(self.store.serialize_cdr(self._message(kind, contents), kind))

    def _message(self, kind: str, contents: Contents) -> Any:
        _, fields = self.store.fielddefs[kind]
        if unknown := contents.keys() - {name for name, _ in fields}:
            raise KeyError(f"{kind} lacks {unknown}")
        parts = {name: self._field(node, spec, contents.get(name)) for name, (node, spec) in fields}
        return self.store.types[kind](**parts)

    def _field(self, node: Any, spec: Any, value: Any) -> Any:
        """Return the value of a field, zero or empty without a `value`."""
        if node == NAME:
            return self._message(spec, value or {})
        if node == BASE:
            return value if value is not None else "" if spec[0] == "string" else 0
        (inner, element), length = spec
        if inner == NAME:
            return [self._message(element, item) for item in value or ()]
        if element[0] == "string":
            return list(value or ())
        number = np.dtype(element[0])
        if isinstance(value, bytes):
            return np.frombuffer(value, number)
        return np.array(value if value is not None else np.zeros(length), number)


def stamp(nanoseconds: int) -> Contents:
    """Return the fields of a time."""
    sec, nanosec = divmod(nanoseconds, 10**9)
    return {"sec": sec, "nanosec": nanosec}


def nanoseconds(times: Any) -> Stamps:
    """Return times (n,) [s] in nanoseconds."""
    return np.round(1e9 * np.asarray(times, np.float64)).astype(np.int64)


def header(time: Contents, frame: str) -> Mapping[str, Any]:
    """Return the fields of a header."""
    return {"stamp": time, "frame_id": frame}


def pose_of(pose: Sequence[float]) -> Contents:
    """Return the contents of a pose x, y, heading."""
    x, y, yaw = pose
    turn = {"w": cos(0.5 * yaw), "z": sin(0.5 * yaw)}
    return {"position": xyz([x, y, 0.0]), "orientation": turn}


def uncertain_pose(pose: Sequence[float], covariance: Any = 0.0) -> Contents:
    """Return a pose x, y, heading with its covariance (3, 3)."""
    whole = np.zeros((6, 6))
    whole[PLANE] = covariance
    return {"pose": pose_of(pose), "covariance": whole.ravel()}


def twist_of(vx: float, vy: float, wz: float) -> Contents:
    """Return a planar velocity."""
    return {"linear": {"x": vx, "y": vy}, "angular": {"z": wz}}


def xyz(values: Sequence[float]) -> Contents:
    """Return a vector."""
    return dict(zip("xyz", values, strict=True))


def wxyz(values: Sequence[float]) -> Contents:
    """Return a quaternion, w first."""
    return dict(zip("wxyz", values, strict=True))
