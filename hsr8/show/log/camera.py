"""Head camera: image, detections, gaze map."""

from math import cos, pi, sin

import cv2
import numpy as np
import rerun as rr
from numpy.typing import NDArray

from hsr8.recording import palette
from hsr8.recording.table import Table
from hsr8.show.log.stream import LogStream
from navigation.gaze.grid import GazeGrid
from navigation.parameters.gaze import GazeParameters
from vision.camera import PinholeCamera

Array = NDArray[np.float64]

CAMERA = "/world/camera"
EDGE, ONE = np.linspace(-1.0, 1.0, 7), np.ones(7)
OUTLINE = np.concatenate(  # of the square from -1 to 1 (28, 2)
    [np.column_stack(s) for s in ((EDGE, ONE), (ONE, -EDGE), (-EDGE, -ONE), (-ONE, EDGE))]
)


def style_camera(log: LogStream, camera: PinholeCamera, scale: float) -> None:
    """Set the styles of the head camera.

    Args:
        log: recording.
        camera: intrinsics.
        scale: scale of the robot, for the size of the image in the scene [1].
    """
    pinhole = rr.Pinhole(
        focal_length=camera.focal,
        width=camera.width,
        height=camera.height,
        camera_xyz=rr.ViewCoordinates.RDF,
        image_plane_distance=0.25 * scale,
    )
    log.log(CAMERA, pinhole, static=True)
    yellow = [palette.VIEW]
    log.style(f"{CAMERA}/image", rr.EncodedImage, media_type="image/jpeg")
    log.style(f"{CAMERA}/gaze_window", rr.LineStrips2D, colors=yellow, radii=[1.2])
    log.style("/gaze/map", rr.EncodedImage, media_type="image/png")
    log.style("/gaze/window", rr.LineStrips2D, colors=yellow, radii=[0.12])
    log.style("/gaze/choice", rr.Points2D, radii=[0.5])


def log_camera(log: LogStream, shown: Table, images: Table | None) -> None:
    """Log images and detections.

    Args:
        log: recording.
        shown: camera frames at the rate of the log.
        images: new images, if any.
    """
    detections, times = shown["detections"], shown["time"]
    boxes = detections["box"].astype(float)
    log.rows(
        f"{CAMERA}/detections",
        rr.Boxes2D,
        times,
        detections.counts,
        centers=0.5 * (boxes[:, :2] + boxes[:, 2:]),
        half_sizes=0.5 * (boxes[:, 2:] - boxes[:, :2]),
        colors=palette.packed_all(map(palette.of_label, detections["label"])),
        labels=[f"{distance:.1f} m" for distance in detections["distance"].tolist()],
    )
    if images is not None:
        blobs = [np.frombuffer(jpeg, np.uint8) for jpeg in images["jpeg"]]
        log.rows(f"{CAMERA}/image", rr.EncodedImage, images["time"], blob=blobs)


def log_gaze_window(log: LogStream, shown: Table, camera: PinholeCamera) -> None:
    """Log the gaze window in the image.

    Args:
        log: recording.
        shown: camera frames at the rate of the log.
        camera: intrinsics.
    """
    outlines = [
        image_points((pan, tilt), window, camera)
        for (pan, tilt), window in zip(shown["head"].tolist(), _windows(shown), strict=True)
    ]
    log.rows(
        f"{CAMERA}/gaze_window",
        rr.LineStrips2D,
        shown["time"],
        [int(outline is not None) for outline in outlines],
        strips=[outline for outline in outlines if outline is not None],
    )


def log_gaze(log: LogStream, frames: Table, gaze: GazeParameters) -> None:
    """Log new gaze maps, and the chosen gaze and its window in every frame."""
    grid, times = GazeGrid.of(gaze), frames["time"]
    rows, maps = frames.present("gaze_map")
    # A table, because OpenCV computes it at every call.
    heat = cv2.applyColorMap(np.arange(256, dtype=np.uint8)[:, None], cv2.COLORMAP_MAGMA)[:, 0]
    # Rows and columns of the map run up and left.
    blobs = [cv2.imencode(".png", heat[shades[::-1, ::-1]])[1].ravel() for shades in maps]
    log.rows("/gaze/map", rr.EncodedImage, times[rows], blob=blobs)
    log.rows(
        "/gaze/choice",
        rr.Points2D,
        times,
        positions=map_points(frames["gaze"], grid),
        colors=palette.packed_all([palette.BELIEF] * len(times)),
    )
    windows = [map_points(window, grid) for window in _windows(frames)]
    log.rows("/gaze/window", rr.LineStrips2D, times, strips=windows)


def _windows(frames: Table) -> Array:
    """Return the outlines of the chosen gaze windows, pan and tilt (n, m, 2) [rad]."""
    fov = np.minimum(frames["fov"], pi)
    outlines: Array = OUTLINE * (0.5 * fov)[:, None] + frames["gaze"][:, None]
    return outlines


def map_points(angles: Array, grid: GazeGrid) -> Array:
    """Return the pixels of directions in the image of the gaze map, clipped to its border.

    Args:
        angles: pan and tilt of n directions (n, 2) [rad].
        grid: cells of the map.

    Returns:
        Pixels (n, 2); cells are at their centres.
    """
    rows, columns = len(grid.tilt), len(grid.pan)
    u = 0.5 * columns - angles[:, 0] / grid.step
    v = rows - 0.5 - (angles[:, 1] - grid.tilt[0]) / grid.step
    return np.column_stack([np.clip(u, 0.0, columns), np.clip(v, 0.0, rows)])


def image_points(head: tuple[float, float], angles: Array, camera: PinholeCamera) -> Array | None:
    """Return the pixels of directions in the image of the head camera, clipped to its border.

    Args:
        head: pan and tilt, left and up positive [rad].
        angles: pan and tilt of n directions (n, 2) [rad].
        camera: intrinsics.

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
    pixels = camera.project(np.column_stack([-left, down, np.maximum(depth, 1e-3)]))
    return np.clip(pixels, 0.0, (camera.width, camera.height))
