# SPDX-License-Identifier: GPL-3.0-or-later
"""Work on a thread of its own, with progress and cancelling. Nothing here or in the work may touch the host."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

#: ``progress(done, total)``, to be handed to the library; it answers ``False`` once the job is cancelled.
Progress = Callable[[int, int], bool]


class Job:
    """Runs ``work(progress)`` at once; ask :attr:`finished` from the host's own thread."""

    def __init__(self, name: str, work: Callable[[Progress], Any]) -> None:
        self.name = name
        self.share = 0.0
        self.result: Any = None
        self.error: BaseException | None = None
        self.started = time.monotonic()
        self._cancelled = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(work,), name=f"voxelastica {name}", daemon=True)
        self._thread.start()

    def _run(self, work: Callable[[Progress], Any]) -> None:
        try:
            self.result = work(self._progress)
        except BaseException as error:  # noqa: BLE001 - handed to whoever asks for the result
            self.error = error

    def _progress(self, done: int, total: int) -> bool:
        if total > 0:
            self.share = min(1.0, done / total)
        return not self._cancelled.is_set()

    def cancel(self) -> None:
        """Asks the work to stop; it does within a fraction of a second, or after the factorisation under way."""
        self._cancelled.set()

    @property
    def cancelled(self) -> bool:
        """Whether it was asked to stop."""
        return self._cancelled.is_set()

    @property
    def finished(self) -> bool:
        """Whether the work has ended, well or not."""
        return not self._thread.is_alive()

    @property
    def seconds(self) -> float:
        """Time since the start, s."""
        return time.monotonic() - self.started

    def wait(self, timeout: float | None = None) -> bool:
        """Waits for the end; whether it came."""
        self._thread.join(timeout)
        return self.finished
