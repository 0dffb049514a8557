"""Cluttered scenes: generated, sampled from diffusion models, made feasible, steered, exported."""

from __future__ import annotations

from os import PathLike, fspath
from typing import TYPE_CHECKING, Iterable, cast

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
    return _core.read_scenes(fspath(path), int(first), int(count))


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
        list(objects), assets, int(min_objects), float(lowering), reporter(progress)))


def total_penetration(objects: Iterable[SceneObject], assets: AssetSet) -> float:
    """Returns the sum of the depths (m) of all interpenetrating pairs of a scene's objects."""
    return _core.total_penetration(list(objects), assets)


def _paths(paths: Paths) -> list[str]:
    if isinstance(paths, (str, bytes, PathLike)):
        paths = [paths]
    return [fspath(path) for path in paths]


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
        type, int(count), fspath(output), _paths(assets), int(seed), bool(raw),
        reporter(progress)))


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
    prompts = [prompts] if isinstance(prompts, str) else list(prompts)
    return cast("Report", _core.sample_scenes(
        fspath(output), fspath(weights), type, int(count), prompts, int(steps), float(guidance),
        _paths(assets), int(seed), bool(raw), bool(force), reporter(progress)))


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
        fspath(source), fspath(output), False, scenes, int(count), prompt, [], fspath(weights),
        type, int(seed), bool(force), reporter(progress)))


def rearrange(source: Path, output: Path, keep: Iterable[str] = (), scenes: str = "",
              weights: Path = "", type: str = "", seed: int = 1, force: bool = False,
              progress: ProgressArgument = None) -> Report:
    """Finds new poses for the objects of scenes.

    Args:
        source (path): a dataset, a folder of ``export``, or a JSON file of poses.
        output (path): the dataset's folder.
        keep (list of str): names of the objects that stay.
        scenes, weights, type, seed, force, progress: as for ``complete``.

    Returns:
        dict: the report of ``simwright scene rearrange --json``.

    Raises:
        Error: for a source or a model that does not fit.
    """
    return cast("Report", _core.steer_scenes(
        fspath(source), fspath(output), True, scenes, -1, "", list(keep), fspath(weights), type,
        int(seed), bool(force), reporter(progress)))


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
        type, fspath(data), fspath(weights), fspath(samples), int(count), int(seed),
        reporter(progress)))


def export(dataset: Path, output: Path, scenes: str = "",
           formats: WorldFormat | Iterable[WorldFormat] = ("mjcf",), check: bool = False,
           force: bool = False, progress: ProgressArgument = None) -> Report:
    """Writes scenes as worlds for simulators.

    Args:
        dataset (path): a folder of shards, or one shard.
        output (path): one folder per scene, and the assets beside them.
        scenes (str): such as "0,3-5"; empty: all.
        formats (list of str): of urdf, sdf, mjcf, drake.
        check (bool): checks each scene's stability in Bullet and MuJoCo.
        force (bool): replaces an existing output.
        progress: see ``simwright``.

    Returns:
        dict: the report of ``simwright scene export --json``.

    Raises:
        Error: for an unknown format or scene, or an existing output.
    """
    chosen = {formats} if isinstance(formats, str) else set(formats)
    return cast("Report", _core.export_worlds(
        fspath(dataset), fspath(output), scenes, chosen, bool(check), bool(force),
        reporter(progress)))
