"""H.264 files that every browser plays, with exact timing."""

from concurrent.futures import Future, ThreadPoolExecutor
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
from numpy.typing import NDArray

from hsr8.render.atomic_writer import AtomicWriter

Image = NDArray[np.uint8]

OPTIONS = {"preset": "veryfast", "crf": "21", "threads": "1"}
OPTIONS_OF_CONTAINER = {"movflags": "+faststart"}  # a page plays it while it loads


class VideoWriter(AtomicWriter):
    """Writes frames; the file appears under its name when it is complete.

    Args:
        path: of the file.
        size: width and height, both even [pixel].
        fps: frames per second.
    """

    def __init__(self, path: Path, size: tuple[int, int], fps: int) -> None:
        self._path = path
        self._draft = path.with_name(path.name + ".part")
        self._container = av.open(str(self._draft), "w", format="mp4", options=OPTIONS_OF_CONTAINER)
        self._stream = self._container.add_stream("libx264", rate=fps, options=OPTIONS)
        self._stream.width, self._stream.height = size
        self._stream.pix_fmt = "yuv420p"
        self._tick = Fraction(1, fps)
        self._count = 0
        # Encoding leaves the interpreter lock alone: it runs beside the drawing.
        self._worker = ThreadPoolExecutor(max_workers=1)
        self._pending: Future[None] | None = None

    def add(self, image: Image) -> None:
        """Append one frame (height, width, 3)."""
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

    def close(self, *, keep: bool = True) -> None:
        """Finish the file, or remove it."""
        complete = False
        try:
            if keep:
                self._wait()
                self._container.mux(self._stream.encode(None))
                complete = True
        finally:
            self._worker.shutdown()
            self._container.close()
            try:
                if complete:
                    self._draft.replace(self._path)
            finally:
                self._draft.unlink(missing_ok=True)
