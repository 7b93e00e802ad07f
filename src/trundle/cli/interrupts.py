"""Remember that somebody asked to stop: an interrupt can be lost where it is raised.

Python raises it wherever the main thread stands. Within a callback from a library written in C, or
a finaliser, it is printed and forgotten, and a run would go on as if nobody had asked. So it is
remembered, and raised again at the next word of progress.
"""

from __future__ import annotations

import signal
import threading

from trundle._progress import Tell

__all__ = ["interruptible", "listen"]

_asked = threading.Event()


def listen() -> None:
    """Take Ctrl-C and termination alike, and remember them.

    What was started with Ctrl-C ignored, as a shell starts what runs in the background, goes on
    ignoring it.
    """
    _asked.clear()
    for number in (signal.SIGINT, signal.SIGTERM):
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _interrupt)


def interruptible(tell: Tell) -> Tell:
    """Return what tells the same, and stops where somebody asked to."""

    def telling(what: str, share: float) -> None:
        """Tell it, unless a stop was asked for."""
        if _asked.is_set():
            raise KeyboardInterrupt
        tell(what, share)

    return telling


def _interrupt(number: int, frame: object) -> None:
    """Raise it, and remember."""
    del number, frame
    _asked.set()
    raise KeyboardInterrupt
