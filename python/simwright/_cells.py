"""The task files of the shipped cells and long tasks, made once and kept in a cache folder."""

from __future__ import annotations

import contextlib
import fcntl
import os
from pathlib import Path
from typing import TYPE_CHECKING, Iterator

from . import _arguments as checked
from . import _core

if TYPE_CHECKING:
    from ._types import Reporter, Split

# Training uses instances from the first seed on, evaluation from the second.
SPLIT_SEEDS = {"train": 1, "unseen": 301}


def cache_folder() -> Path:
    """Returns $SIMWRIGHT_CACHE, else the user's cache folder for this version."""
    told = os.environ.get("SIMWRIGHT_CACHE")
    if told:
        return Path(told)
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / "simwright" / _core.__version__


@contextlib.contextmanager
def _locked(folder: Path) -> Iterator[None]:
    """Waits for other processes that make the same folder."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    with open(folder.with_name(folder.name + ".lock"), "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def example_photo() -> Path:
    """Returns the photo of the cell pick_up_photo."""
    return Path(__file__).absolute().parent / "data" / "coffee.png"


def cell_tasks(cell: str, split: Split = "train", instances: int | None = None,
               report: Reporter | None = None) -> Path:
    """Returns the tasks.json of a cell, made at the first call (seconds to a minute)."""
    known = {entry["name"]: entry for entry in _core.cells()}
    if not isinstance(cell, str) or cell not in known:
        raise _core.Error(f"cell: there is no {checked.shown(cell)} (it is one of {', '.join(known)})")
    if not isinstance(split, str) or split not in SPLIT_SEEDS:
        raise _core.Error(f"split: is {checked.shown(split)} (give train or unseen)")
    if instances is None:
        instances = known[cell]["instances"] if split == "train" else 8
    instances = checked.integer("instances", instances, 1)
    folder = cache_folder() / "cells" / f"{cell}_{split}_{instances}"
    with _locked(folder):
        return _core.make_cell_tasks(cell, SPLIT_SEEDS[split], instances, str(example_photo()),
                                     str(folder), report)


def long_task(name: str, report: Reporter | None = None) -> Path:
    """Returns the tasks.json of a shipped task of several subtasks."""
    known = [entry["name"] for entry in _core.long_tasks()]
    if not isinstance(name, str) or name not in known:
        raise _core.Error(f"task: there is no {checked.shown(name)} (it is one of {', '.join(known)})")
    folder = cache_folder() / "long_tasks" / name
    with _locked(folder):
        return _core.make_long_task(name, str(folder), report)
