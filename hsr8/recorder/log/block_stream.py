"""Rerun recording whose channels are sent together."""

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import rerun as rr
import rerun.blueprint as rrb

from hsr8.recorder.log.channel import Channel

APPLICATION = "hsr8"
ABANDONED: list["BlockStream"] = []  # references, because Rerun closes unreferenced streams


class BlockStream(rr.RecordingStream):  # type: ignore[misc]  # Rerun is not typed
    """Recording that sends the rows of its channels on `send`.

    Args:
        recording_id: of the recording.
    """

    def __init__(self, recording_id: str) -> None:
        super().__init__(APPLICATION, recording_id=recording_id)
        self._channels: list[Channel] = []

    def begin(self, sinks: Sequence[rr.FileSink | rr.GrpcSink], arrangement: rrb.Blueprint) -> None:
        """Send everything to `sinks` from now on, the viewer's `arrangement` first.

        The arrangement takes the detour of a file: `set_sinks` and `send_blueprint` pack it with a
        stream that references itself, whose two threads and two megabytes are never freed.

        Raises:
            OSError, RuntimeError: a file cannot be written.
        """
        self.set_sinks(*sinks)
        with TemporaryDirectory() as folder:
            file = Path(folder, "arrangement.rbl")
            arrangement.save(APPLICATION, file)
            self.log_file_from_path(file)

    def add_channel(self, channel: Channel) -> None:
        """Send the rows of `channel` with every `send`."""
        self._channels.append(channel)

    def send(self) -> None:
        """Send the rows of all channels."""
        for channel in self._channels:
            channel.send(self)

    def abandon(self) -> None:
        """Give up the recording without closing it.

        Its writer thread has ended, and closing would wait for it forever.
        """
        ABANDONED.append(self)
        rr.unregister_shutdown()
