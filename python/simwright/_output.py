"""Output of data sets: beside its destination, then renamed; and the extras that formats need."""

from __future__ import annotations

import contextlib
import importlib
import os
import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Any, Iterator

from . import _arguments as checked
from . import _core

if TYPE_CHECKING:
    from . import _types
    from .demonstrations import Episode


def need(module: str, extra: str) -> Any:
    """Returns an optional module.

    Raises:
        Error: where it is missing, with the command that installs it.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        missing = getattr(error, "name", None) or module
        raise _core.Error(f"{extra}: the package {missing} is missing "
                          f"(in the source folder: pip install '.[{extra}]')") from None


@contextlib.contextmanager
def placed(path: _types.Path, replaces: bool) -> Iterator[Path]:
    """Yields a path beside `path`; renames it to `path` where no exception is raised.

    Args:
        path: of a file or folder.
        replaces (bool): a file that exists is replaced; otherwise what exists is an error.

    Raises:
        Error: where `path` exists and is not replaced, or cannot be written.
    """
    path = Path(checked.path("path", path))
    if path.is_dir() or (path.exists() and not replaces):
        raise _core.Error(f"{path}: exists (remove it, or give another path)")
    partial = path.with_name(f".{path.name}.{os.getpid()}.partial")
    try:
        path.absolute().parent.mkdir(parents=True, exist_ok=True)
        yield partial
        os.replace(partial, path)
    except OSError as error:
        raise _core.Error(f"{path}: cannot be written ({error.strerror or error})") from None
    finally:
        if partial.is_dir():
            shutil.rmtree(partial, ignore_errors=True)
        elif partial.exists():
            partial.unlink()


class Totals:
    """Counts what was written; `report()` is what the writers return."""

    def __init__(self, path: _types.Path) -> None:
        self._path = str(path)
        self.episodes = self.steps = self.successes = 0

    def add(self, episode: Episode) -> None:
        self.episodes += 1
        self.steps += len(episode)
        self.successes += int(episode.success)

    def report(self) -> _types.WrittenTotals:
        if self.episodes == 0:
            raise _core.Error(f"{self._path}: there is no episode to write (give at least one)")
        return {"path": self._path, "episodes": self.episodes, "steps": self.steps,
                "successes": self.successes}
