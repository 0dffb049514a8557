"""Cameras of worlds: where they are mounted, what they see, how their look is randomised.

    spec = simwright.cameras.camera("side", position=(0.5, 1.2, 0.6), target=(0.5, 0.0, 0.2))
    env = gymnasium.make("simwright/OpenDrawer-v0", cameras=["wrist", spec], look="wide")
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from . import _core
from ._arguments import array
from ._core import CameraSpec, LookRanges

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._types import Cameras, ImageSize, Look

__all__ = ["CameraSpec", "LookRanges", "camera", "defaults", "look"]

KINDS = ("rgb", "depth", "segmentation", "normal")


def defaults(width: int = 128, height: int = 128) -> dict[str, CameraSpec]:
    """Returns the cameras "front" (beside the robot), "wrist" (on the hand) and "shoulder" (above the
    robot's base, towards the side of furniture that faces it), by name.

    Args:
        width, height (int): pixels.
    """
    return {spec.name: spec for spec in _core.default_cameras(int(width), int(height))}


def camera(name: str, pose: ArrayLike | None = None, position: ArrayLike | None = None,
           target: ArrayLike | None = None, up: ArrayLike = (0.0, 0.0, 1.0), mount: str = "world",
           width: int = 128, height: int = 128, vertical_fov: float = 0.8,
           intrinsics: ArrayLike | None = None) -> CameraSpec:
    """Describes a camera.

    Args:
        name (str): its key in observations.
        pose (4, 4): mount from camera, m; +z forward, x right, y down (OpenCV).
        position, target, up (3): instead of a pose, in the mount's frame, m.
        mount (str): "world", "robot" (its base), "wrist" (the frame between the fingertips) or a
            link of the robot.
        width, height (int): pixels.
        vertical_fov (float): rad.
        intrinsics (4): fx, fy, cx, cy in pixels, instead of the field of view.

    Returns:
        CameraSpec: for the ``cameras`` of environments.

    Raises:
        Error: for a pose that is not rigid, or sizes or angles out of range; names the camera.
    """
    if (pose is None) == (position is None or target is None):
        raise _core.Error(f"camera '{name}': needs a pose, or a position and a target")
    if pose is None:
        given = {"position": position, "target": target, "up": up}
        pose = _core.look_at(*(array(what, cast("ArrayLike", value), (3,), np.float64)
                               for what, value in given.items()))
    if intrinsics is not None:
        intrinsics = [float(number) for number in array("intrinsics", intrinsics, (4,), np.float64)]
    return CameraSpec(str(name), str(mount), array("pose", pose, (4, 4), np.float64), int(width),
                      int(height), float(vertical_fov), intrinsics)


def look(value: Look = None) -> LookRanges:
    """Returns ranges of a randomised look: of None (off), "wide", a dict, or LookRanges.

    Raises:
        Error: for another name.
    """
    if value is None:
        return LookRanges()
    if isinstance(value, LookRanges):
        return value
    if value == "wide":
        return LookRanges.wide()
    if not isinstance(value, dict):
        raise _core.Error(f"look: is {value!r} (give None, 'wide', a dict or LookRanges)")
    ranges = LookRanges()
    for name, number in value.items():
        if not hasattr(ranges, name):
            raise _core.Error(f"look: there is no '{name}' (docs/cameras.md lists the ranges)")
        try:
            setattr(ranges, name, number)
        except TypeError:
            raise _core.Error(f"look: {name} is {number!r} (give a number, or two)") from None
    return ranges


def chosen(cameras: Cameras, size: ImageSize) -> list[CameraSpec]:
    """Returns the specs of names and specs; named ones get `size` pixels a side."""
    sides: Any = (size, size) if np.isscalar(size) else size
    width, height = sides
    known = defaults(width, height)
    specs = []
    for one in [cameras] if isinstance(cameras, (str, CameraSpec)) else list(cameras):
        if isinstance(one, CameraSpec):
            specs.append(one)
        elif one in known:
            specs.append(known[one])
        else:
            raise _core.Error(f"cameras: there is no '{one}' (give {', '.join(known)}, or a "
                              "camera(...))")
    return specs
