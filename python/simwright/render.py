"""Images of meshes, and the differentiable renderer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Iterable, cast

import numpy as np

from . import _arguments as checked
from . import _core
from ._arguments import array
from ._core import Camera, TexturedMesh

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ._types import FloatArray, Float32Array, Images

__all__ = ["Camera", "DifferentiableRenderer", "TexturedMesh", "camera", "orbit_camera", "render",
           "studio_light"]


def camera(width: int, height: int, fx: float, fy: float, cx: float, cy: float,
           pose: ArrayLike) -> _core.Camera:
    """Returns a pinhole camera that looks along +z, x right, y down (OpenCV).

    Args:
        width, height (int): pixels; pixel (i, j) has its centre at (i + 0.5, j + 0.5).
        fx, fy, cx, cy (float): focal lengths and principal point, pixels.
        pose (4, 4): world from camera, m.

    Returns:
        Camera: for ``render`` and ``DifferentiableRenderer``.

    Raises:
        Error: without pixels or focal length, or for a pose that is not finite.
    """
    return _core.Camera(
        checked.integer("width", width, 1), checked.integer("height", height, 1),
        checked.number("focal length fx", fx), checked.number("focal length fy", fy),
        checked.number("cx", cx), checked.number("cy", cy), array("pose", pose, (4, 4), np.float64))


def orbit_camera(target: ArrayLike, distance: float, elevation: float, azimuth: float,
                 vertical_fov: float, width: int, height: int) -> _core.Camera:
    """Returns a camera that looks at a point.

    Args:
        target (3): m, world.
        distance (float): m, > 0.
        elevation, azimuth (float): rad; above the horizontal plane, and from the world's +x axis.
        vertical_fov (float): rad.
        width, height (int): pixels.

    Returns:
        Camera: for ``render`` and ``DifferentiableRenderer``.

    Raises:
        Error: for an elevation of pi/2 and more, or sizes that are not positive.
    """
    return _core.orbit_camera(
        array("target", target, (3,), np.float64), checked.number("distance", distance),
        checked.number("elevation", elevation), checked.number("azimuth", azimuth),
        checked.number("vertical_fov", vertical_fov), checked.integer("width", width, 1),
        checked.integer("height", height, 1))


def render(meshes: TexturedMesh | _core.Mesh | Iterable[TexturedMesh | _core.Mesh],
           camera: _core.Camera, samples_per_side: int = 1, occlusion_rays: int = 0) -> Images:
    """Renders meshes in the world's frame.

    Args:
        meshes (TexturedMesh, Mesh, or a list of them): m.
        camera (Camera): where from.
        samples_per_side (int): n x n rays per pixel.
        occlusion_rays (int): rays of ambient occlusion per hit; 0: none.

    Returns:
        dict: ``color`` (H, W, 4) uint8 sRGB, ``depth`` (H, W) float32, m along the optical axis, 0
        where nothing is seen, ``normal`` (H, W, 3) float32, world, ``mask`` (H, W) float32,
        ``label`` (H, W) int32, the mesh's index or -1, and ``triangle`` (H, W) int32.

    Raises:
        Error: for a mesh without faces.
    """
    if isinstance(meshes, (_core.TexturedMesh, _core.Mesh)):
        meshes = [meshes]
    remedy = "give a Mesh, a TexturedMesh of geometry.read_mesh, or a list of them"
    textured = [TexturedMesh(mesh) if isinstance(mesh, _core.Mesh)
                else checked.instance("meshes", mesh, TexturedMesh, remedy)
                for mesh in checked.listed("meshes", meshes, remedy[len("give "):])]
    return cast("Images", _core.render(
        textured, _camera_of(camera), checked.integer("samples_per_side", samples_per_side, 1),
        checked.integer("occlusion_rays", occlusion_rays, 0)))


def _camera_of(value: _core.Camera) -> _core.Camera:
    """Returns a camera; raises Error for anything else."""
    return checked.instance("camera", value, _core.Camera,
                            "give one of render.camera or render.orbit_camera")


def studio_light(key: ArrayLike = (0.4, -0.5, 0.75)) -> FloatArray:
    """Returns a light: (9, 3) float64, real spherical harmonics up to degree 2, linear RGB.

    Args:
        key (3): the direction towards the key light, unit, world.

    Raises:
        Error: for a key without a direction.
    """
    direction = array("key", key, (3,), np.float32)
    if not direction.any():
        raise _core.Error("key: is 0, 0, 0, which is no direction (give a unit vector)")
    return _core.light(direction)


class DifferentiableRenderer:
    """Renders a mesh and backpropagates image gradients, visibility included.

    Made for thousands of steps: buffers are reused and the ray tree is refitted. One thread at a
    time. ``simwright.autograd`` wraps it for torch.

    Args:
        mesh (Mesh or TexturedMesh): N vertices; textures are given apart.
        colors (N, 3): float64 per vertex, in the caller's colour space; None: white.
        texture (H, W, 3): float32, with ``corner_uvs`` (3 M, 2) float32; None: none.
        lit (bool): shades by the light; else the colour is the albedo.
        smooth_normals, render_normals (bool): normals of vertices; fills ``normal``.
        samples_per_side (int): n x n rays per pixel.
        edge_samples (int): samples of silhouettes per image.

    Raises:
        Error: for an invalid mesh, or colours, texture and UVs that do not fit it.
    """

    def __init__(self, mesh: _core.Mesh | TexturedMesh, colors: ArrayLike | None = None,
                 texture: ArrayLike | None = None, corner_uvs: ArrayLike | None = None,
                 lit: bool = False, smooth_normals: bool = True, render_normals: bool = False,
                 samples_per_side: int = 2, edge_samples: int = 4000) -> None:
        def given(name: str, value: ArrayLike | None, shape: tuple[int | None, ...],
                  dtype: type[np.floating[Any]]) -> NDArray[Any] | None:
            return None if value is None else array(name, value, shape, dtype)

        shape = checked.surface("mesh", mesh)
        self._renderer = _core.DifferentiableRenderer(
            shape, given("colors", colors, (len(shape.vertices), 3), np.float64),
            given("texture", texture, (None, None, 3), np.float32),
            given("corner_uvs", corner_uvs, (3 * len(shape.triangles), 2), np.float32), bool(lit),
            bool(smooth_normals), bool(render_normals),
            checked.integer("samples_per_side", samples_per_side, 1),
            checked.integer("edge_samples", edge_samples, 0))

    def set_vertices(self, vertices: ArrayLike) -> None:
        """Sets the vertices (N, 3), m, that the next image uses."""
        self._renderer.set_vertices(array("vertices", vertices, (None, 3), np.float64))

    def set_colors(self, colors: ArrayLike) -> None:
        """Sets the vertex colours (N, 3)."""
        self._renderer.set_colors(array("colors", colors, (None, 3), np.float64))

    def set_texture(self, texture: ArrayLike) -> None:
        """Sets the texture (H, W, 3)."""
        self._renderer.set_texture(array("texture", texture, (None, None, 3), np.float32))

    def set_light(self, radiance: ArrayLike) -> None:
        """Sets the light (9, 3), as ``studio_light`` returns it."""
        self._renderer.set_light(array("radiance", radiance, (9, 3), np.float64))

    def render(self, camera: _core.Camera, seed: int = 0) -> dict[str, Float32Array]:
        """Renders an image: means over each pixel, premultiplied by coverage.

        Returns:
            dict: ``color`` (H, W, 3), ``mask`` (H, W, 1), ``depth`` (H, W, 1), m, and ``normal``
            (H, W, 3) if it was asked for; float32.
        """
        return self._renderer.render(_camera_of(camera), checked.seeded(seed))

    def backward(self, color: ArrayLike | None = None, mask: ArrayLike | None = None,
                 depth: ArrayLike | None = None,
                 normal: ArrayLike | None = None) -> dict[str, NDArray[Any]]:
        """Returns the gradients of L, given dL/d(image) of the last image's buffers.

        Returns:
            dict: ``vertices`` (N, 3) float64, ``colors`` (N, 3) float32 or ``texture`` (H, W, 3) if
            there are any, and ``light`` (9, 3).

        Raises:
            Error: before a first image, or for a gradient of another size.
        """
        given = {"color": color, "mask": mask, "depth": depth, "normal": normal}
        return self._renderer.backward(*(
            None if gradient is None else array(name, gradient, (None, None, None), np.float32)
            for name, gradient in given.items()))

    @property
    def welded(self) -> list[int]:
        """(N) for each vertex the first vertex at the same position: move those together."""
        return self._renderer.welded
