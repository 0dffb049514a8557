"""Checks and conversions of arguments, with errors that name them."""

from __future__ import annotations

import math
import operator
import os
from typing import TYPE_CHECKING, Any, Iterable, Mapping

import numpy as np

from . import _core

if TYPE_CHECKING:
    from typing import TypeVar

    from numpy.typing import ArrayLike, NDArray

    from ._types import Names, Path, Paths, Range

    Kind = TypeVar("Kind")

_LARGEST_INT = 2**31 - 1
_LARGEST_SEED = 2**64 - 1
MOST_PIXELS = 8192  # of a camera's side, as in render/camera_spec.cpp


def shown(value: object) -> str:
    """Returns a value as an error states it: one short line."""
    words = " ".join(repr(value).split())
    return words if len(words) <= 60 else words[:57] + "..."


def integer(name: str, value: Any, low: int = -_LARGEST_INT, high: int = _LARGEST_INT) -> int:
    """Returns `value` as an int; a float counts if it is whole.

    Args:
        name (str): for errors.
        value: what a caller gave.
        low, high (int): the range, ends included.

    Raises:
        Error: for another type, a boolean, or a number outside the range.
    """
    whole: int | None = None
    if not isinstance(value, (bool, np.bool_)):
        try:
            if isinstance(value, (float, np.floating)):
                whole = int(value) if float(value).is_integer() else None
            else:
                whole = operator.index(value)
        except (TypeError, ValueError, RuntimeError):
            pass
    if whole is None or not low <= whole <= high:
        if high == _LARGEST_INT:
            wanted = "an int" if low == -_LARGEST_INT else f"an int of at least {low}"
        else:
            wanted = f"an int from {low} to {high}"
        raise _core.Error(f"{name}: is {shown(value)} (give {wanted})")
    return whole


def seeded(value: Any, name: str = "seed") -> int:
    """Returns a seed, 0 to 2**64 - 1; raises Error as ``integer`` does."""
    try:
        return integer(name, value, 0, _LARGEST_SEED)
    except _core.Error:
        raise _core.Error(f"{name}: is {shown(value)} (give an int from 0 to 2**64 - 1)") from None


def number(name: str, value: Any, low: float | None = None) -> float:
    """Returns `value` as a finite float.

    Args:
        name (str): for errors.
        value: what a caller gave: a number of Python, numpy or torch.
        low (float): the least number that is allowed; None: any.

    Raises:
        Error: for another type, text, a boolean, or a number outside the range.
    """
    converted = math.nan
    if not isinstance(value, (bool, np.bool_, str, bytes, bytearray)):
        try:
            converted = float(value)
        except (TypeError, ValueError, OverflowError, RuntimeError):
            pass
    if not math.isfinite(converted) or (low is not None and converted < low):
        wanted = "a finite number" if low is None else f"a finite number of at least {low:g}"
        raise _core.Error(f"{name}: is {shown(value)} (give {wanted})")
    return converted


def optional_range(name: str, value: Any) -> Range | None:
    """Returns two numbers, low and high, or None; raises Error for anything else."""
    if value is None:
        return None
    try:
        low, high = (float(end) for end in value)
    except (TypeError, ValueError):
        raise _core.Error(f"{name}: is {shown(value)} (give two numbers, low and high)") from None
    return low, high


def pixels(name: str, value: Any, square: bool = False) -> tuple[int, int]:
    """Returns the width and height of an image.

    Args:
        name (str): for errors.
        value: a width and a height, or an int for both if `square`.
        square (bool): one int is enough.

    Raises:
        Error: for another number of entries, or sides that are not ints from 1 to 8192.
    """
    if square and value is not None and not isinstance(value, Iterable):
        side = integer(name, value, 1, MOST_PIXELS)
        return side, side
    try:
        width, height = value
    except (TypeError, ValueError):
        wanted = "an int, or a width and a height" if square else "a width and a height"
        raise _core.Error(f"{name}: is {shown(value)} (give {wanted}, pixels)") from None
    return (integer(f"{name}: width", width, 1, MOST_PIXELS),
            integer(f"{name}: height", height, 1, MOST_PIXELS))


def text(name: str, value: Any) -> str:
    """Returns a str that UTF-8 can hold; raises Error for anything else."""
    if not isinstance(value, str):
        raise _core.Error(f"{name}: is {shown(value)}, of the type {type(value).__name__} "
                          "(give a str)")
    try:
        value.encode("utf-8")
    except UnicodeEncodeError:
        raise _core.Error(f"{name}: {shown(value)} is not valid UTF-8 (give other text)") from None
    return value


def texts(name: str, value: Names) -> list[str]:
    """Returns a list of str, of one or several; raises Error for anything else."""
    if isinstance(value, str):
        value = [value]
    return [text(name, one) for one in listed(name, value, "a str, or a list of them")]


def listed(name: str, value: Any, wanted: str) -> list[Any]:
    """Returns a list of what an iterable holds; raises Error, which says `wanted`, for others."""
    try:
        if isinstance(value, (str, bytes)):
            raise TypeError("text is one value, not several")
        return list(value)
    except TypeError:
        raise _core.Error(f"{name}: is {shown(value)} (give {wanted})") from None


def path(name: str, value: Path, required: bool = True) -> str:
    """Returns a path as a str.

    Args:
        name (str): for errors.
        value (path): str or path.
        required (bool): the empty path is an error.

    Raises:
        Error: for another type, an empty path, a NUL, or a name that is not UTF-8.
    """
    try:
        found = os.fsdecode(value)
    except TypeError:
        raise _core.Error(f"{name}: is {shown(value)}, of the type {type(value).__name__} "
                          "(give a path as str or pathlib.Path)") from None
    if required and not found:
        raise _core.Error(f"{name}: the path is empty (give the path of a file or folder)")
    if "\0" in found:
        raise _core.Error(f"{name}: {shown(found)} contains a NUL character (give another path)")
    try:
        found.encode("utf-8")
    except UnicodeEncodeError:
        raise _core.Error(f"{name}: {shown(found)} is not valid UTF-8 (rename the file)") from None
    return found


def paths(name: str, value: Paths) -> list[str]:
    """Returns a list of paths, of one or several; raises Error for anything else."""
    if isinstance(value, (str, bytes, os.PathLike)):
        value = [value]
    return [path(name, one) for one in listed(name, value, "a path, or a list of them")]


def instance(name: str, value: Any, kind: type[Kind], remedy: str) -> Kind:
    """Returns `value` if it is of a class; raises Error, which says `remedy`, for others."""
    if not isinstance(value, kind):
        raise _core.Error(f"{name}: is {shown(value)}, of the type {type(value).__name__} "
                          f"({remedy})")
    return value


def mapping(name: str, value: Mapping[str, Any] | None) -> Mapping[str, Any]:
    """Returns a dict, empty for None; raises Error for anything else."""
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise _core.Error(f"{name}: is {shown(value)} (give a dict)")
    return value


def surface(name: str, value: _core.Mesh | _core.TexturedMesh) -> _core.Mesh:
    """Returns the geometry of a mesh with or without appearance; raises Error for others."""
    if isinstance(value, _core.TexturedMesh):
        return value.mesh
    return instance(name, value, _core.Mesh,
                    "give a Mesh, of simwright.mesh or geometry.read_mesh")


def array(name: str, value: ArrayLike, shape: tuple[int | None, ...],
          dtype: type[np.generic]) -> NDArray[Any]:
    """Returns `value` as a C-contiguous array.

    Args:
        name (str): for errors.
        value: anything that numpy takes.
        shape (tuple): of ints; None stands for any length.
        dtype: of the result.

    Raises:
        Error: for another shape, something that is not an array of real numbers, or NaN; for ints
            also of booleans and fractions.
    """
    if isinstance(value, np.ndarray) and value.dtype == dtype and value.flags.c_contiguous:
        converted = value
    else:
        whole = np.issubdtype(dtype, np.integer)
        try:
            given = np.asarray(value)
            if given.dtype.kind not in ("fiu" if whole else "fiub"):
                raise TypeError(f"its type is {given.dtype}")
            with np.errstate(invalid="ignore"):
                converted = np.ascontiguousarray(given, dtype=dtype)
            if given.dtype.kind in "iu" and np.any(converted != given):
                raise ValueError("a number is too large")
            if whole and np.any(converted != given):
                raise ValueError("a number has a fraction, or more than 32 bits")
        except (TypeError, ValueError, RuntimeError) as error:
            content = "ints" if whole else "real numbers"
            raise _core.Error(f"{name}: is not an array of {content} ({error})") from None
    if converted.ndim != len(shape) or any(
            side is not None and side != given
            for side, given in zip(shape, converted.shape)):
        wanted = ", ".join("any" if side is None else str(side) for side in shape)
        raise _core.Error(f"{name}: has the shape {converted.shape} (give ({wanted}))")
    if converted.dtype.kind == "f" and not np.isfinite(converted).all():
        raise _core.Error(f"{name}: has numbers that are not finite")
    return converted


def mesh(vertices: ArrayLike, triangles: ArrayLike) -> _core.Mesh:
    """Makes a mesh of arrays or lists.

    Args:
        vertices (N, 3): m.
        triangles (M, 3): indices of vertices, counter-clockwise seen from outside.

    Returns:
        Mesh: a copy of the arrays.

    Raises:
        Error: for another shape, an index that is out of range or not an int, or a number that is
            not finite.
    """
    return _core.Mesh(array("vertices", vertices, (None, 3), np.float64),
                      array("triangles", triangles, (None, 3), np.int32))
