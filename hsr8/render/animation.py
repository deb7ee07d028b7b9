"""Animations for web pages: GIF and WebP."""

from fractions import Fraction
from pathlib import Path

import av

from hsr8.errors import UsageError
from hsr8.render.atomic_writer import AtomicWriter, Image

COLORS = 96  # in the palette of a GIF
WEBP = {"quality": "30", "compression_level": "6", "preset": "picture"}
KINDS = (".gif", ".webp")
MAX_PIXELS = 400_000_000  # of all images of a GIF, about 2 GB


class AnimationWriter(AtomicWriter):
    """Writer of an animation that repeats endlessly.

    Args:
        path: of the file; ends in ``.gif`` or ``.webp``.
        size: width and height [pixel].
        fps: images per second; a GIF counts time in hundredths of a second.
    """

    def __init__(self, path: Path, size: tuple[int, int], fps: int) -> None:
        super().__init__(path)
        self._fps, self._count = fps, 0
        kind = path.suffix.lower().removeprefix(".")
        self._container = av.open(str(self._draft), "w", format=kind, options={"loop": "0"})
        # The graph holds all images of a GIF to compute their common palette.
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
        """Append one image (height, width, 3)."""
        frame = av.VideoFrame.from_ndarray(image, format="rgb24")
        frame.pts, frame.time_base = self._count, Fraction(1, self._fps)
        self._count += 1
        if self._graph is None:
            self._container.mux(self._stream.encode(frame))
        else:
            self._graph.push(frame)

    def _finish(self, *, keep: bool) -> None:
        try:
            if keep:
                self._encode_gif()
                self._container.mux(self._stream.encode(None))
        finally:
            self._container.close()

    def _encode_gif(self) -> None:
        """Encode the images that wait for their palette."""
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
    """Refuse a GIF whose images would fill the memory.

    Args:
        path: of the file.
        size: width and height [pixel].
        count: number of images.

    Raises:
        UsageError: the GIF has too many pixels.
    """
    pixels = size[0] * size[1] * count
    if path.suffix.lower() == ".gif" and pixels > MAX_PIXELS:
        raise UsageError(
            f"{path}: {count} images of {size[0]}x{size[1]} are {pixels / 1e6:.0f} million pixels; "
            f"a GIF is limited to {MAX_PIXELS / 1e6:.0f} million"
            "\n  reduce them by --fps, --size, --start, --stop or --speed, or write .webp or .mp4"
        )


def _palette_graph(size: tuple[int, int], fps: int) -> av.filter.Graph:
    """Return a graph with one palette for all images, so that unchanged pixels cost nothing."""
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
