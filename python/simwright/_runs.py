"""The tasks, settings and policies of a folder that ``simwright train`` wrote."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import _core

if TYPE_CHECKING:
    from ._types import Float32Array


def environment_settings(run: dict[str, Any]) -> dict[str, Any]:
    """Returns the arguments of the environment of a run.

    Args:
        run (dict): of ``_core.read_run``.

    Returns:
        dict: arguments of ``LongTaskEnv``, with ``long`` True, where the run has several subtasks,
        else of ``SkillEnv``.
    """
    settings = {name: run[name] for name in ("tasks", "robot", "action_space", "episode_seconds",
                                             "finger_friction", "proved_grasps")}
    if len(run["subtasks"]) > 1:
        settings["long"] = True
    return settings


class RunPolicies:
    """Acts with the policy of the current subtask.

    Args:
        run (dict): of ``_core.read_run``.

    Raises:
        Error: where a subtask has no policy yet.
    """

    def __init__(self, run: dict[str, Any]) -> None:
        self.metadata = {"action": run["action_space"]}
        self._policies = [_core.read_policy(subtask["policy"]) for subtask in run["subtasks"]]

    def act(self, states: Float32Array) -> Float32Array:
        """Returns the actions (1, A) of states (1, O) of ``SkillEnv`` or ``LongTaskEnv``."""
        if len(self._policies) == 1:
            return self._policies[0].act(states)
        count = len(self._policies)
        policy = self._policies[int(states[0, :count].argmax())]
        return policy.act(states[:, count:count + policy.observation_size])
