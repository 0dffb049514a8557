"""Cameras of worlds: where they are mounted, what they see, how their look is randomised.

    spec = simwright.cameras.camera("side", position=(0.5, 1.2, 0.6), target=(0.5, 0.0, 0.2))
    env = gymnasium.make("simwright/OpenDrawer-v0", cameras=["wrist", spec], look="wide")
"""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np

from . import _arguments as checked
from . import _core
from ._arguments import array
from ._core import CameraSpec, LookRanges

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._types import Cameras, FloatArray, ImageSize, Look

__all__ = ["CameraSpec", "LookRanges", "camera", "defaults", "look"]

KINDS = ("rgb", "depth", "segmentation", "normal")
_RANGES = frozenset(name for name in vars(LookRanges) if not name.startswith("_")) - {"wide"}


def defaults(width: int = 128, height: int = 128) -> dict[str, CameraSpec]:
    """Returns the cameras "front" (beside the robot), "wrist" (on the hand) and "shoulder" (above the
    robot's base, towards the side of furniture that faces it), by name.

    Args:
        width, height (int): pixels.

    Raises:
        Error: for sides that are not ints from 1 to 8192.
    """
    width = checked.integer("width", width, 1, checked.MOST_PIXELS)
    height = checked.integer("height", height, 1, checked.MOST_PIXELS)
    return {spec.name: spec for spec in _core.default_cameras(width, height)}


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
    name = checked.text("camera", name)
    if (pose is None) == (position is None or target is None):
        raise _core.Error(f"camera '{name}': needs a pose, or a position and a target")
    if pose is None:
        pose = _looking(name, {"position": position, "target": target, "up": up})
    if intrinsics is not None:
        intrinsics = [float(number) for number in array("intrinsics", intrinsics, (4,), np.float64)]
    own = f"camera '{name}': "  # an error names the camera
    return CameraSpec(name, checked.text(own + "mount", mount),
                      array(own + "pose", pose, (4, 4), np.float64),
                      checked.integer(own + "width", width, 1, checked.MOST_PIXELS),
                      checked.integer(own + "height", height, 1, checked.MOST_PIXELS),
                      checked.number(own + "vertical_fov", vertical_fov), intrinsics)


def _looking(name: str, given: dict[str, ArrayLike | None]) -> FloatArray:
    """Returns the pose (4, 4) of a camera at ``position`` that looks at ``target``."""
    vectors = {what: array(f"camera '{name}': {what}", cast("ArrayLike", value), (3,), np.float64)
               for what, value in given.items()}
    try:
        return _core.look_at(vectors["position"], vectors["target"], vectors["up"])
    except _core.Error:
        if np.linalg.norm(vectors["target"] - vectors["position"]) < 1e-9:
            raise _core.Error(f"camera '{name}': its target is its own position "
                              "(give another target)") from None
        raise _core.Error(f"camera '{name}': it looks along its up direction "
                          "(give another up, such as (1, 0, 0))") from None


def look(value: Look = None) -> LookRanges:
    """Returns ranges of a randomised look: of None (off), "wide", a dict, or LookRanges.

    Raises:
        Error: for another name, or a value outside its bounds.
    """
    ranges = _ranges(value)
    ranges.check()
    return ranges


def _ranges(value: Look) -> LookRanges:
    if value is None:
        return LookRanges()
    if isinstance(value, LookRanges):
        return value
    if isinstance(value, str) and value == "wide":
        return LookRanges.wide()
    if not isinstance(value, dict):
        raise _core.Error(f"look: is {checked.shown(value)} (give None, 'wide', a dict or LookRanges)")
    ranges = LookRanges()
    for name, number in value.items():
        if not isinstance(name, str) or name not in _RANGES:
            raise _core.Error(f"look: there is no '{name}' (docs/cameras.md lists the ranges)")
        try:
            setattr(ranges, name, number)
        except (TypeError, ValueError):
            raise _core.Error(f"look: {name} is {checked.shown(number)} (give a number, or two)") from None
    return ranges


def chosen(cameras: Cameras, size: ImageSize) -> list[CameraSpec]:
    """Returns the specs of names and specs; named ones get `size` pixels a side."""
    width, height = checked.pixels("image_size", size, square=True)
    known = defaults(width, height)
    specs = []
    if isinstance(cameras, (str, CameraSpec)):
        cameras = [cameras]
    for one in checked.listed("cameras", cameras, "names, or camera(...)"):
        if isinstance(one, CameraSpec):
            specs.append(one)
        elif isinstance(one, str) and one in known:
            specs.append(known[one])
        else:
            raise _core.Error(f"cameras: there is no {checked.shown(one)} (give {', '.join(known)}, or a "
                              "camera(...))")
    return specs
