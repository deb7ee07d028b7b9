"""Standard output that takes any text, and whose errors are known for its own."""

import io
import os
from typing import Any, TextIO


class OutputFailed(OSError):
    """Standard output takes no more, for example because the disk under it is full."""


def prepared(stream: TextIO | None) -> TextIO:
    """What to write to in place of `stream`, None where it is closed from the beginning."""
    if stream is None:
        return nowhere()
    if not isinstance(stream, io.TextIOWrapper):
        return stream
    utf = stream.encoding.lower().replace("-", "") == "utf8"
    # Text is any text, and names of files are any bytes.
    if stream.errors == "strict" or (stream.errors == "surrogateescape" and not utf):
        stream.reconfigure(errors="backslashreplace")
    unbuffered = isinstance(stream.buffer, io.FileIO)  # python -u
    if type(getattr(stream.buffer, "raw", stream.buffer)) is not io.FileIO:
        return stream
    stream.flush()
    file = _Told(stream.fileno(), "wb", closefd=False)
    return io.TextIOWrapper(
        file if unbuffered else io.BufferedWriter(file),
        encoding=stream.encoding,
        errors=stream.errors,
        line_buffering=stream.line_buffering,
        write_through=stream.write_through,
    )


def nowhere() -> TextIO:
    """What takes everything and keeps nothing."""
    return open(os.devnull, "w", encoding="utf-8")


class _Told(io.FileIO):
    """The file itself."""

    def write(self, content: Any) -> int | None:  # type: ignore[override]  # any buffer
        """Write; what cannot be written is an `OutputFailed`, but for a reader that has left."""
        try:
            return super().write(content)
        except BrokenPipeError:
            raise
        except OSError as error:
            raise OutputFailed(error.errno, error.strerror) from None
