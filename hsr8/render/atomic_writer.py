"""Files of images that appear when they are complete; an error leaves no file."""

import os
from abc import ABC, abstractmethod
from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.uint8]


class AtomicWriter(ABC):
    """Writer of a file, used by ``with``.

    Args:
        path: of the file; a draft next to it until it is complete.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._draft = path.with_name(f"{path.name}.{os.getpid()}.part")

    @abstractmethod
    def add(self, image: Image) -> None:
        """Append one image (height, width, 3)."""

    @abstractmethod
    def _finish(self, *, keep: bool) -> None:
        """Close the draft, after writing the rest of it if `keep`."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        try:
            self._finish(keep=error is None)
            if error is None:
                self._draft.replace(self._path)
        finally:
            self._draft.unlink(missing_ok=True)
