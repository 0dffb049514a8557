"""Progress of long calls: a bar by tqdm where it is installed, else lines on stderr."""

from __future__ import annotations

import sys
import threading
import time
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._types import ProgressArgument, Reporter

_enabled = True
_LINE_SECONDS = 10.0


def set_progress(enabled: bool) -> None:
    """Sets whether calls with ``progress=None`` show their progress. The default is True."""
    global _enabled
    _enabled = bool(enabled)


class _Bar:
    """Draws one stage after the other with tqdm."""

    def __init__(self, tqdm: Any) -> None:
        self._tqdm = tqdm
        self._bar: Any = None
        self._name = ""

    def __call__(self, name: str, detail: str, done: int, total: int, elapsed: float) -> None:
        if name == "" or (self._bar is not None and name != self._name):
            self.close()
        if name == "":
            return
        if self._bar is None:
            self._bar = self._tqdm(total=total or None, desc=name, leave=False)
            self._name = name
        self._bar.set_postfix_str(detail, refresh=False)
        self._bar.update(done - self._bar.n)
        self._bar.refresh()

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()
            self._bar = None


class _Lines:
    """Prints a line every ten seconds."""

    def __init__(self) -> None:
        self._last = time.monotonic()

    def __call__(self, name: str, detail: str, done: int, total: int, elapsed: float) -> None:
        if name == "" or time.monotonic() - self._last < _LINE_SECONDS:
            return
        self._last = time.monotonic()
        count = f" {done}/{total}" if total else ""
        print(f"{name}:{count} {detail} {elapsed:.0f} s so far", file=sys.stderr, flush=True)


def reporter(progress: ProgressArgument) -> Reporter | None:
    """Returns the function that the compiled module reports to, or None.

    ``progress`` is True, False, None (as set_progress states), or a function
    ``f(name, detail, done, total, elapsed)``; a name of "" ends a stage.
    """
    if callable(progress):
        return progress
    if progress is None:
        progress = _enabled
    if not progress:
        return None
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return _Lines()
    notebook = "ipykernel" in sys.modules
    if not notebook and not sys.stderr.isatty():
        return _Lines()
    if threading.current_thread() is not threading.main_thread():
        return _Lines()
    return _Bar(tqdm)
