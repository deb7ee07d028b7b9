"""H.264 videos that every browser plays, with exact timing."""

from concurrent.futures import Future, ThreadPoolExecutor
from fractions import Fraction
from pathlib import Path

import av

from hsr8.render.atomic_writer import AtomicWriter, Image

OPTIONS = {"preset": "veryfast", "crf": "21", "threads": "1"}
CONTAINER_OPTIONS = {"movflags": "+faststart"}  # a page plays the video while it loads


class VideoWriter(AtomicWriter):
    """Writer of an MP4 file.

    Args:
        path: of the file.
        size: width and height, both even [pixel].
        fps: frames per second.
    """

    def __init__(self, path: Path, size: tuple[int, int], fps: int) -> None:
        super().__init__(path)
        self._container = av.open(str(self._draft), "w", format="mp4", options=CONTAINER_OPTIONS)
        self._stream = self._container.add_stream("libx264", rate=fps, options=OPTIONS)
        self._stream.width, self._stream.height = size
        self._stream.pix_fmt = "yuv420p"
        self._tick = Fraction(1, fps)
        self._count = 0
        # Encoding releases the interpreter lock, so it runs in parallel with drawing.
        self._worker = ThreadPoolExecutor(max_workers=1)
        self._pending: Future[None] | None = None

    def add(self, image: Image) -> None:
        """Append one image (height, width, 3)."""
        self._wait()
        self._pending = self._worker.submit(self._encode, image, self._count)
        self._count += 1

    def _encode(self, image: Image, index: int) -> None:
        frame = av.VideoFrame.from_ndarray(image, format="rgb24")
        frame.pts = index
        frame.time_base = self._tick
        self._container.mux(self._stream.encode(frame))

    def _wait(self) -> None:
        if self._pending is not None:
            self._pending.result()
            self._pending = None

    def _finish(self, *, keep: bool) -> None:
        try:
            if keep:
                self._wait()
                self._container.mux(self._stream.encode(None))
        finally:
            self._worker.shutdown()
            self._container.close()
