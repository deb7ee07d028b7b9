"""The head camera: its pose in the world, its image, what was recognised, the gaze map."""

from collections.abc import Sequence
from math import cos, pi, radians, sin, tan

import cv2
import mujoco
import numpy as np
import rerun as rr
from numpy.typing import NDArray

from hsr8.recorder import palette
from hsr8.recorder.frame_record import FrameRecord, Image
from hsr8.recorder.log.block_stream import BlockStream
from hsr8.recorder.log.channel import Channel
from hsr8.recorder.log.geometry import xyzw
from hsr8.world.model.assembly import HEAD_CAMERA
from navigation.decision import GazeDecision
from navigation.parameters.gaze import GazeParameters

Array = NDArray[np.float64]

EDGE, ONE = np.linspace(-1.0, 1.0, 7), np.ones(7)
OUTLINE = np.concatenate(  # of the square from -1 to 1 (28, 2)
    [np.column_stack(s) for s in ((EDGE, ONE), (ONE, -EDGE), (-EDGE, -ONE), (-ONE, EDGE))]
)


class CameraLayer:
    """Logs the camera.

    Args:
        stream: where it goes.
        model: compiled world, which has the camera.
        size: width and height of the image [pixel].
        jpeg: quality of the images [%].
        gaze: what the gaze map spans, and the window in which its votes are summed.
    """

    def __init__(
        self,
        stream: BlockStream,
        model: mujoco.MjModel,
        size: tuple[int, int],
        jpeg: int,
        gaze: GazeParameters,
    ) -> None:
        self._jpeg_quality = jpeg
        self._parameters = gaze
        self._gaze: GazeDecision | None = None  # that is shown
        self._times: list[float] = []
        self._positions: list[Array] = []
        self._rotations: list[Array] = []
        self._id = model.camera(HEAD_CAMERA).id
        self._size = width, height = size
        self._focal = focal = 0.5 * height / tan(0.5 * radians(float(model.cam_fovy[self._id])))
        stream.log(
            "/world/camera",
            rr.Pinhole(
                focal_length=focal,
                width=width,
                height=height,
                camera_xyz=rr.ViewCoordinates.RDF,
                image_plane_distance=0.25,
            ),
            static=True,
        )
        stream.log(
            "/world/camera/image",
            rr.EncodedImage.from_fields(media_type="image/jpeg"),
            static=True,
        )
        stream.log("/gaze/choice", rr.Points2D.from_fields(radii=[0.5]), static=True)
        for path, radius in (("/gaze/window", 0.12), ("/world/camera/gaze_window", 1.2)):
            style = rr.LineStrips2D.from_fields(colors=[palette.VIEW], radii=[radius])
            stream.log(path, style, static=True)
        # OpenCV builds its table anew at every call.
        ramp = np.arange(256, dtype=np.uint8)[:, None]
        self._heat = cv2.applyColorMap(ramp, cv2.COLORMAP_MAGMA)[:, 0]
        self._pose = Channel(stream, "/world/camera", rr.Transform3D.columns)
        self._image = Channel(stream, "/world/camera/image", rr.EncodedImage.columns)
        self._boxes = Channel(stream, "/world/camera/detections", rr.Boxes2D.columns)
        self._gaze_map = Channel(stream, "/gaze/map", rr.EncodedImage.columns)
        self._window = Channel(stream, "/gaze/window", rr.LineStrips2D.columns)
        self._seen_window = Channel(stream, "/world/camera/gaze_window", rr.LineStrips2D.columns)
        self._choice = Channel(stream, "/gaze/choice", rr.Points2D.columns)
        stream.log("/gaze/map", rr.EncodedImage.from_fields(media_type="image/png"), static=True)

    def add_pose(self, time: float, data: mujoco.MjData) -> None:
        """Take the camera's true pose from `data`."""
        self._times.append(time)
        self._positions.append(data.cam_xpos[self._id].copy())
        self._rotations.append(data.cam_xmat[self._id].copy())

    def add_frames(self, frames: Sequence[FrameRecord]) -> None:
        """Take camera frames."""
        found = [d for frame in frames for d in frame.detections]
        boxes = np.array([d.box for d in found], dtype=float).reshape(-1, 4)
        self._boxes.add_rows(
            [frame.time for frame in frames],
            [len(frame.detections) for frame in frames],
            centers=0.5 * (boxes[:, :2] + boxes[:, 2:]),
            half_sizes=0.5 * (boxes[:, 2:] - boxes[:, :2]),
            colors=palette.packed_all(palette.of_label(d.label) for d in found),
            labels=[f"{d.distance:.1f} m" for d in found],
        )
        for frame in frames:
            if frame.image is not None:
                self._image.add(frame.time, blob=[_jpeg(frame.image, self._jpeg_quality)])
            self._add_gaze(frame)

    def flush(self) -> None:
        """Send the block."""
        if self._times:
            self._pose.add_rows(
                self._times,
                [1] * len(self._times),
                translation=np.array(self._positions),
                quaternion=_attitudes(np.array(self._rotations)),
            )
        self._times.clear()
        self._positions.clear()
        self._rotations.clear()
        for channel in (
            self._pose,
            self._image,
            self._boxes,
            self._gaze_map,
            self._choice,
            self._window,
            self._seen_window,
        ):
            channel.flush()

    def _add_gaze(self, frame: FrameRecord) -> None:
        gaze_map = frame.gaze.gaze_map
        window = self._outline(frame)
        view = frame.belief.view
        seen = image_points((view.pan, view.tilt), window, self._focal, self._size)
        self._seen_window.add(frame.time, strips=[] if seen is None else [seen])
        if frame.gaze is self._gaze or gaze_map.size <= 1:
            return
        self._gaze = frame.gaze
        top = float(gaze_map.max())
        shades = np.zeros(gaze_map.shape, np.uint8)
        if top > 0.0:
            shades = np.round(255.0 * gaze_map / top).astype(np.uint8)
        # Left and up in the head are left and up in the picture.
        colored = self._heat[shades[::-1, ::-1]]
        self._gaze_map.add(frame.time, blob=[cv2.imencode(".png", colored)[1].ravel()])
        chosen = np.array([[frame.gaze.pan, frame.gaze.tilt]])
        self._choice.add(
            frame.time,
            positions=map_points(chosen, gaze_map.shape, self._parameters),
            colors=palette.packed_all([palette.BELIEF]),
        )
        self._window.add(frame.time, strips=[map_points(window, gaze_map.shape, self._parameters)])

    def _outline(self, frame: FrameRecord) -> Array:
        """Outline of the gaze window that was chosen: pan and tilt (n, 2) [rad]."""
        view, gaze = frame.belief.view, frame.gaze
        fov = np.minimum([view.horizontal_fov, view.vertical_fov], pi)
        found: Array = OUTLINE * (self._parameters.box_fraction * fov) + (gaze.pan, gaze.tilt)
        return found


def map_points(angles: Array, shape: tuple[int, ...], gaze: GazeParameters) -> Array:
    """Where directions are in the picture of the gaze map; what lies beyond it is on its border.

    Args:
        angles: pan and tilt of n directions (n, 2) [rad].
        shape: cells of the map, tilts and pans.
        gaze: what the map spans.

    Returns:
        Pixels (n, 2), those of cells at their middles.
    """
    rows, columns = shape
    u = 0.5 * columns - angles[:, 0] / gaze.step
    v = rows - 0.5 - (angles[:, 1] - gaze.min_tilt) / gaze.step
    return np.column_stack([np.clip(u, 0.0, columns), np.clip(v, 0.0, rows)])


def image_points(
    head: tuple[float, float], angles: Array, focal: float, size: tuple[int, int]
) -> Array | None:
    """Where directions are in the image of the head camera.

    What lies beyond the image is put on its border.

    Args:
        head: pan and tilt, left and up positive [rad].
        angles: pan and tilt of n directions (n, 2) [rad].
        focal: length [pixel].
        size: width and height of the image [pixel].

    Returns:
        Pixels (n, 2); None if all of the directions are behind the camera.
    """
    tilt = head[1]
    turn, up = angles[:, 0] - head[0], angles[:, 1]
    ahead = np.cos(up) * np.cos(turn)
    left, high = np.cos(up) * np.sin(turn), np.sin(up)
    depth = ahead * cos(tilt) + high * sin(tilt)
    down = ahead * sin(tilt) - high * cos(tilt)
    if (depth <= 0.0).all():
        return None
    depth = np.maximum(depth, 1e-3)
    pixels = np.column_stack(
        [0.5 * size[0] - focal * left / depth, 0.5 * size[1] + focal * down / depth]
    )
    return np.clip(pixels, 0.0, size)


def _attitudes(rotations: Array) -> Array:
    """Quaternions in Rerun's order (n, 4) of a camera with MuJoCo's rotations (n, 9)."""
    # MuJoCo's camera looks along -z with y up; Rerun's as the project's along z, y down.
    turned = rotations * np.tile((1.0, -1.0, -1.0), 3)
    found = np.empty((len(turned), 4))
    for quaternion, rotation in zip(found, turned, strict=True):
        mujoco.mju_mat2Quat(quaternion, rotation)
    return xyzw(found)


def _jpeg(image: Image, quality: int) -> NDArray[np.uint8]:
    bgr = cv2.cvtColor(image, cv2.COLOR_RGB2BGR)
    encoded = cv2.imencode(".jpg", bgr, [cv2.IMWRITE_JPEG_QUALITY, quality])[1]
    blob: NDArray[np.uint8] = encoded.ravel()
    return blob
