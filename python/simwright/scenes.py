"""Cluttered scenes: generated, sampled from diffusion models, made feasible, steered, exported."""

from __future__ import annotations

from typing import TYPE_CHECKING, Iterable, cast

from . import _arguments as checked
from . import _core
from ._core import AssetSet, SceneObject
from ._progress import reporter

if TYPE_CHECKING:
    from ._types import (FeasibleScene, Names, Path, Paths, ProgressArgument, Report,
                         WorldFormat)

__all__ = ["AssetSet", "SceneObject", "complete", "evaluate", "export", "generate", "make_feasible",
           "read", "rearrange", "sample", "total_penetration", "types"]


def types() -> list[str]:
    """Returns the names of the scene types."""
    return _core.scene_types()


def read(path: Path, first: int = 0, count: int = -1) -> list[list[SceneObject]]:
    """Reads scenes of a dataset.

    Args:
        path (path): a folder of shards, or one shard.
        first (int): index of the first scene.
        count (int): how many at most; -1: all.

    Returns:
        list of list of SceneObject: the objects of each scene.

    Raises:
        Error: if there is no shard, or one is damaged.
    """
    return _core.read_scenes(checked.path("path", path), checked.integer("first", first, 0),
                             checked.integer("count", count, -1))


def make_feasible(objects: Iterable[SceneObject], assets: AssetSet, min_objects: int = 3,
                  lowering: float = 0.0, progress: ProgressArgument = None) -> FeasibleScene:
    """Resolves the penetrations of a scene and lets it settle; drops what falls.

    Args:
        objects (list of SceneObject): the scene.
        assets (AssetSet): of its categories.
        min_objects (int): fewest free objects of a valid scene.
        lowering (float): m, by which a floating object is lowered onto its support at most.
        progress: see ``simwright``.

    Returns:
        dict: ``valid``, ``objects`` (at rest), ``indices`` (of these in the input), ``dropped``,
        ``moved`` (m, mean), ``penetration`` (m, deepest), ``drift`` (m).

    Raises:
        Error: for a category without an asset.
    """
    return cast("FeasibleScene", _core.make_feasible(
        _objects(objects), _asset_set(assets), checked.integer("min_objects", min_objects, 0),
        checked.number("lowering", lowering, 0.0), reporter(progress)))


def total_penetration(objects: Iterable[SceneObject], assets: AssetSet) -> float:
    """Returns the sum of the depths (m) of all interpenetrating pairs of a scene's objects."""
    return _core.total_penetration(_objects(objects), _asset_set(assets))


def _objects(objects: Iterable[SceneObject]) -> list[SceneObject]:
    remedy = "give a list of SceneObject, one scene of scenes.read"
    return [checked.instance("objects", one, SceneObject, remedy)
            for one in checked.listed("objects", objects, remedy[len("give "):])]


def _asset_set(assets: AssetSet) -> AssetSet:
    return checked.instance("assets", assets, AssetSet, "give one of AssetSet.read(folder)")


def generate(type: str, output: Path, count: int = 100, assets: Paths = (), seed: int = 1,
             raw: bool = False, progress: ProgressArgument = None) -> Report:
    """Samples scenes of a grammar, makes them feasible and writes a dataset.

    Args:
        type (str): one of ``types()``.
        output (path): the dataset's folder; existing shards of the same dataset are kept.
        count (int): number of scenes.
        assets (list of paths): folders that are searched for assets before the library.
        seed (int): of the dataset.
        raw (bool): keeps the grammar's scenes, without physics.
        progress: see ``simwright``.

    Returns:
        dict: the statistics of ``simwright scene generate --json``.

    Raises:
        Error: for an unknown type, or an output that contains other scenes.
    """
    return cast("Report", _core.generate_scenes(
        checked.text("type", type), checked.integer("count", count, 1),
        checked.path("output", output), checked.paths("assets", assets), checked.seeded(seed),
        bool(raw), reporter(progress)))


def sample(output: Path, weights: Path = "", type: str = "", count: int = 16, prompts: Names = (),
           steps: int = 0, guidance: float = 0.0, assets: Paths = (), seed: int = 1,
           raw: bool = False, force: bool = False, progress: ProgressArgument = None) -> Report:
    """Samples scenes from a diffusion model, makes them feasible and writes a dataset.

    Args:
        output (path): the dataset's folder.
        weights (path): a model of ``simwright scene train``; empty: the shipped one of ``type``, or
            with prompts the shipped one of all types.
        type (str): the scene type.
        count (int): number of scenes.
        prompts (str or list of str): scene i has prompt i % n; none: unprompted.
        steps (int): denoising steps; 0: all.
        guidance (float): weight of classifier-free guidance.
        assets (list of paths): folders that are searched for assets before the library.
        seed (int): of the samples.
        raw (bool): keeps the samples unchanged, without physics.
        force (bool): replaces an existing output.
        progress: see ``simwright``.

    Returns:
        dict: the report of ``simwright scene sample --json``.

    Raises:
        Error: for a file without weights, a prompt that cannot be read, or an existing output.
    """
    return cast("Report", _core.sample_scenes(
        checked.path("output", output), checked.path("weights", weights, required=False),
        checked.text("type", type), checked.integer("count", count, 1),
        checked.texts("prompts", prompts), checked.integer("steps", steps, 0),
        checked.number("guidance", guidance), checked.paths("assets", assets),
        checked.seeded(seed), bool(raw), bool(force), reporter(progress)))


def complete(source: Path, output: Path, count: int = -1, prompt: str = "", scenes: str = "",
             weights: Path = "", type: str = "", seed: int = 1, force: bool = False,
             progress: ProgressArgument = None) -> Report:
    """Adds objects to scenes, in which everything stays.

    Args:
        source (path): a dataset, a folder of ``export``, or a JSON file of poses.
        output (path): the dataset's folder.
        count (int): objects to add; -1: the model's choice.
        prompt (str): what to add, in words, instead of ``count``.
        scenes (str): of a dataset, such as "0,3-5"; empty: the first.
        weights, type, seed, force, progress: as for ``sample``.

    Returns:
        dict: the report of ``simwright scene complete --json``.

    Raises:
        Error: for a source, a prompt or a model that does not fit.
    """
    return cast("Report", _core.steer_scenes(
        checked.path("source", source), checked.path("output", output), False,
        checked.text("scenes", scenes), checked.integer("count", count, -1),
        checked.text("prompt", prompt), [], checked.path("weights", weights, required=False),
        checked.text("type", type), checked.seeded(seed), bool(force), reporter(progress)))


def rearrange(source: Path, output: Path, keep: Names = (), scenes: str = "",
              weights: Path = "", type: str = "", seed: int = 1, force: bool = False,
              progress: ProgressArgument = None) -> Report:
    """Finds new poses for the objects of scenes.

    Args:
        source (path): a dataset, a folder of ``export``, or a JSON file of poses.
        output (path): the dataset's folder.
        keep (str or list of str): names of the objects that stay.
        scenes, weights, type, seed, force, progress: as for ``complete``.

    Returns:
        dict: the report of ``simwright scene rearrange --json``.

    Raises:
        Error: for a source or a model that does not fit.
    """
    return cast("Report", _core.steer_scenes(
        checked.path("source", source), checked.path("output", output), True,
        checked.text("scenes", scenes), -1, "", checked.texts("keep", keep),
        checked.path("weights", weights, required=False), checked.text("type", type),
        checked.seeded(seed), bool(force), reporter(progress)))


def evaluate(type: str = "", data: Path = "", weights: Path = "", samples: Path = "",
             count: int = 1000, seed: int = 1, progress: ProgressArgument = None) -> Report:
    """Compares samples of a model with held-out scenes.

    Args:
        type (str): the scene type, with its shipped weights and grammar.
        data (path): a dataset of held-out scenes; empty: generated.
        weights (path): the model to sample from.
        samples (path): samples to use instead.
        count (int): most scenes per set.
        seed (int): of samples and generated scenes.
        progress: see ``simwright``.

    Returns:
        dict: the metrics of ``simwright scene evaluate --json``.

    Raises:
        Error: if there is nothing to evaluate, or a file is damaged.
    """
    return cast("Report", _core.evaluate_scenes(
        checked.text("type", type), checked.path("data", data, required=False),
        checked.path("weights", weights, required=False),
        checked.path("samples", samples, required=False), checked.integer("count", count, 1),
        checked.seeded(seed), reporter(progress)))


def export(dataset: Path, output: Path, scenes: str = "",
           formats: WorldFormat | Iterable[WorldFormat] = ("mjcf",), check: bool = False,
           force: bool = False, progress: ProgressArgument = None) -> Report:
    """Writes scenes as worlds for simulators.

    Args:
        dataset (path): a folder of shards, or one shard.
        output (path): one folder per scene, and the assets beside them.
        scenes (str): such as "0,3-5"; empty: all.
        formats (list of str): of urdf, sdf, mjcf, drake, usd.
        check (bool): checks each scene's stability in Bullet and MuJoCo.
        force (bool): replaces an existing output.
        progress: see ``simwright``.

    Returns:
        dict: the report of ``simwright scene export --json``.

    Raises:
        Error: for an unknown format or scene, or an existing output.
    """
    return cast("Report", _core.export_worlds(
        checked.path("dataset", dataset), checked.path("output", output),
        checked.text("scenes", scenes), set(checked.texts("formats", formats)), bool(check),
        bool(force), reporter(progress)))
