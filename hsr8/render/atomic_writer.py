"""Files of pictures that are kept when everything went well, and leave nothing otherwise."""

from abc import ABC, abstractmethod
from types import TracebackType
from typing import Self


class AtomicWriter(ABC):
    """A writer used by ``with``: an error inside takes back what it has written."""

    @abstractmethod
    def close(self, *, keep: bool = True) -> None:
        """Finish the file, or remove it."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close(keep=error is None)
