"""Shipped and trained policies: loading, acting, measuring."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, cast

from . import _arguments as checked
from . import _core
from ._cells import cell_tasks
from ._core import Policy
from ._progress import reporter

if TYPE_CHECKING:
    from . import _types

__all__ = ["Policy", "evaluate", "load", "names", "wilson_interval"]


def names() -> list[str]:
    """Returns the names of the shipped skills."""
    return [cell["name"] for cell in _core.cells()]


def _models() -> Path:
    folder = os.environ.get("SIMWRIGHT_MODELS") or _core.models_folder()
    if not str(folder):
        raise _core.Error("models: the folder of the shipped weights is missing "
                          "(set SIMWRIGHT_MODELS to it)")
    return Path(folder)


def load(name_or_path: _types.Path) -> Policy:
    """Loads a policy.

    Args:
        name_or_path (str or path): a name of ``names()``, or the path of a policy file.

    Returns:
        Policy: ``act(observations)`` maps (n, O) float32 to (n, A) float32 in [-1, 1].

    Raises:
        Error: for an unknown name (listing the known ones), or a missing or damaged file.
    """
    text = checked.path("skill", name_or_path, required=False)
    if text in names():
        return _core.read_policy(str(_core.shipped_policy_path(str(_models()), text)))
    if os.sep in text or text.endswith(".pt"):
        return _core.read_policy(text)
    raise _core.Error(f"skill: there is no '{text}' (it is one of {', '.join(names())}, or the path "
                      "of a policy file)")


def evaluate(skill: str, episodes: int = 100, seed: int = 1,
             policy: Policy | _types.PolicyName = "shipped", split: _types.Split = "unseen",
             progress: _types.ProgressArgument = None) -> _types.Evaluation:
    """Measures the success of a policy on instances of its kind.

    Args:
        skill (str): a name of ``names()``.
        episodes (int): number of episodes.
        seed (int): of their starts.
        policy (Policy, "shipped" or "expert"): what acts; "expert" is the scripted expert.
        split (str): "unseen" instances, or those of the "train" split.
        progress: see ``simwright``.

    Returns:
        dict: ``episodes``, ``successes``, ``success`` (share), ``interval`` (95 %), ``seconds`` (mean
        of the successes).

    Raises:
        Error: for an unknown skill, or a policy of other sizes.
    """
    report = reporter(progress)
    episodes, seed = checked.integer("episodes", episodes, 1), checked.seeded(seed)
    cell = next((entry for entry in _core.cells() if entry["name"] == skill), None)
    if cell is None:
        raise _core.Error(f"skill: there is no {checked.shown(skill)} "
                          f"(it is one of {', '.join(names())})")
    acting = _acting(skill, policy)
    file = cell_tasks(skill, split, report=report)
    settings = _core.TaskSettings()
    settings.robot = cell["robot"]
    if acting is not None:
        settings.action_space = acting.metadata.get("action", "focus")
    # A policy grasps as it was trained to; the expert by all that is known.
    settings.proved_grasps = acting is None or acting.metadata.get("proved_grasps") == "true"
    task = _core.PreparedTask(str(file), ["*"], settings)
    return cast("_types.Evaluation", _core.evaluate(task, 0, acting, episodes, seed, report))


def _acting(skill: str, policy: Policy | _types.PolicyName) -> Policy | None:
    """Returns the policy that ``evaluate`` runs, None for the expert; refuses one of other sizes."""
    if isinstance(policy, str):
        if policy not in ("shipped", "expert"):
            raise _core.Error(f"policy: is '{policy}' (give shipped, expert or a Policy)")
        return load(skill) if policy == "shipped" else None
    checked.instance("policy", policy, Policy, "give shipped, expert or a Policy of skills.load")
    try:
        shipped = load(skill)
    except _core.Error:
        return policy  # the sizes are compared when the objects are made
    # An observation ends with the action before.
    wanted = shipped.observation_size - shipped.action_size + policy.action_size
    if policy.observation_size != wanted:
        raise _core.Error(f"policy: takes {policy.observation_size} numbers, {skill} has {wanted} "
                          "(give a policy of this skill)")
    return policy


def wilson_interval(successes: int, count: int) -> tuple[float, float]:
    """Returns the 95 % Wilson interval of a success rate.

    Args:
        successes (int): of the trials, 0 to ``count``.
        count (int): number of trials.

    Returns:
        (low, high): shares, in [0, 1]; (0, 1) without trials.

    Raises:
        Error: for another type, or more successes than trials.
    """
    count = checked.integer("count", count, 0)
    return _core.wilson_interval(checked.integer("successes", successes, 0, count), count)
