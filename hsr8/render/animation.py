"""Animations that play where a video does not, such as in a page: GIF and WebP."""

from fractions import Fraction
from pathlib import Path

import av
import numpy as np
from numpy.typing import NDArray

from hsr8.render.keeping import KeptIfWhole

Image = NDArray[np.uint8]

COLOURS = 96  # of a GIF, chosen for all of its pictures
WEBP = {"quality": "30", "compression_level": "6", "preset": "picture"}
KINDS = (".gif", ".webp")


class AnimationWriter(KeptIfWhole):
    """Collects pictures; the file appears, repeating without end, when it is complete.

    Args:
        path: of the file; ends in ``.gif`` or ``.webp``.
        size: width and height [pixel].
        fps: pictures per second; a GIF counts time in hundredths of a second.
    """

    def __init__(self, path: Path, size: tuple[int, int], fps: int) -> None:
        self._path, self._size, self._fps = path, size, fps
        self._images: list[Image] = []

    def add(self, image: Image) -> None:
        """Append one picture (height, width, 3)."""
        self._images.append(image)

    def close(self, *, keep: bool = True) -> None:
        """Write the file, or nothing."""
        if not keep or not self._images:
            return
        draft = self._path.with_name(self._path.name + ".part")
        kind = self._path.suffix.lower().removeprefix(".")
        try:
            with av.open(str(draft), "w", format=kind, options={"loop": "0"}) as container:
                if kind == "gif":
                    self._write_gif(container)
                else:
                    self._write_webp(container)
            draft.replace(self._path)
        finally:
            draft.unlink(missing_ok=True)

    def _frames(self) -> list[av.VideoFrame]:
        frames = []
        for index, image in enumerate(self._images):
            frame = av.VideoFrame.from_ndarray(image, format="rgb24")
            frame.pts, frame.time_base = index, Fraction(1, self._fps)
            frames.append(frame)
        return frames

    def _write_webp(self, container: av.container.OutputContainer) -> None:
        stream = container.add_stream("libwebp_anim", rate=self._fps, options=WEBP)
        stream.width, stream.height = self._size
        stream.pix_fmt = "yuv420p"
        for frame in self._frames():
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))

    def _write_gif(self, container: av.container.OutputContainer) -> None:
        """One palette for all pictures, so that what does not change costs nothing."""
        stream = container.add_stream("gif", rate=self._fps)
        stream.width, stream.height = self._size
        stream.pix_fmt = "pal8"
        stream.time_base = Fraction(1, 100)
        graph = av.filter.Graph()
        template = {"width": self._size[0], "height": self._size[1], "format": "rgb24"}
        source = graph.add_buffer(**template, time_base=Fraction(1, self._fps))
        split = graph.add("split")
        choose = graph.add("palettegen", f"max_colors={COLOURS}:stats_mode=full")
        use = graph.add("paletteuse", "dither=bayer:bayer_scale=4:diff_mode=rectangle")
        sink = graph.add("buffersink")
        source.link_to(split)
        split.link_to(use, 0, 0)
        split.link_to(choose, 1, 0)
        choose.link_to(use, 0, 1)
        use.link_to(sink)
        graph.configure()
        for frame in self._frames():
            source.push(frame)
        source.push(None)
        while True:
            try:
                frame = sink.pull()
            except (av.FFmpegError, EOFError):
                break
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
