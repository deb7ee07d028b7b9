"""Videos for web pages: H.264 with exact timing, and WebP animations that repeat endlessly."""

from concurrent.futures import Future, ThreadPoolExecutor
from fractions import Fraction
from pathlib import Path
from typing import Self

import av
import cv2

from hsr8.show.image import Image

# Codec, its options and those of the container, by suffix.
FORMATS: dict[str, tuple[str, dict[str, str], dict[str, str]]] = {
    ".mp4": (
        "libx264",
        {"preset": "veryfast", "crf": "21", "threads": "1"},
        {"movflags": "+faststart"},  # a page plays the video while it loads
    ),
    ".webp": (
        "libwebp_anim",
        {"quality": "30", "compression_level": "6", "preset": "picture"},
        {"loop": "0"},
    ),
}


class VideoWriter:
    """Writer of a video, used by ``with``; the file is complete at the end.

    Args:
        path: path of the file; its suffix is one of `FORMATS`.
        size: width and height, both even [pixel].
        fps: frames per second.
    """

    def __init__(self, path: Path, size: tuple[int, int], fps: int) -> None:
        kind = path.suffix.lower()
        codec, options, container_options = FORMATS[kind]
        self._container = av.open(str(path), "w", options=container_options)
        self._stream = self._container.add_stream(codec, rate=fps, options=options)
        self._stream.width, self._stream.height = size
        self._stream.pix_fmt = "yuv420p"
        self._tick = Fraction(1, fps)
        self._count = 0
        # Encoding releases the interpreter lock, so it runs in parallel with drawing.
        self._worker = ThreadPoolExecutor(max_workers=1)
        self._pending: Future[None] | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        try:
            if kind is None:
                self._wait()
                self._container.mux(self._stream.encode(None))
        finally:
            self._worker.shutdown()
            self._container.close()

    def add(self, image: Image) -> None:
        """Append one frame (height, width, 3)."""
        # A copy, since the caller may draw the next frame over `image`; a quarter of av's time.
        planes = cv2.cvtColor(image, cv2.COLOR_RGB2YUV_I420)
        self._wait()
        self._pending = self._worker.submit(self._encode, planes, self._count)
        self._count += 1

    def _encode(self, planes: Image, index: int) -> None:
        frame = av.VideoFrame.from_ndarray(planes, format="yuv420p")
        frame.pts, frame.time_base = index, self._tick
        self._container.mux(self._stream.encode(frame))

    def _wait(self) -> None:
        if self._pending is not None:
            self._pending.result()
            self._pending = None
