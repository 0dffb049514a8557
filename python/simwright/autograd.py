"""The differentiable renderer as a torch function: gradients reach vertices, colours and light."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np
import torch

from . import _arguments as checked
from . import _core
from .render import DifferentiableRenderer

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["render"]


def _array(tensor: torch.Tensor, dtype: type[np.floating[Any]]) -> NDArray[Any]:
    return np.ascontiguousarray(tensor.detach().cpu().numpy(), dtype=dtype)


class _Render(torch.autograd.Function):
    @staticmethod
    def forward(context: Any, renderer: Any, camera: _core.Camera, seed: int,
                vertices: torch.Tensor, colors: torch.Tensor | None,
                light: torch.Tensor | None) -> tuple[torch.Tensor, ...]:
        renderer.set_vertices(_array(vertices, np.float64))
        if colors is not None:
            renderer.set_colors(_array(colors, np.float64))
        if light is not None:
            renderer.set_light(_array(light, np.float64))
        images = renderer.render(camera, seed)
        context.renderer, context.camera, context.seed = renderer, camera, seed
        context.save_for_backward(vertices, colors, light)
        context.images = renderer._torch_images = getattr(renderer, "_torch_images", 0) + 1
        return tuple(torch.from_numpy(images[name]) for name in ("color", "mask", "depth"))

    @staticmethod
    def backward(context: Any, color: torch.Tensor | None, mask: torch.Tensor | None,
                 depth: torch.Tensor | None) -> tuple[torch.Tensor | None, ...]:
        vertices, colors, light = context.saved_tensors
        renderer = context.renderer
        if context.images != renderer._torch_images:  # another image was rendered since
            renderer.set_vertices(_array(vertices, np.float64))
            if colors is not None:
                renderer.set_colors(_array(colors, np.float64))
            if light is not None:
                renderer.set_light(_array(light, np.float64))
            renderer.render(context.camera, context.seed)
            renderer._torch_images += 1
            context.images = renderer._torch_images
        gradients = renderer.backward(*(None if gradient is None else _array(gradient, np.float32)
                                        for gradient in (color, mask, depth)))

        def like(name: str, tensor: torch.Tensor | None) -> torch.Tensor | None:
            if tensor is None or name not in gradients:
                return None
            return torch.from_numpy(gradients[name]).to(tensor)

        return (None, None, None, like("vertices", vertices), like("colors", colors),
                like("light", light))


def render(renderer: DifferentiableRenderer, camera: _core.Camera, vertices: torch.Tensor,
           colors: torch.Tensor | None = None, light: torch.Tensor | None = None,
           seed: int = 0) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
    """Renders an image with gradients.

    Args:
        renderer (DifferentiableRenderer): of the mesh; colours need a renderer made with colours.
        camera (Camera): where from.
        vertices (N, 3): tensor, m.
        colors (N, 3): tensor; None: as they are.
        light (9, 3): tensor; None: as it is.
        seed (int): of the samples in a pixel.

    Returns:
        (color, mask, depth): (H, W, 3), (H, W, 1), (H, W, 1) float32 tensors.

    Raises:
        Error: for tensors of another shape, or arrays that are not tensors.
    """
    for name, value in (("vertices", vertices), ("colors", colors), ("light", light)):
        if value is not None or name == "vertices":
            checked.instance(name, value, torch.Tensor, "give a torch.Tensor")
    checked.instance("renderer", renderer, DifferentiableRenderer,
                     "give a render.DifferentiableRenderer")
    if tuple(vertices.shape) != (len(renderer.welded), 3):
        raise _core.Error(f"vertices: have the shape {tuple(vertices.shape)} "
                          f"(give {(len(renderer.welded), 3)})")
    return cast("tuple[torch.Tensor, torch.Tensor, torch.Tensor]",
                _Render.apply(renderer, camera, checked.seeded(seed), vertices, colors, light))
