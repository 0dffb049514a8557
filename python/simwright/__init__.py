"""Simwright: photos and meshes become assets, tasks, trained robot skills and scenes.

Everything is in SI units; the world is right-handed with z up; poses are (4, 4) matrices that take
coordinates of the object to the world. Functions that work for long take ``progress`` (True: a bar
on a terminal or in a notebook), release the GIL and stop on Ctrl-C with KeyboardInterrupt. What goes
wrong raises ``simwright.Error``, a sentence with what, where and what to do.
"""

import os as _os
import sys as _sys
from importlib import import_module as _import_module
from importlib.machinery import EXTENSION_SUFFIXES as _SUFFIXES
from pathlib import Path as _Path
from typing import TYPE_CHECKING as _TYPE_CHECKING

_FOLDER = _Path(__file__).absolute().parent
# The weights lie beside the module as pip installs it, or in /usr/share as Debian's package does. The
# variable wins, as for the command.
for _models in (_FOLDER / "models", _FOLDER.parents[3] / "share" / "simwright" / "models"):
    if "SIMWRIGHT_MODELS" not in _os.environ and _models.is_dir():
        _os.environ["SIMWRIGHT_MODELS"] = str(_models)

try:
    from . import _core
except ImportError as error:
    _built_for = sorted(path.name for path in _FOLDER.glob("_core*.so"))
    if not _built_for:
        raise ImportError(
            f"simwright: the compiled module is missing in {_FOLDER} (install the package: pip install .)"
        ) from error
    if not any(name == "_core" + suffix for name in _built_for for suffix in _SUFFIXES):
        _version = ".".join(map(str, _sys.version_info[:2]))
        raise ImportError(
            f"simwright: {_built_for[0]} is for another Python than this one, {_version} "
            "(install the package with this Python: pip install .)"
        ) from error
    raise

from ._core import Error, Finding, Mesh, TexturedMesh, threads  # noqa: E402

Error.__module__ = __name__
__version__ = _core.__version__

from . import assets, cameras, geometry, physics, render, rewards, scenes, skills, tasks  # noqa: E402
from ._arguments import integer as _integer, mesh  # noqa: E402
from ._progress import set_progress  # noqa: E402


def set_threads(count: int) -> None:
    """Sets the number of threads for long work.

    Args:
        count (int): of threads; 0: all that this process may use.

    Raises:
        Error: for another type, or a negative number.
    """
    _core.set_threads(_integer("count", count, 0))


try:
    import gymnasium as _gymnasium
except ImportError:
    _gymnasium = None  # type: ignore[assignment]
if _gymnasium is not None:
    from .envs import register_envs as _register_envs

    _register_envs()

if _TYPE_CHECKING:
    from . import autograd as autograd
    from . import demonstrations as demonstrations
    from . import envs as envs
    from . import sb3 as sb3
else:
    def __getattr__(name: str) -> object:
        """Imports a module that needs torch, Gymnasium or Stable-Baselines3 at its first use."""
        if name not in ("autograd", "demonstrations", "envs", "sb3"):
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return _import_module(f"{__name__}.{name}")

__all__ = [
    "Error", "Finding", "Mesh", "TexturedMesh", "assets", "cameras", "geometry", "mesh", "physics", "render",
    "rewards", "scenes", "set_progress", "set_threads", "skills", "tasks", "threads",
]
