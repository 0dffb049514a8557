"""Conversion of arguments to arrays, with errors that name them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


def array(name: str, value: ArrayLike, shape: tuple[int | None, ...],
          dtype: type[np.generic]) -> NDArray[Any]:
    """Returns `value` as a C-contiguous array.

    Args:
        name (str): for errors.
        value: anything that numpy takes.
        shape (tuple): of ints; None stands for any length.
        dtype: of the result.

    Raises:
        Error: for another shape, something that is not an array of real numbers, or NaN.
    """
    if isinstance(value, np.ndarray) and value.dtype == dtype and value.flags.c_contiguous:
        converted = value
    else:
        try:
            given = np.asarray(value)
            if given.dtype.kind not in "fiub":
                raise TypeError(f"its type is {given.dtype}")
            converted = np.ascontiguousarray(given, dtype=dtype)
            if given.dtype.kind in "iu" and np.any(converted != given):
                raise ValueError("a number is too large")
        except (TypeError, ValueError) as error:
            raise _core.Error(f"{name}: is not an array of real numbers ({error})") from None
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
        Error: for another shape, an index out of range, or a number that is not finite.
    """
    return _core.Mesh(array("vertices", vertices, (None, 3), np.float64),
                      array("triangles", triangles, (None, 3), np.int32))
