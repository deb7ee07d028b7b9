"""The complete state of a run as bytes, to continue it bit for bit.

Snapshots are data. They are read by an unpickler that knows the classes of the robot, of the
world and of arrays, and refuses every other name; a checksum tells damage before that.
"""

import hashlib
import io
import pickle
import struct
from collections.abc import Mapping
from enum import Enum
from types import FunctionType
from typing import Any

import mujoco

from hsr8.errors import UsageError
from hsr8.file_format import check_magic
from walking.body.robot_model import RobotModel

MAGIC = b"HSR8SNPF"  # its format last: raise it when classes in it change
_LENGTH = struct.Struct("<Q")
_DIGEST = 32
LARGEST = 256 * 1024 * 1024  # no snapshot is larger [byte]

LIBRARIES = ("navigation.", "walking.", "vision.", "hsr8.world.", "hsr8.scenario.")
MODULES = (
    "hsr8.decisions",
    "hsr8.event_watch",
    "hsr8.robot",
    "hsr8.command_schedule",
    "hsr8.recorder.record_buffer",
    "hsr8.recorder.frame_record",
    "hsr8.recorder.record",
    "hsr8.recorder.time_histogram",
    "hsr8.recorder.walk_counters",
    "hsr8.evaluation.metrics",
    "hsr8.evaluation.walk_metrics",
    "hsr8.evaluation.track_metrics",
)
OUTSIDE = ("hsr8.world.camera.rendered", "hsr8.world.model.models")  # they open files or OpenGL
NAMES = {
    "_codecs": ("encode",),
    "array": ("array", "_array_reconstructor"),
    "builtins": ("set", "frozenset", "slice", "complex", "bytearray"),
    "collections": ("deque", "Counter", "OrderedDict", "defaultdict"),
    "filterpy.kalman.UKF": ("UnscentedKalmanFilter",),
    "filterpy.kalman.sigma_points": ("JulierSigmaPoints",),
    "functools": ("partial",),
    "mujoco._structs": ("MjData",),
    "numpy": ("ndarray", "dtype", "subtract", "add"),
    "numpy._core.multiarray": ("_reconstruct", "scalar"),
    "numpy._core.numeric": ("_frombuffer",),
    "numpy.linalg": ("inv",),
    "numpy.random._pcg64": ("PCG64",),
    "numpy.random._sfc64": ("SFC64",),
    "numpy.random._pickle": ("__generator_ctor", "__bit_generator_ctor"),
    "numpy.random.bit_generator": ("__pyx_unpickle_SeedSequence", "SeedSequence"),
    "scipy.linalg._decomp_cholesky": ("cholesky",),
}


class Refused(pickle.UnpicklingError):
    """A snapshot asks for something that is none of its business."""


def encode(parts: Mapping[str, Any]) -> bytes:
    """Bytes of `parts`; shared objects stay shared."""
    buffer = io.BytesIO()
    _Writer(buffer, protocol=5).dump(dict(parts))
    payload = buffer.getvalue()
    return MAGIC + _LENGTH.pack(len(payload)) + hashlib.sha256(payload).digest() + payload


def decode(content: bytes, anchors: Mapping[str, Any], name: str) -> dict[str, Any]:
    """What `encode` was given.

    Args:
        content: bytes of a snapshot.
        anchors: ``model`` and ``robot model``, which are made anew and not stored.
        name: of the snapshot, for messages.

    Raises:
        UsageError: it is damaged, no snapshot of this format, or asks for what it must not.
    """
    start = len(MAGIC) + _LENGTH.size + _DIGEST
    check_magic(content, MAGIC, name, "snapshot")
    if len(content) < start:
        raise UsageError(f"{name} is cut off")
    (length,) = _LENGTH.unpack_from(content, len(MAGIC))
    payload = content[start:]
    if length != len(payload) or length > LARGEST:
        raise UsageError(f"{name} is cut off")
    if hashlib.sha256(payload).digest() != content[start - _DIGEST : start]:
        raise UsageError(f"{name} is damaged")
    try:
        parts = _Reader(io.BytesIO(payload), anchors).load()
    except Refused as error:
        raise UsageError(f"{name} is refused: {error}") from error
    except Exception as error:  # whatever a forged snapshot makes a constructor do
        raise UsageError(f"{name} cannot be read: {error}") from error
    if not isinstance(parts, dict):
        raise UsageError(f"{name} holds no run")
    return parts


class _Writer(pickle.Pickler):
    """Leaves out what is made anew, and names members of enumerations by their values."""

    def persistent_id(self, obj: Any) -> str | None:
        if isinstance(obj, mujoco.MjModel):
            return "model"
        if isinstance(obj, RobotModel):
            return "robot model"
        return None

    def reducer_override(self, obj: Any) -> Any:
        if isinstance(obj, Enum):  # before Python 3.11.4 they asked for `getattr`
            return type(obj), (obj.value,)
        return NotImplemented


class _Reader(pickle.Unpickler):
    """Knows the names of `NAMES` and the classes of the robot and its world."""

    def __init__(self, file: io.BytesIO, anchors: Mapping[str, Any]) -> None:
        super().__init__(file)
        self._anchors = anchors

    def persistent_load(self, pid: Any) -> Any:
        if pid not in self._anchors:
            raise Refused(f"it asks for {pid!r}")
        return self._anchors[pid]

    def find_class(self, module: str, name: str) -> Any:
        if name in NAMES.get(module, ()):
            return super().find_class(module, name)
        known = module in MODULES or module.startswith(LIBRARIES)
        if known and module not in OUTSIDE and "." not in name:
            found = super().find_class(module, name)
            function = isinstance(found, FunctionType) and module.startswith("navigation.")
            if (isinstance(found, type) or function) and found.__module__ == module:
                return found
        raise Refused(f"it asks for {module}.{name}")
