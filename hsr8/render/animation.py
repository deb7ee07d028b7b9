"""Animations that play where a video does not, such as in a page: GIF and WebP."""

from fractions import Fraction
from pathlib import Path

import av
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.render.atomic_writer import AtomicWriter

Image = NDArray[np.uint8]

COLORS = 96  # of a GIF, chosen for all of its pictures
WEBP = {"quality": "30", "compression_level": "6", "preset": "picture"}
KINDS = (".gif", ".webp")
MOST_PIXELS = 400_000_000  # of all pictures of a GIF: some 2 GB


class AnimationWriter(AtomicWriter):
    """Writes pictures; the file appears, repeating without end, when it is complete.

    Args:
        path: of the file; ends in ``.gif`` or ``.webp``.
        size: width and height [pixel].
        fps: pictures per second; a GIF counts time in hundredths of a second.
    """

    def __init__(self, path: Path, size: tuple[int, int], fps: int) -> None:
        self._path, self._fps, self._count = path, fps, 0
        self._draft = path.with_name(path.name + ".part")
        kind = path.suffix.lower().removeprefix(".")
        self._container = av.open(str(self._draft), "w", format=kind, options={"loop": "0"})
        # A GIF has one palette for all of its pictures: the graph keeps them until the last.
        self._graph = _palette_graph(size, fps) if kind == "gif" else None
        if self._graph is None:
            self._stream = self._container.add_stream("libwebp_anim", rate=fps, options=WEBP)
            self._stream.pix_fmt = "yuv420p"
        else:
            self._stream = self._container.add_stream("gif", rate=fps)
            self._stream.pix_fmt = "pal8"
            self._stream.time_base = Fraction(1, 100)
        self._stream.width, self._stream.height = size

    def add(self, image: Image) -> None:
        """Append one picture (height, width, 3)."""
        frame = av.VideoFrame.from_ndarray(image, format="rgb24")
        frame.pts, frame.time_base = self._count, Fraction(1, self._fps)
        self._count += 1
        if self._graph is None:
            self._container.mux(self._stream.encode(frame))
        else:
            self._graph.push(frame)

    def close(self, *, keep: bool = True) -> None:
        """Finish the file, or remove it; without pictures there is none."""
        complete = False
        try:
            if keep and self._count:
                self._encode_gif()
                self._container.mux(self._stream.encode(None))
                complete = True
        finally:
            self._container.close()
            try:
                if complete:
                    self._draft.replace(self._path)
            finally:
                self._draft.unlink(missing_ok=True)

    def _encode_gif(self) -> None:
        """Encode what waits for its palette."""
        if self._graph is None:
            return
        self._graph.push(None)
        while True:
            try:
                frame = self._graph.pull()
            except (av.FFmpegError, EOFError):
                break
            self._container.mux(self._stream.encode(frame))


def require_room(path: Path, size: tuple[int, int], count: int) -> None:
    """Refuse a GIF whose pictures would fill the memory.

    Args:
        path: of the file.
        size: width and height [pixel].
        count: of the pictures.

    Raises:
        UsageError: it would.
    """
    pixels = size[0] * size[1] * count
    if path.suffix.lower() == ".gif" and pixels > MOST_PIXELS:
        raise UsageError(
            f"{path} would be {count} pictures of {size[0]}x{size[1]}, {pixels / 1e6:.0f} million "
            f"pixels, which are in memory at once; at most {MOST_PIXELS / 1e6:.0f} million"
            "\n  fewer with --fps, --size, --start, --stop or --speed; .webp and .mp4 have no bound"
        )


def _palette_graph(size: tuple[int, int], fps: int) -> av.filter.Graph:
    """One palette for all pictures, so that what does not change costs nothing."""
    graph = av.filter.Graph()
    template = {"width": size[0], "height": size[1], "format": "rgb24"}
    source = graph.add_buffer(**template, time_base=Fraction(1, fps))
    split = graph.add("split")
    choose = graph.add("palettegen", f"max_colors={COLORS}:stats_mode=full")
    use = graph.add("paletteuse", "dither=bayer:bayer_scale=4:diff_mode=rectangle")
    sink = graph.add("buffersink")
    source.link_to(split)
    split.link_to(use, 0, 0)
    split.link_to(choose, 1, 0)
    choose.link_to(use, 0, 1)
    use.link_to(sink)
    graph.configure()
    return graph
