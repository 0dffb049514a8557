"""Assets: reading, importing, lifting from photos, generating and checking them."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from . import _arguments as checked
from . import _core
from ._core import ArticulatedAsset, Asset, Link
from ._progress import reporter

if TYPE_CHECKING:
    from ._types import (ImportOutcome, LibraryOutcome, LiftOutcome, LiftShape, Path, Paths,
                         ProgressArgument, Report, UpAxis)

__all__ = ["ArticulatedAsset", "Asset", "Link", "check", "import_assets", "library",
           "library_kinds", "lift", "read"]


def read(folder: Path) -> Asset | ArticulatedAsset:
    """Reads an asset folder.

    Args:
        folder (path): as ``lift``, ``import_assets`` and ``library`` write it.

    Returns:
        Asset or ArticulatedAsset: the second one where the asset has joints.

    Raises:
        Error: if asset.json is missing, malformed, or names a missing mesh.
    """
    return cast("Asset | ArticulatedAsset", _core.read_asset(checked.path("folder", folder)))


def import_assets(inputs: Paths, output: Path, category: str = "", up: UpAxis = "",
                  unit: float = 0.0, height: float = 0.0, seed: int = 1, check: bool = True,
                  force: bool = False, progress: ProgressArgument = None) -> list[ImportOutcome]:
    """Imports meshes, URDFs, ROS packages and catalogues as asset folders.

    Args:
        inputs (path or list of paths): files, or folders that are searched.
        output (path): each asset becomes output/NAME.
        category (str): for mass and friction; empty: from the file's name.
        up (str): "x", "y" or "z"; empty: stated by the file or found.
        unit (float): metres per file unit; 0: found.
        height (float): m, scales to this height; 0: does not scale.
        seed (int): of the sampled parameters.
        check (bool): checks each asset and refuses one that fails.
        force (bool): replaces existing folders.
        progress: see ``simwright``.

    Returns:
        list of dict: ``name``, ``folder`` (None if refused), ``refusal``, ``findings``, and
        ``grade`` where it was checked.

    Raises:
        Error: for an input that does not exist or holds nothing to import, or an existing output.
    """
    return _core.import_assets(
        checked.paths("inputs", inputs), checked.path("output", output),
        checked.text("category", category), checked.text("up", up),
        checked.number("unit", unit, 0.0), checked.number("height", height, 0.0),
        checked.seeded(seed), bool(check), bool(force), reporter(progress))


def lift(photo: Path, category: str, output: Path, mask: Path | None = None,
         shape: LiftShape = "auto", fast: bool = False, height: float = 0.0, seed: int = 1,
         force: bool = False, progress: ProgressArgument = None) -> LiftOutcome:
    """Reconstructs an asset folder from one photo.

    Args:
        photo (path): the picture of one object.
        category (str): what it shows, such as "mug".
        output (path): the asset folder to write.
        mask (path): a picture that is white where the object is; None: it is segmented.
        shape (str): "auto", "fitted" (an object of the library) or "free".
        fast (bool): a quick reconstruction of lower quality.
        height (float): m; 0: sampled from the category's range.
        seed (int): of sampled sizes and masses.
        force (bool): replaces an existing folder.
        progress: see ``simwright``.

    Returns:
        dict: ``folder``, ``silhouette_iou`` (agreement with the photo's outline), ``findings``.

    Raises:
        Error: if the photo cannot be read, no object stands out, or the output exists.
    """
    return cast("LiftOutcome", _core.lift(
        checked.path("photo", photo), checked.text("category", category),
        checked.path("output", output), None if mask is None else checked.path("mask", mask),
        checked.text("shape", shape), bool(fast), checked.number("height", height, 0.0),
        checked.seeded(seed), bool(force), reporter(progress)))


def library_kinds() -> dict[str, str]:
    """Returns the kinds of parametric assets: name to description (dict)."""
    return _core.library_kinds()


def library(kind: str, output: Path, count: int = 1, seed: int = 1, check: bool = True,
            force: bool = False, progress: ProgressArgument = None) -> list[LibraryOutcome]:
    """Makes parametric assets, articulated and rigid.

    Args:
        kind (str): one of ``library_kinds()``, or several separated by commas.
        output (path): each asset becomes output/KIND_SEED.
        count (int): assets per kind, with consecutive seeds.
        seed (int): of the first.
        check (bool): checks each asset and refuses one that fails.
        force (bool): replaces existing folders.
        progress: see ``simwright``.

    Returns:
        list of dict: ``name``, ``kind``, ``folder`` (None if refused), ``refusal``, ``findings``,
        and ``grade`` where it was checked.

    Raises:
        Error: for an unknown kind, a count below 1, or an existing output.
    """
    return _core.make_library(checked.text("kind", kind), checked.integer("count", count, 1),
                              checked.seeded(seed), checked.path("output", output), bool(check),
                              bool(force), reporter(progress))


def check(path: Path, progress: ProgressArgument = None) -> Report:
    """Checks an asset folder or a URDF: geometry, inertia, file readers, a drop test, joints.

    Args:
        path (path): an asset folder, or a URDF of any origin.
        progress: see ``simwright``.

    Returns:
        dict: ``passed``, ``grade``, and one result per property, as ``simwright check --json``.

    Raises:
        Error: if the path does not exist or cannot be read at all.
    """
    return cast("Report", _core.check(checked.path("path", path), reporter(progress)))
