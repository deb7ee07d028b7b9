"""Timeline under the dashboard: progress of the video and marks of past events."""

from collections.abc import Sequence

from hsr8.render.text import Image

Color = tuple[int, int, int]

HEIGHT = 0.1  # fraction of the image drawn into
MARK = 3  # width of an event [pixel]
AHEAD, DONE = (62, 65, 71), (138, 142, 150)
MARKS: dict[str, Color] = {  # colour by kind of event; later kinds cover earlier ones
    "via_point": (240, 180, 60),
    "goal": (76, 200, 110),
    "push": (230, 70, 130),
    "fault": (120, 170, 230),
    "lost": (150, 110, 220),
    "collision": (240, 120, 30),
    "fall": (230, 40, 40),
}


class Timeline:
    """Timeline of one video.

    Args:
        start, stop: simulated time of the first and the last image [s].
    """

    def __init__(self, start: float, stop: float) -> None:
        self._start, self._length = start, max(stop - start, 1e-9)

    def draw(self, image: Image, time: float, events: Sequence[tuple[float, str]]) -> None:
        """Draw over the lowest rows of `image` (height, width, 3).

        Args:
            image: image to draw into.
            time: simulated time [s].
            events: time [s] and kind of each event so far.
        """
        height, width, _ = image.shape
        strip = image[-max(2, round(HEIGHT * height)) :]
        strip[:] = AHEAD
        strip[:, : self._column(time, width)] = DONE
        for kind, color in MARKS.items():
            for when, of_kind in events:
                if of_kind == kind and when >= self._start:
                    column = self._column(when, width)
                    strip[:, max(0, column - MARK // 2) : column + MARK // 2 + 1] = color

    def _column(self, time: float, width: int) -> int:
        return round((time - self._start) / self._length * width)
