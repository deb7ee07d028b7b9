"""Rerun recording whose channels are sent together."""

from collections.abc import Sequence

import rerun as rr
import rerun.blueprint as rrb
import rerun_bindings

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

        Rerun's `set_sinks` packs the arrangement with a stream that references itself, whose two
        threads and one megabyte are never freed.

        Raises:
            RuntimeError: a file cannot be written.
        """
        packing = rr.RecordingStream._from_native(
            rerun_bindings.new_blueprint(
                application_id=APPLICATION,
                make_default=False,
                make_thread_default=False,
                default_enabled=True,
            )
        )
        packing.set_time("blueprint", sequence=0)
        arrangement._log_to_stream(packing)
        packed = packing.memory_recording().storage
        try:
            rerun_bindings.set_sinks(
                list(sinks), default_blueprint=packed, recording=self.to_native()
            )
        finally:
            packing.disconnect()

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
