"""A video in segments, so that an interrupted one goes on where it stopped."""

import fcntl
import os
import shutil
from pathlib import Path
from typing import Self

import av

from hsr8.errors import UsageError
from hsr8.render.video import OPTIONS_OF_CONTAINER

KEY = "what.txt"


class Segments:
    """The folder that holds the finished segments of one video while it is made.

    Used by ``with``: inside, nobody else may make that video.

    Args:
        video: file that is to be made; the folder lies beside it.
        key: tells apart videos that are not made of the same pictures.

    Raises:
        UsageError: by ``with``, somebody else is making it.
    """

    def __init__(self, video: Path, key: str) -> None:
        self._video = video
        self._folder = video.with_name(video.name + ".parts")
        self._key = key
        self._known = False
        self._handle = -1

    def __enter__(self) -> Self:
        self._folder.mkdir(exist_ok=True)
        self._handle = os.open(self._folder, os.O_RDONLY)
        try:
            fcntl.flock(self._handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            self._take_over()
        except BaseException as error:
            os.close(self._handle)
            if isinstance(error, BlockingIOError):
                raise UsageError(
                    f"another hsr8 render is drawing {self._video}; wait, or choose another file "
                    "with --out"
                ) from None
            raise
        return self

    def __exit__(self, *_: object) -> None:
        os.close(self._handle)

    def _take_over(self) -> None:
        """Keep what the folder holds of this video, and throw away what is of another."""
        file = self._folder / KEY
        self._known = file.is_file() and file.read_text(encoding="utf-8") == self._key
        if not self._known:
            for part in self._folder.iterdir():
                part.unlink()
            file.write_text(self._key, encoding="utf-8")

    def path(self, number: int) -> Path:
        """File of one segment."""
        return self._folder / f"{number:05d}.mp4"

    @property
    def thumbnail(self) -> Path:
        """File of the picture that stands for the video."""
        return self._folder / "thumbnail.png"

    def done(self, number: int) -> bool:
        """Whether a segment was finished before."""
        return self._known and self.path(number).is_file()

    def remove(self) -> None:
        """Throw everything away."""
        shutil.rmtree(self._folder)


def join(parts: list[Path], frames: list[int], fps: int, out: Path) -> None:
    """Put segments together without encoding anew; the file appears when it is complete.

    Args:
        parts: files, at least one, all of one size and rate.
        frames: number of frames of each.
        fps: frames per second.
        out: file to write.

    Raises:
        OSError: it cannot be written.
    """
    draft = out.with_name(out.name + ".part")
    try:
        with av.open(str(draft), "w", format="mp4", options=OPTIONS_OF_CONTAINER) as container:
            stream = None
            first = 0
            for part, count in zip(parts, frames, strict=True):
                with av.open(str(part)) as source:
                    video = source.streams.video[0]
                    if stream is None:
                        stream = container.add_stream_from_template(video)
                    shift = round(first / fps / video.time_base)
                    for packet in source.demux(video):
                        if packet.size == 0:  # the demuxer's last word
                            continue
                        packet.pts += shift
                        packet.dts += shift
                        packet.stream = stream
                        container.mux(packet)
                first += count
        draft.replace(out)
    finally:
        draft.unlink(missing_ok=True)
