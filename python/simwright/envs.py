"""Gymnasium environments of skills, long tasks and any tasks.json.

    import gymnasium, simwright
    env = gymnasium.make("simwright/OpenDrawer-v0")
    envs = gymnasium.make_vec("simwright/OpenDrawer-v0", num_envs=64)
    env = gymnasium.make("simwright/Task-v0", tasks="tasks.json", task="pick_up_cup_*")

An action lasts 0.05 s. Action spaces (docs/python.md): "focus" (relative to the target), "guided"
(added to the scripted expert's), "delta", "osc_delta" (robosuite's OSC_POSE), "absolute", "joints"
and "joint_targets"; all are boxes in [-1, 1]. ``policy.action_space`` names that of a policy.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space

from . import _arguments as checked
from . import _core
from ._cells import long_task
from ._progress import reporter
from ._worlds import Worlds, fault_of, numbers, task_file

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ._types import (ActionSpace, Cameras, CameraState, EnvironmentState, Float32Array,
                         ImageArray, ImageKinds, ImageSize, Info, Look, Names, Observation, Path,
                         ProgressArgument, Range, RenderMode, Split)

__all__ = ["LongTaskEnv", "SkillEnv", "SkillVectorEnv", "register_envs"]


class SkillEnv(Worlds, gymnasium.Env):
    """One subtask with a Franka Panda, in Bullet.

    Args:
        cell (str): a cell of the skill suite, such as "open_drawer".
        tasks (path): instead of a cell, a tasks.json.
        task (str or list of str): a name, or patterns, in the tasks.json or in the cell's tasks.
        subtask (int): index of the subtask in these tasks.
        split (str): of a cell, "train" or "unseen" objects.
        instances (int): of a cell, how many objects; None: those of the shipped policy's split.
        action_space (str): see the module.
        robot (str): panda, panda_on_base, or a URDF with its side file; None: the cell's.
        easy_starts (bool): a share of episodes starts at the target, or with its joint partly open.
        episode_seconds (float): s, then the episode is truncated.
        cameras (list): "front", "wrist", "shoulder" or ``simwright.cameras.camera(...)``. With
            cameras the observation is a dict of "state" and the images: NAME (H, W, 3) uint8 RGB,
            NAME_depth (H, W) float32, m, NAME_segmentation (H, W) int32, NAME_normal (H, W, 3)
            float32, world.
        image_size (int, or width and height): pixels, of cameras given by name.
        images (list): kinds of images: "rgb", "depth", "segmentation", "normal".
        look: how the look is randomised by the seed: None, "wide", or see ``simwright.cameras``.
        render_mode (str): None or "rgb_array".
        render_size (width, height): pixels, of ``render()``.
        progress: see ``simwright``; making the objects of a cell takes up to a minute once.
        finger_friction (low, high): range of the fingers' friction coefficient, sampled for each
            episode; None: the robot's.
        proved_grasps (bool): whether objects and sliding parts are grasped by the proved grasps of
            their grasps.json, where there is one (docs/grasps.md), else from above.

    Observations are (O) float32, about 1 in size (docs/skills.md). ``info`` has ``success`` (the
    goal holds now), ``is_success`` (it held for half a second, which ends the episode) and, after a
    fault, ``fault``. The reward is the task's program plus 1 while the goal holds.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 20}

    def __init__(self, cell: str | None = None, tasks: Path | None = None, task: Names = "*",
                 subtask: int = 0, split: Split = "train",
                 instances: int | None = None, action_space: ActionSpace = "focus",
                 robot: str | None = None, easy_starts: bool = False,
                 episode_seconds: float | None = None, cameras: Cameras = (),
                 image_size: ImageSize = 128, images: ImageKinds = ("rgb",), look: Look = None,
                 render_mode: RenderMode | None = None, render_size: tuple[int, int] = (480, 360),
                 progress: ProgressArgument = None,
                 finger_friction: Range | None = None, proved_grasps: bool = True) -> None:
        subtask = checked.integer("subtask", subtask, 0)
        pictures = self._choose_cameras(cameras, image_size, images, look, render_mode, render_size)
        file, robot = task_file(cell, tasks, robot, split, instances, progress)
        self._prepare(file, robot, task, action_space, subtask, episode_seconds, finger_friction,
                      proved_grasps)
        self._episode = _core.SingleEpisode(self.task, subtask, not easy_starts)
        self._eyes = self._make_cameras(subtask, not easy_starts)
        if self._eyes is not None:
            self._episode.attach_cameras(self._eyes)
        self.observation_space = self._space(
            spaces.Box(-np.inf, np.inf, (self.task.observation_size(subtask),), np.float32),
            pictures)
        self.action_space = spaces.Box(-1.0, 1.0, (self.task.action_size(subtask),), np.float32)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None,
              ) -> tuple[Observation, Info]:
        """Starts the next episode of the seed; a new seed starts with its first one."""
        self._require_open()
        seed = None if seed is None else checked.seeded(seed)
        super().reset(seed=seed)
        observation = self._episode.begin(*self._number_episode(seed, self.np_random))
        self._begun = self._running = True
        return self._observation(observation), {"success": False, "is_success": False}

    def _observation(self, state: Float32Array) -> Observation:
        if not self._seen:
            return state
        return self._with_images(state, self._episode.images(self._seen, self._kinds))

    def step(self, action: ArrayLike) -> tuple[Observation, float, bool, bool, Info]:
        """Executes an action (A), clamped to [-1, 1]; one that is not finite ends the episode."""
        self._require_running()
        action = self._sent(numbers(action, self.action_space.shape))
        observation, reward, held, truncated, success, invalid, failed = self._episode.step(action)
        info = {"success": success, "is_success": held}
        if invalid or failed:
            info["fault"] = fault_of(action, failed)
            held, truncated = invalid, not invalid
        self._running = not (held or truncated)
        return self._observation(observation), float(reward), held, truncated, info

    def render(self) -> NDArray[np.uint8]:
        """Returns the picture (H, W, 3) uint8 of the robot and its objects."""
        self._require_render()
        images: dict[str, Any] = self._episode.images(["render"], ["rgb"])
        return cast("NDArray[np.uint8]", images["render"]["rgb"])

    def camera(self, name: str) -> CameraState:
        """Returns a camera as it is now: ``pose`` (4, 4), world from camera, m; ``intrinsics`` (fx,
        fy, cx, cy), pixels; ``legend``, the names of the segmentation's labels."""
        self._require_open()
        return cast("CameraState", self._episode.camera(name))

    def expert_action(self) -> Float32Array | None:
        """Returns the scripted expert's action (A), or None where there is none."""
        self._require_open()
        return cast("Float32Array | None", self._episode.expert_action())

    def state(self) -> EnvironmentState:
        """Returns the state in SI units, world frame: robot_joints (rad), robot_command (the
        arm's set points, rad or m), gripper_pose (4, 4), gripper_opening (m), grasped, objects
        (pose (4, 4), joints), target (the name of the object that the subtask is about), seconds."""
        self._require_open()
        return cast("EnvironmentState", self._episode.state())

    def close(self) -> None:
        self._open = False


class SkillVectorEnv(Worlds, gymnasium.vector.VectorEnv):
    """N environments of a subtask, stepped in C++ on all threads.

    An episode that ends restarts in the same step (``AutoresetMode.SAME_STEP``): ``final_obs`` in
    the infos holds its last observation, ``final_info`` its success. Arguments as for ``SkillEnv``.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 20,
                "autoreset_mode": AutoresetMode.SAME_STEP}

    def __init__(self, num_envs: int = 1, cell: str | None = None, tasks: Path | None = None,
                 task: Names = "*", subtask: int = 0, split: Split = "train",
                 instances: int | None = None, action_space: ActionSpace = "focus",
                 robot: str | None = None, easy_starts: bool = False,
                 episode_seconds: float | None = None, cameras: Cameras = (),
                 image_size: ImageSize = 128, images: ImageKinds = ("rgb",), look: Look = None,
                 render_mode: RenderMode | None = None, render_size: tuple[int, int] = (480, 360),
                 progress: ProgressArgument = None,
                 finger_friction: Range | None = None, proved_grasps: bool = True) -> None:
        self.num_envs = checked.integer("num_envs", num_envs, 1)
        subtask = checked.integer("subtask", subtask, 0)
        pictures = self._choose_cameras(cameras, image_size, images, look, render_mode, render_size)
        file, robot = task_file(cell, tasks, robot, split, instances, progress)
        self._prepare(file, robot, task, action_space, subtask, episode_seconds, finger_friction,
                      proved_grasps)
        self._episodes = _core.VectorEpisodes(self.task, subtask, self.num_envs, not easy_starts)
        self._eyes = self._make_cameras(subtask, not easy_starts)
        if self._eyes is not None:
            self._episodes.attach_cameras(self._eyes, self._seen, self._kinds)
        self.single_observation_space = self._space(
            spaces.Box(-np.inf, np.inf, (self._episodes.observation_size,), np.float32), pictures)
        self.single_action_space = spaces.Box(-1.0, 1.0, (self._episodes.action_size,), np.float32)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)

    def reset(self, *, seed: int | list[int | None] | None = None,
              options: dict[str, Any] | None = None) -> tuple[Observation, Info]:
        """Restarts all episodes. ``seed``: an int, or a list of N ints that is condensed to one."""
        self._require_open()
        if options and "reset_mask" in options:
            raise _core.Error("reset_mask: is not used "
                              "(episodes restart in the step that ends them)")
        if isinstance(seed, (list, tuple)) or (isinstance(seed, np.ndarray) and seed.ndim == 1):
            if len(seed) != self.num_envs:
                raise _core.Error(f"seed: has {len(seed)} entries "
                                  f"(give {self.num_envs}, or one int)")
            numbered = [checked.seeded(one) for one in seed if one is not None]
            if len(numbered) < len(seed):
                seed = None
            else:
                state = np.random.SeedSequence(numbered).generate_state(2)
                seed = int(state[0]) << 30 | int(state[1]) >> 2
        seed = None if seed is None else checked.seeded(seed)
        super().reset(seed=seed)
        if seed is None:
            seed = int(self.np_random.integers(2**62))
        observations = self._episodes.reset(seed)
        self._begun = True
        return self._observation(observations), self._info(np.zeros(self.num_envs, dtype=bool))

    def _observation(self, states: Float32Array) -> Observation:
        if not self._seen:
            return states
        return self._with_images(states, self._episodes.images(self._seen, self._kinds))

    def _info(self, success: NDArray[np.bool_]) -> Info:
        return {"success": success, "_success": np.ones(self.num_envs, dtype=bool)}

    def step(self, actions: ArrayLike) -> tuple[
            Observation, NDArray[np.float32], NDArray[np.bool_], NDArray[np.bool_], Info]:
        """Executes actions (N, A), clamped to [-1, 1]."""
        self._require_open()
        if not self._begun:
            raise _core.Error("the episodes: have not begun (call reset())")
        actions = self._sent(numbers(actions, self.action_space.shape))
        (observations, rewards, terminated, truncated, success, last, invalid,
         failed) = self._episodes.step(actions)
        infos = self._info(success)
        if last is not None:
            terminated, truncated = terminated | invalid, truncated & ~invalid
            ended = terminated | truncated
            final = np.full(self.num_envs, None, dtype=object)
            if self._seen:
                images = cast("dict[str, dict[str, ImageArray]]", self._episodes.last_images())
                last = self._with_images(last, images)
            for index in np.flatnonzero(ended):
                final[index] = ({key: value[index] for key, value in last.items()}
                                if self._seen else last[index])
            infos["final_obs"], infos["_final_obs"] = final, ended
            final_info = {"is_success": success & ended, "_is_success": ended.copy()}
            faults = invalid | failed
            if faults.any():
                text = np.full(self.num_envs, None, dtype=object)
                for index in np.flatnonzero(faults):
                    text[index] = fault_of(actions[index], failed[index], int(index))
                final_info["fault"], final_info["_fault"] = text, faults
            infos["final_info"], infos["_final_info"] = final_info, ended.copy()
        return self._observation(observations), rewards, terminated, truncated, infos

    def render(self) -> tuple[NDArray[np.uint8], ...]:
        """Returns the pictures (H, W, 3) uint8 of the robots, one per environment."""
        self._require_render()
        return tuple(self._episodes.images(["render"], ["rgb"])["render"]["rgb"])

    def expert_actions(self) -> Float32Array | None:
        """Returns the scripted expert's actions (N, A), or None where there is none."""
        self._require_open()
        return cast("Float32Array | None", self._episodes.demonstrate())

    def close_extras(self, **kwargs: Any) -> None:
        self._open = False


class LongTaskEnv(Worlds, gymnasium.Env):
    """A task of several subtasks, one after the other.

    Observations: the index of the current subtask as a one-hot vector, then its observation, padded
    with zeros to the longest. The next subtask begins where the goal of the one before was held for
    half a second; ``terminated`` is the goal of the last one. ``info`` has ``subtask`` (index) and
    what ``SkillEnv`` says. Arguments as for ``SkillEnv``; ``name`` is a shipped long task.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 20}

    def __init__(self, name: str | None = None, tasks: Path | None = None, task: Names = "*",
                 action_space: ActionSpace = "focus", robot: str | None = None,
                 episode_seconds: float | None = None, cameras: Cameras = (),
                 image_size: ImageSize = 128, images: ImageKinds = ("rgb",), look: Look = None,
                 render_mode: RenderMode | None = None, render_size: tuple[int, int] = (480, 360),
                 progress: ProgressArgument = None,
                 finger_friction: Range | None = None, proved_grasps: bool = True) -> None:
        if (name is None) == (tasks is None):
            raise _core.Error("environment: needs a long task, or a tasks.json (give name= or tasks=)")
        pictures = self._choose_cameras(cameras, image_size, images, look, render_mode, render_size)
        if name is not None:
            tasks = long_task(name, reporter(progress))
            known = next(entry for entry in _core.long_tasks() if entry["name"] == name)
            robot = robot or known["robot"]
        self._prepare(checked.path("tasks", cast("Path", tasks)), robot or "panda", task,
                      action_space, None, episode_seconds, finger_friction, proved_grasps)
        count = len(self.task.subtasks)
        self._episodes = [_core.SingleEpisode(self.task, index, True) for index in range(count)]
        for index, episode in enumerate(self._episodes):
            eyes = self._make_cameras(index, True)
            if eyes is not None:
                episode.attach_cameras(eyes)
        self._longest = max(self.task.observation_size(index) for index in range(count))
        self.observation_space = self._space(
            spaces.Box(-np.inf, np.inf, (count + self._longest,), np.float32), pictures)
        self.action_space = spaces.Box(-1.0, 1.0, (self.task.action_size(0),), np.float32)
        self._subtask = 0

    def _observation(self, part: Float32Array) -> Observation:
        count = len(self._episodes)
        whole = np.zeros(count + self._longest, np.float32)
        whole[self._subtask] = 1.0
        whole[count:count + part.shape[0]] = part
        if not self._seen:
            return whole
        episode = self._episodes[self._subtask]
        return self._with_images(whole, episode.images(self._seen, self._kinds))

    def render(self) -> NDArray[np.uint8]:
        """Returns the picture (H, W, 3) uint8 of the robot and its objects."""
        self._require_render()
        images: dict[str, Any] = self._episodes[self._subtask].images(["render"], ["rgb"])
        return cast("NDArray[np.uint8]", images["render"]["rgb"])

    def subtask_observation(self, observation: Observation) -> Float32Array:
        """Returns the current subtask's own observation, which its policy takes."""
        state: Float32Array = observation["state"] if self._seen else observation
        count = len(self._episodes)
        return state[count:count + self.task.observation_size(self._subtask)]

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None,
              ) -> tuple[Observation, Info]:
        """Starts the next episode of the seed; a new seed starts with its first one."""
        self._require_open()
        seed = None if seed is None else checked.seeded(seed)
        super().reset(seed=seed)
        numbered = self._number_episode(seed, self.np_random)
        self._subtask = 0
        self._begun = self._running = True
        part = self._episodes[0].begin(*numbered)
        return self._observation(part), {"success": False, "is_success": False, "subtask": 0}

    def step(self, action: ArrayLike) -> tuple[Observation, float, bool, bool, Info]:
        """Executes an action (A) in the current subtask."""
        self._require_running()
        action = self._sent(numbers(action, self.action_space.shape))
        episode = self._episodes[self._subtask]
        part, reward, held, truncated, success, invalid, failed = episode.step(action)
        info = {"success": success, "is_success": False, "subtask": self._subtask}
        terminated = False
        if invalid or failed:
            info["fault"] = fault_of(action, failed)
            terminated, truncated = invalid, not invalid
        elif held and self._subtask + 1 < len(self._episodes):
            self._subtask += 1
            part = self._episodes[self._subtask].begin_after(episode)
            info["subtask"] = self._subtask
        elif held:
            terminated = info["is_success"] = True
        self._running = not (terminated or truncated)
        return self._observation(part), float(reward), terminated, truncated, info

    def expert_action(self) -> Float32Array | None:
        """Returns the scripted expert's action (A), or None where there is none."""
        self._require_open()
        return cast("Float32Array | None", self._episodes[self._subtask].expert_action())

    def camera(self, name: str) -> CameraState:
        """Returns a camera as it is now, as ``SkillEnv.camera``."""
        self._require_open()
        return cast("CameraState", self._episodes[self._subtask].camera(name))

    def state(self) -> EnvironmentState:
        """Returns the state in SI units, as ``SkillEnv.state``."""
        self._require_open()
        return cast("EnvironmentState", self._episodes[self._subtask].state())

    def close(self) -> None:
        self._open = False


def _camel(name: str) -> str:
    return "".join(word.capitalize() for word in name.split("_"))


def register_envs() -> None:
    """Registers simwright/OpenDrawer-v0 and the other environments, once."""
    def register(title: str, entry: str, vector: str | None = None, **kwargs: Any) -> None:
        full = f"simwright/{title}-v0"
        if full not in gymnasium.registry:
            gymnasium.register(full, entry_point=f"simwright.envs:{entry}",
                               vector_entry_point=vector and f"simwright.envs:{vector}",
                               kwargs=kwargs, disable_env_checker=False)

    for cell in _core.cells():
        register(_camel(cell["name"]), "SkillEnv", "SkillVectorEnv", cell=cell["name"])
    for task in _core.long_tasks():
        register(_camel(task["name"]), "LongTaskEnv", name=task["name"])
    register("Task", "SkillEnv", "SkillVectorEnv")
    register("LongTask", "LongTaskEnv")
