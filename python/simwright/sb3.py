"""Stable-Baselines3's view of the vector environment.

    from simwright.sb3 import VecEnv
    model = PPO("MlpPolicy", VecEnv("simwright/OpenDrawer-v0", num_envs=64))
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np
from stable_baselines3.common.vec_env import VecEnv as _VecEnv

from . import _core

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from stable_baselines3.common.vec_env.base_vec_env import (VecEnvIndices, VecEnvObs,
                                                               VecEnvStepReturn)

__all__ = ["VecEnv"]


class VecEnv(_VecEnv):
    """Wraps a native vector environment of this package.

    Infos of ended episodes have ``terminal_observation``, ``TimeLimit.truncated``, ``is_success``
    and ``episode`` (return ``r`` and length ``l``), so that SB3's logs need no monitor.

    Args:
        env (str or gymnasium.vector.VectorEnv): an environment's id, or a native vector environment.
        num_envs (int): for an id.
        **kwargs: for gymnasium.make_vec.
    """

    def __init__(self, env: str | gymnasium.vector.VectorEnv[Any, Any, Any], num_envs: int = 64,
                 **kwargs: Any) -> None:
        if isinstance(env, str):
            env = gymnasium.make_vec(env, num_envs=num_envs,
                                     vectorization_mode="vector_entry_point", **kwargs)
        self.envs = env
        super().__init__(env.num_envs, env.single_observation_space, env.single_action_space)
        self._actions: Any = None
        self._seed = None
        self._returns = np.zeros(env.num_envs)
        self._lengths = np.zeros(env.num_envs, dtype=int)

    def reset(self) -> VecEnvObs:
        seeds, self._seeds = self._seeds, [None] * self.num_envs
        observations: VecEnvObs
        observations, _ = self.envs.reset(seed=seeds[0])
        self._returns[:] = 0.0
        self._lengths[:] = 0
        return observations

    def step_async(self, actions: NDArray[Any]) -> None:
        self._actions = actions

    def step_wait(self) -> VecEnvStepReturn:
        observations, rewards, terminated, truncated, infos = self.envs.step(self._actions)
        self._returns += rewards
        self._lengths += 1
        dones = terminated | truncated
        results: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        for index in np.flatnonzero(dones):
            results[index] = {
                "terminal_observation": infos["final_obs"][index],
                "TimeLimit.truncated": bool(truncated[index]),
                "is_success": bool(infos["final_info"]["is_success"][index]),
                "episode": {"r": float(self._returns[index]), "l": int(self._lengths[index])},
            }
            self._returns[index] = 0.0
            self._lengths[index] = 0
        return observations, rewards, dones, results

    def close(self) -> None:
        self.envs.close()

    def _all(self, indices: VecEnvIndices) -> int:
        return len(list(self._get_indices(indices)))

    def get_attr(self, attr_name: str, indices: VecEnvIndices = None) -> list[Any]:
        return [getattr(self.envs, attr_name)] * self._all(indices)

    def set_attr(self, attr_name: str, value: Any, indices: VecEnvIndices = None) -> None:
        raise _core.Error("the environments: share their settings (make new ones instead)")

    def env_method(self, method_name: str, *method_args: Any, indices: VecEnvIndices = None,
                   **method_kwargs: Any) -> list[Any]:
        raise _core.Error(f"{method_name}: cannot be called on one of the native environments")

    def env_is_wrapped(self, wrapper_class: type[gymnasium.Wrapper[Any, Any, Any, Any]],
                       indices: VecEnvIndices = None) -> list[bool]:
        return [False] * self._all(indices)
