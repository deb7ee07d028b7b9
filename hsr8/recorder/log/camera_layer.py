"""Head camera: pose, image, detections, gaze map."""

from collections.abc import Sequence
from math import cos, pi, radians, sin, tan

import cv2
import mujoco
import numpy as np
import rerun as rr
from numpy.typing import NDArray

from hsr8.recorder import palette
from hsr8.recorder.log.channel import BlockStream, Channel
from hsr8.recorder.table import Table
from hsr8.robots.normal_form import HEAD_CAMERA
from navigation.parameters.gaze import GazeParameters

Array = NDArray[np.float64]

EDGE, ONE = np.linspace(-1.0, 1.0, 7), np.ones(7)
OUTLINE = np.concatenate(  # of the square from -1 to 1 (28, 2)
    [np.column_stack(s) for s in ((EDGE, ONE), (ONE, -EDGE), (-EDGE, -ONE), (-ONE, EDGE))]
)


class CameraLayer:
    """Layer of the head camera.

    Args:
        stream: recording.
        model: compiled world.
        size: width and height of the image [pixel].
        gaze: range of the gaze map, and size of its window.
        scale: of the robot, for the size of the image in the scene [1].
    """

    def __init__(
        self,
        stream: BlockStream,
        model: mujoco.MjModel,
        size: tuple[int, int],
        gaze: GazeParameters,
        *,
        scale: float = 1.0,
    ) -> None:
        self._parameters, self._box = gaze, gaze.box_fraction
        self._size = width, height = size
        fov = radians(float(model.camera(HEAD_CAMERA).fovy[0]))
        self._focal = focal = 0.5 * height / tan(0.5 * fov)
        stream.log(
            "/world/camera",
            rr.Pinhole(
                focal_length=focal,
                width=width,
                height=height,
                camera_xyz=rr.ViewCoordinates.RDF,
                image_plane_distance=0.25 * scale,
            ),
            static=True,
        )
        # A table, because OpenCV computes it at every call.
        ramp = np.arange(256, dtype=np.uint8)[:, None]
        self._heat = cv2.applyColorMap(ramp, cv2.COLORMAP_MAGMA)[:, 0]
        self._pose = Channel(stream, "/world/camera", rr.Transform3D)
        image, lines, yellow = rr.EncodedImage, rr.LineStrips2D, [palette.VIEW]
        self._image = Channel(stream, "/world/camera/image", image, media_type="image/jpeg")
        self._boxes = Channel(stream, "/world/camera/detections", rr.Boxes2D)
        self._gaze_map = Channel(stream, "/gaze/map", image, media_type="image/png")
        self._window = Channel(stream, "/gaze/window", lines, colors=yellow, radii=[0.12])
        self._image_window = Channel(
            stream, "/world/camera/gaze_window", lines, colors=yellow, radii=[1.2]
        )
        self._choice = Channel(stream, "/gaze/choice", rr.Points2D, radii=[0.5])

    def add_poses(self, times: Sequence[float], positions: Array, rotations: Array) -> None:
        """Add true poses: positions (n, 3) [m] and MuJoCo's quaternions x-y-z-w (n, 4)."""
        # MuJoCo's camera looks along -z with y up, Rerun's along z with y down: half a turn.
        turned = rotations[:, [3, 2, 1, 0]] * (1.0, 1.0, -1.0, -1.0)
        self._pose.add_rows(times, [1] * len(times), translation=positions, quaternion=turned)

    def add_frames(self, frames: Table, shown: Table, images: Table | None) -> None:
        """Take camera frames.

        Args:
            frames: all new frames.
            shown: those at the rate of the log.
            images: new images, if any.
        """
        detections, times = shown["detections"], shown["time"].tolist()
        boxes = detections["box"].astype(float)
        self._boxes.add_rows(
            times,
            detections.counts.tolist(),
            centers=0.5 * (boxes[:, :2] + boxes[:, 2:]),
            half_sizes=0.5 * (boxes[:, 2:] - boxes[:, :2]),
            colors=palette.packed_all(map(palette.of_label, detections["label"])),
            labels=[f"{distance:.1f} m" for distance in detections["distance"].tolist()],
        )
        if images is not None:
            for time, jpeg in zip(images["time"].tolist(), images["jpeg"], strict=True):
                self._image.add(time, blob=[np.frombuffer(jpeg, np.uint8)])
        windows = _windows(shown, self._box)
        for time, (pan, tilt), window in zip(times, shown["head"].tolist(), windows, strict=True):
            outline = image_points((pan, tilt), window, self._focal, self._size)
            strips = np.empty((0, *window.shape)) if outline is None else outline[None]
            self._image_window.add(time, strips=strips)
        self._add_maps(frames)

    def _add_maps(self, frames: Table) -> None:
        """Add new gaze maps."""
        rows, maps = frames.present("gaze_map")
        new = frames.take(rows)
        columns = (new["time"].tolist(), maps, new["gaze"], _windows(new, self._box))
        for time, shades, gaze, window in zip(*columns, strict=True):
            # Rows and columns of the map run up and left.
            colored = self._heat[shades[::-1, ::-1]]
            self._gaze_map.add(time, blob=[cv2.imencode(".png", colored)[1].ravel()])
            self._choice.add(
                time,
                positions=map_points(gaze[None], shades.shape, self._parameters),
                colors=palette.packed_all([palette.BELIEF]),
            )
            strips = map_points(window, shades.shape, self._parameters)[None]
            self._window.add(time, strips=strips)


def _windows(frames: Table, box: float) -> Array:
    """Return the outlines of the chosen gaze windows, pan and tilt (n, m, 2) [rad].

    Args:
        frames: camera frames.
        box: side of the window as a fraction of the field of view [1].
    """
    fov = np.minimum(frames["fov"], pi)
    outlines: Array = OUTLINE * (box * fov)[:, None] + frames["gaze"][:, None]
    return outlines


def map_points(angles: Array, shape: tuple[int, ...], gaze: GazeParameters) -> Array:
    """Return the pixels of directions in the image of the gaze map, clipped to its border.

    Args:
        angles: pan and tilt of n directions (n, 2) [rad].
        shape: cells of the map, tilts and pans.
        gaze: range of the map.

    Returns:
        Pixels (n, 2); cells are at their centres.
    """
    rows, columns = shape
    u = 0.5 * columns - angles[:, 0] / gaze.step
    v = rows - 0.5 - (angles[:, 1] - gaze.min_tilt) / gaze.step
    return np.column_stack([np.clip(u, 0.0, columns), np.clip(v, 0.0, rows)])


def image_points(
    head: tuple[float, float], angles: Array, focal: float, size: tuple[int, int]
) -> Array | None:
    """Return the pixels of directions in the image of the head camera, clipped to its border.

    Args:
        head: pan and tilt, left and up positive [rad].
        angles: pan and tilt of n directions (n, 2) [rad].
        focal: length [pixel].
        size: width and height of the image [pixel].

    Returns:
        Pixels (n, 2); None if all directions are behind the camera.
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
