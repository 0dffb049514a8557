"""Tasks for robots: generated for assets, trained, rolled out and exported."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from . import _arguments as checked
from . import _core
from ._progress import reporter

if TYPE_CHECKING:
    from ._types import (Names, Path, Paths, ProgressArgument, Report, RunActionSpace,
                         TrajectoryFormat, TrajectoryPace)

__all__ = ["export", "make", "read", "rollout", "train"]


def read(file: Path) -> dict[str, Any]:
    """Returns the contents of a tasks.json as dicts and lists (docs/formats.md)."""
    import json

    name = checked.path("file", file)
    try:
        with open(name, encoding="utf-8") as stream:
            return cast("dict[str, Any]", json.load(stream))
    except (OSError, ValueError) as error:
        raise _core.Error(f"{name}: cannot be read ({error})") from None


def make(assets: Paths, output: Path, count: int = 0, seed: int = 1, force: bool = False,
         llm: str = "", llm_model: str = "", llm_cache: Path = "", replay: Path = "",
         progress: ProgressArgument = None) -> Report:
    """Generates tasks for assets, by rules or a language model, and verifies each subtask.

    Args:
        assets (str, path or list of them): PATH or NAME=PATH, asset folders or URDFs.
        output (path): the tasks.json to write; a page goes beside it.
        count (int): most tasks; 0: five per asset by rules, eight by a language model.
        seed (int): of the choice.
        force (bool): replaces an existing file.
        llm (str): the address of a language model (docs/llm.md), "env" for that of
            SIMWRIGHT_LLM_URL; its key is that of SIMWRIGHT_LLM_KEY. Empty: by rules.
        llm_model (str): its name; empty: SIMWRIGHT_LLM_MODEL.
        llm_cache (path): a folder of cached answers; empty: none.
        replay (path): instead of ``llm``, answers that `simwright tasks --record` has recorded.
        progress: see ``simwright``.

    Returns:
        dict: the report of ``simwright tasks --json``.

    Raises:
        Error: if an asset cannot be read, the output exists, or the model is not reachable.
    """
    recorded = checked.path("replay", replay, required=False)
    if llm and recorded:
        raise _core.Error("llm: is given beside replay (give one of them)")
    return cast("Report", _core.make_tasks(
        checked.paths("assets", assets), checked.path("output", output),
        checked.integer("count", count, 0), checked.seeded(seed), bool(force),
        checked.text("llm", llm), checked.text("llm_model", llm_model),
        checked.path("llm_cache", llm_cache, required=False), recorded, reporter(progress)))


def train(file: Path, task: Names, output: Path, robot: str = "panda",
          action_space: RunActionSpace = "focus", num_envs: int = 64, samples: int = 2_000_000,
          minutes: float = 30.0, imitated_samples: int = 65_536, episodes: int = 200,
          seed: int = 1, resume: bool = False, progress: ProgressArgument = None) -> Report:
    """Trains one policy per subtask in Bullet, as ``simwright train`` does.

    Args:
        file (path): a tasks.json.
        task (str or list of str): names or patterns ('*'); several tasks share a policy.
        output (path): the run's folder.
        robot (str): panda, panda_on_base, or a URDF with its side file.
        action_space (str): focus, guided, absolute, delta, joints or joint_targets.
        num_envs (int): environments.
        samples (int): most decisions per subtask.
        minutes (float): most minutes per subtask; 0: unlimited.
        imitated_samples (int): decisions that imitate the scripted expert first.
        episodes (int): per evaluation.
        seed (int): of the training.
        resume (bool): continues an interrupted run.
        progress: see ``simwright``.

    Returns:
        dict: the report of ``simwright train --json``.

    Raises:
        Error: for an unknown task or a folder with another run.
    """
    return cast("Report", _core.train_task(
        checked.path("file", file), checked.texts("task", task), checked.path("output", output),
        checked.text("robot", robot), checked.text("action_space", action_space),
        checked.integer("num_envs", num_envs, 1), checked.integer("samples", samples, 1),
        checked.number("minutes", minutes, 0.0),
        checked.integer("imitated_samples", imitated_samples, 0),
        checked.integer("episodes", episodes, 1), checked.seeded(seed), bool(resume),
        reporter(progress)))


def rollout(run: Path, episodes: int = 100, seed: int = 1, on: Path = "", tasks: Names = (),
            pictures: Path = "", progress: ProgressArgument = None) -> Report:
    """Measures the success rate of a training run.

    Args:
        run (path): a folder of ``train``.
        episodes (int): number of episodes.
        seed (int): of their starts.
        on (path): a tasks.json with similar tasks to evaluate on; empty: the run's own.
        tasks (str or list of str): names or patterns in it.
        pictures (path): a PNG of an episode; empty: none.
        progress: see ``simwright``.

    Returns:
        dict: the report of ``simwright rollout --json``, with 95 % intervals.

    Raises:
        Error: if the folder has no run, or ``on`` does not match it.
    """
    return cast("Report", _core.rollout(
        checked.path("run", run), checked.integer("episodes", episodes, 1), checked.seeded(seed),
        checked.path("on", on, required=False), checked.texts("tasks", tasks),
        checked.path("pictures", pictures, required=False), reporter(progress)))


def export(run: Path, output: Path, format: TrajectoryFormat = "ros2", episodes: int = 1,
           seed: int = 1, force: bool = False, progress: ProgressArgument = None,
           pace: TrajectoryPace = "limits") -> Report:
    """Exports trajectories or demonstrations of a training run, each verified by replay.

    Args:
        run (path): a folder of ``train``.
        output (path): a file, or a folder for several trajectories.
        format (str): ros2, csv or robomimic.
        episodes (int): successful episodes to write.
        seed (int): of their starts.
        force (bool): replaces an existing folder.
        progress: see ``simwright``.
        pace (str): of trajectories: limits, as fast as the robot's limits and the task allow, or
            recorded, at most as fast as recorded.

    Returns:
        dict: the report of ``simwright export --json``.

    Raises:
        Error: for a file extension that does not match the format.
    """
    return cast("Report", _core.export_run(
        checked.path("run", run), checked.path("output", output), checked.text("format", format),
        checked.integer("episodes", episodes, 1), checked.seeded(seed), bool(force),
        checked.text("pace", pace), reporter(progress)))
