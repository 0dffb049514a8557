"""Sizes, masses and contact parameters of household objects by category."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from . import _arguments as checked
from . import _core

if TYPE_CHECKING:
    from ._types import PhysicalParameters

__all__ = ["categories", "sample"]


def categories() -> list[str]:
    """Returns the names of the categories of the knowledge base."""
    return _core.categories()


def sample(category: str, seed: int = 1) -> PhysicalParameters:
    """Samples the physical parameters of an object of a category.

    Args:
        category (str): free text, such as "coffee mug"; WordNet is used where it is installed.
        seed (int): the same seed gives the same object.

    Returns:
        dict: ``category`` (the row used), ``resolution`` (how the name was resolved), ``material``,
        ``fill``, and ``length``, ``width``, ``height`` (m), ``mass`` (kg), ``density`` (kg/m^3),
        ``friction``, ``restitution``: each a dict of ``min``, ``max``, ``sample``, ``source``.

    Raises:
        Error: if no category is near, naming the nearest ones.
    """
    return cast("PhysicalParameters", _core.sample_parameters(
        checked.text("category", category), checked.seeded(seed)))
