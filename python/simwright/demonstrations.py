"""Demonstrations of skills with camera images, in the formats that people train on.

    from simwright import demonstrations
    episodes = demonstrations.record("open_drawer", 50, cameras=["front", "wrist"])
    demonstrations.write_lerobot("drawers", episodes)

    python -m simwright.demonstrations --skill open_drawer --episodes 50 --format lerobot -o drawers
    python -m simwright.demonstrations --run FOLDER --format mcap -o episodes

``record`` yields one episode after the other; the writers take any iterable of episodes and hold
one in memory. docs/demonstrations.md lists the keys of each format.
"""

from __future__ import annotations

import dataclasses
import json
import re
import sys
import time
from typing import TYPE_CHECKING, Any, Callable, Iterator, Sequence

import numpy as np

from . import _arguments as checked
from . import _core, skills
from ._runs import RunPolicies, environment_settings
from ._lerobot import write_lerobot
from ._mcap import write_mcap
from ._progress import reporter
from ._robomimic import write_robomimic

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ._types import (Acting, Cameras, Description, FloatArray, Float32Array, ImageArray,
                         ImageKinds, ImageSize, Intrinsics, Keep, Look, ObjectTrack, Path,
                         PolicyName, ProgressArgument, RecordedActions, Reporter)
    from .envs import LongTaskEnv, SkillEnv

__all__ = ["Episode", "describe", "record", "write_lerobot", "write_mcap", "write_robomimic"]

STEP_SECONDS = 0.05
# Fewer successes than this share of the attempts end a recording.
_LEAST_SUCCESS = 0.05
_LEAST_ATTEMPTS = 20


@dataclasses.dataclass
class Episode:
    """One episode of T steps, 0.05 s each, in SI units.

    Arrays of states have T + 1 rows: row t is before action t, the last one is after all actions.

    Attributes:
        skill (str): the skill or long task.
        task (str): the task's name, with its objects.
        robot (str): as of the environment.
        seed, index (int): the episode is number ``index`` of the seed.
        success (bool): the goal was held for half a second.
        instructions (list of str): a sentence for each subtask.
        subtasks (T + 1) int: index of the current subtask.
        states (T + 1, O) float32: the policies' observation, which knows the objects
            (docs/skills.md).
        joints (T + 1, J): the arm's joints, rad or m; ``joint_names`` (J).
        joint_ranges (J, 2): their lower and upper limits.
        openings (T + 1): m between the fingertips.
        tools (T + 1, 4, 4): robot's base from the frame between the fingertips, m.
        base (4, 4): world from the robot's base, m.
        objects (dict): by name, ``poses`` (T + 1, 4, 4), world from object, m, ``joints``
            (T + 1, K) and ``joint_names`` (K).
        actions (T, A) float32: of the policy, in [-1, 1], in the space ``action_space``.
        commands (T, J + 1): the arm's set points at the end of the step, rad or m, and the
            gripper's command in [-1, 1], which opens it at 1. Unlike actions they are not relative
            to the object.
        rewards (T) float32, dones (T) bool: 1 at the end; goals (T) bool: the goal holds.
        images (dict): by camera, (T + 1, H, W, 3) uint8 RGB; NAME_depth (T + 1, H, W) float32, m,
            NAME_segmentation (T + 1, H, W) int32, and NAME_normal (T + 1, H, W, 3) float32, world,
            where they were asked for.
        camera_poses (dict): by camera, (T + 1, 4, 4), world from camera, +z forward, y down, m.
        intrinsics (dict): by camera, fx, fy, cx, cy in pixels.
        legend (dict): names of the labels of segmentations.
    """

    skill: str
    task: str
    robot: str
    seed: int
    index: int
    success: bool
    instructions: list[str]
    action_space: str
    joint_names: tuple[str, ...]
    joint_ranges: FloatArray
    subtasks: NDArray[np.int64]
    states: Float32Array
    joints: FloatArray
    openings: FloatArray
    tools: FloatArray
    base: FloatArray
    objects: dict[str, ObjectTrack]
    actions: Float32Array
    commands: FloatArray
    rewards: Float32Array
    dones: NDArray[np.bool_]
    goals: NDArray[np.bool_]
    images: dict[str, ImageArray]
    camera_poses: dict[str, FloatArray]
    intrinsics: dict[str, Intrinsics]
    legend: dict[int, str]

    def __len__(self) -> int:
        return len(self.actions)

    @property
    def times(self) -> FloatArray:
        """(T + 1) s."""
        return np.arange(len(self) + 1, dtype=np.float64) * STEP_SECONDS

    @property
    def instruction(self) -> str:
        """The sentence of a task of one subtask, or those of all subtasks."""
        return " ".join(self.instructions)

    @property
    def targets(self) -> FloatArray:
        """(T, J + 1) what an arm that follows joint targets is sent: the set points at the end of
        the next step, rad or m, since the arm arrives about a step later, and the gripper's command
        of this step."""
        rows = self.commands.copy()
        rows[:-1, :-1] = self.commands[1:, :-1]
        return rows

    def chosen_actions(self, which: RecordedActions) -> tuple[str, Float32Array]:
        """Returns an action space and the actions (T, A) float32 in it, in [-1, 1].

        Args:
            which (str): "policy", the actions in ``action_space``, or "joint_targets", ``targets``
                in the environments' action space of this name.

        Raises:
            Error: for another name, or joint targets of a robot with a joint without limits.
        """
        if which == "policy":
            return self.action_space, self.actions
        if which != "joint_targets":
            raise _core.Error(f"actions: is {which!r} (give 'joint_targets' or 'policy')")
        if not np.isfinite(self.joint_ranges).all():
            raise _core.Error(f"actions: a joint of {self.robot} has no limits, by which targets are "
                              "scaled (give actions='policy')")
        targets = self.targets
        middle, half = self.joint_ranges.mean(axis=1), 0.5 * np.ptp(self.joint_ranges, axis=1)
        targets[:, :-1] = np.clip((targets[:, :-1] - middle) / half, -1.0, 1.0)
        return "joint_targets", targets.astype(np.float32)


def record(skill: str | None = None, count: int = 50,
           policy: PolicyName | Acting | Callable[[Any], ArrayLike] | None = None,
           cameras: Cameras = ("front", "wrist"), image_size: ImageSize = 128,
           images: ImageKinds = ("rgb",), look: Look = None, seed: int = 1,
           keep: Keep = "successes", progress: ProgressArgument = None, run: Path | None = None,
           **settings: Any) -> Iterator[Episode]:
    """Records episodes.

    Args:
        skill (str): a name of ``simwright.skills.names()``, or a long task such as
            "apple_into_drawer"; None: there is a ``run``, or ``settings`` have ``tasks``, a
            tasks.json.
        count (int): number of episodes to keep.
        policy: "expert" (the scripted expert), "shipped" (the skill's trained policy), a Policy,
            anything with ``act``, observations (1, O) to actions (1, A), or a function that takes
            the environment and returns the next action (A). None: the policies of ``run``, else
            "expert".
        cameras, image_size, images, look: see ``simwright.envs.SkillEnv``; no cameras: no images.
        seed (int): of the episodes and their looks; equal seeds give equal episodes.
        keep (str): "successes", or "all" to keep failed episodes too, with ``success`` False.
        progress: see ``simwright``.
        run (path): a folder written by ``simwright train``: its tasks, robot and settings.
        **settings: of the environment, such as ``split``, ``instances``, ``robot`` and
            ``episode_seconds``.

    Returns:
        iterator of Episode: holds one episode in memory.

    Raises:
        Error: for unknown names and settings; while iterating, where fewer than one in twenty
            episodes succeeds.
    """
    if keep not in ("successes", "all"):
        raise _core.Error(f"keep: is {keep!r} (give 'successes' or 'all')")
    count, seed = checked.integer("count", count, 1), checked.seeded(seed)
    if run is not None:
        if skill is not None:
            raise _core.Error("run: is given beside a skill (give one of them)")
        told = _core.read_run(checked.path("run", run))
        settings = {**environment_settings(told), **settings}
        acting = RunPolicies(told) if policy is None else _policy(skill, policy)
    else:
        acting = _policy(skill, "expert" if policy is None else policy)
    env = _environment(skill, acting, settings, cameras=cameras, image_size=image_size,
                       images=images, look=look, progress=progress)
    return _record(env, skill, count, acting, seed, keep, reporter(progress))


def _policy(skill: str | None, policy: Any) -> Any:
    """Returns something with ``act``, or None for the expert."""
    if not isinstance(policy, str):
        if not hasattr(policy, "act") and not callable(policy):
            raise _core.Error(f"policy: is {policy!r} "
                              "(give expert, shipped, a Policy or a function)")
        return policy
    if policy not in ("expert", "shipped"):
        raise _core.Error(f"policy: is '{policy}' (give expert, shipped or a Policy)")
    if policy == "expert":
        return None
    if skill not in skills.names():
        raise _core.Error(f"policy: no policy is shipped for {skill} (give expert or a Policy)")
    return skills.load(skill)


def _environment(skill: str | None, acting: Any, settings: dict[str, Any],
                 **pictures: Any) -> SkillEnv | LongTaskEnv:
    """Returns the environment of a skill, a long task or a task file."""
    try:
        from . import envs
    except ImportError:
        raise _core.Error("demonstrations: need Gymnasium (in the source folder: "
                          "pip install '.[gym]')") from None
    metadata = getattr(acting, "metadata", None)
    settings = {"action_space": (metadata or {}).get("action", "focus"), **settings}
    if metadata is not None:  # a policy grasps as it was trained to
        settings = {"proved_grasps": metadata.get("proved_grasps") == "true", **settings}
    if acting is None and settings["action_space"] != "focus":
        raise _core.Error(f"policy: the expert acts in the space 'focus', not in "
                          f"'{settings['action_space']}' (leave action_space out)")
    long_tasks = [entry["name"] for entry in _core.long_tasks()]
    if skill is not None and skill not in skills.names() + long_tasks:
        raise _core.Error(f"skill: there is no '{skill}' (it is one of "
                          f"{', '.join(skills.names() + long_tasks)})")
    # The camera of render() is not rendered: its legend states the target.
    pictures = dict(pictures, render_mode="rgb_array", render_size=(16, 16))
    try:
        if skill in long_tasks:
            return envs.LongTaskEnv(name=skill, **settings, **pictures)
        if skill is None and settings.pop("long", False):
            return envs.LongTaskEnv(**settings, **pictures)
        return envs.SkillEnv(cell=skill, **settings, **pictures)
    except TypeError as error:
        raise _core.Error(f"settings: are not those of an environment ({error})") from None


def _record(env: SkillEnv | LongTaskEnv, skill: str | None, count: int, acting: Any, seed: int,
            keep: Keep, report: Reporter | None) -> Iterator[Episode]:
    """Yields the episodes of ``record``."""
    describe = _Descriptions(env)
    began, kept, attempts = time.monotonic(), 0, 0
    while kept < count:
        episode = _run(env, skill, acting, seed, attempts, describe)
        attempts += 1
        if episode.success or keep == "all":
            kept += 1
            if report is not None:
                report("record", f"{attempts} episodes", kept, count, time.monotonic() - began)
            yield episode
        elif attempts >= _LEAST_ATTEMPTS and kept < _LEAST_SUCCESS * attempts:
            raise _core.Error(f"record: {kept} of {attempts} episodes succeeded (try another "
                              "policy, or keep='all')")
    if report is not None:
        report("", "", 0, 0, 0.0)
    env.close()


class _Frames:
    """Collects the frames of an episode, in lists by name."""

    def __init__(self, env: SkillEnv | LongTaskEnv) -> None:
        self.rows: dict[str, list[Any]] = {}
        self.objects: dict[str, dict[str, list[Any]]] = {}
        self.images: dict[str, list[ImageArray]] = {
            key: [] for key in getattr(env.observation_space, "spaces", {}) if key != "state"}
        self.poses: dict[str, list[FloatArray]] = {name: [] for name in env._seen}
        self.intrinsics: dict[str, Intrinsics] = {}

    def add(self, **values: Any) -> None:
        for name, value in values.items():
            self.rows.setdefault(name, []).append(value)

    def look(self, env: SkillEnv | LongTaskEnv, observation: Any, subtask: int,
             world_from_base: FloatArray) -> None:
        """Adds the state that an observation belongs to."""
        state = env.state()
        self.add(states=observation["state"] if env._seen else observation, subtasks=subtask,
                 joints=state["robot_joints"], openings=state["gripper_opening"],
                 tools=np.linalg.inv(world_from_base) @ state["gripper_pose"])
        for name, frames in self.images.items():
            frames.append(observation[name])
        for name, poses in self.poses.items():
            camera = env.camera(name)
            poses.append(camera["pose"])
            self.intrinsics[name] = camera["intrinsics"]
        for name, entry in state["objects"].items():
            known = self.objects.setdefault(name, {"poses": [], "joints": [],
                                                   "joint_names": list(entry["joints"])})
            known["poses"].append(entry["pose"])
            known["joints"].append(list(entry["joints"].values()))

    def array(self, name: str, dtype: Any = np.float64) -> NDArray[Any]:
        return np.asarray(self.rows[name], dtype=dtype)


def _acted(acting: Any, env: SkillEnv | LongTaskEnv, state: Float32Array) -> NDArray[Any]:
    """Returns the action (A) of a policy's act, or of a function of the environment."""
    batched = hasattr(acting, "act")
    answer = acting.act(state[None]) if batched else acting(env)
    what, shape = "the policy's act" if batched else "the function", env.action_space.shape
    assert shape is not None
    wanted = (1, *shape) if batched else shape
    if answer is None:
        raise _core.Error(f"policy: {what} returned None (return an array {wanted})")
    try:
        action = np.asarray(answer)
    except (TypeError, ValueError, RuntimeError) as error:
        raise _core.Error(f"policy: {what} returned no array: {error} "
                          f"(return an array {wanted})") from None
    if action.shape != wanted:
        raise _core.Error(f"policy: {what} returned an array {action.shape} (return {wanted})")
    return action[0] if batched else action


def _run(env: SkillEnv | LongTaskEnv, skill: str | None, acting: Any, seed: int, index: int,
         describe: _Descriptions) -> Episode:
    """Runs an episode to its end."""
    observation, info = env.reset(seed=seed) if index == 0 else env.reset()
    about = describe.episode(env)
    base = about["base"]
    frames = _Frames(env)
    frames.look(env, observation, info.get("subtask", 0), base)
    ended = False
    while not ended:
        if acting is None:
            action = env.expert_action()
            if action is None:
                raise _core.Error(f"policy: {skill} has no expert (give another policy)")
        else:
            action = _acted(acting, env, frames.rows["states"][-1])
        observation, reward, terminated, truncated, info = env.step(action)
        ended = terminated or truncated
        # The next subtask of a long task starts with the commands of the one before.
        frames.add(actions=np.clip(action, -1.0, 1.0), rewards=reward, dones=ended,
                   goals=info["success"],
                   commands=np.append(env.state()["robot_command"], np.clip(action[-1], -1.0, 1.0)))
        frames.look(env, observation, info.get("subtask", 0), base)
    return Episode(
        skill=skill or about["task"], task=about["task"], robot=env.robot, seed=seed, index=index,
        success=bool(info["is_success"]), instructions=about["instructions"],
        action_space=env.action_space_name,
        joint_names=tuple(name for name, _, _ in env.task.arm_joints),
        joint_ranges=np.array([limits for _, *limits in env.task.arm_joints]),
        subtasks=frames.array("subtasks", np.int64), states=frames.array("states", np.float32),
        joints=frames.array("joints"), openings=frames.array("openings"),
        tools=frames.array("tools"), base=base,
        objects={name: {"poses": np.asarray(entry["poses"], dtype=np.float64),
                        "joints": np.asarray(entry["joints"], dtype=np.float64),
                        "joint_names": entry["joint_names"]}
                 for name, entry in frames.objects.items()},
        actions=frames.array("actions", np.float32), commands=frames.array("commands"),
        rewards=frames.array("rewards", np.float32), dones=frames.array("dones", bool),
        goals=frames.array("goals", bool),
        images={name: np.stack(images) for name, images in frames.images.items()},
        camera_poses={name: np.asarray(poses) for name, poses in frames.poses.items()},
        intrinsics=frames.intrinsics, legend=about["legend"])


def _pose(told: dict[str, Any]) -> FloatArray:
    """Returns the pose (4, 4) of a position and a quaternion w x y z of a task file."""
    w, x, y, z = told["quaternion_wxyz"]
    pose = np.eye(4)
    pose[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    pose[:3, 3] = told["position"]
    return pose


def describe(env: SkillEnv | LongTaskEnv) -> Description:
    """Returns what the present episode of an environment with cameras is about.

    Args:
        env (SkillEnv or LongTaskEnv): with cameras or a render_mode.

    Returns:
        dict: ``task`` (name), ``instructions`` (a sentence for each subtask), ``base`` (4, 4),
        world from the robot's base, m, ``legend``, the names of the labels of segmentations.

    Raises:
        Error: for an environment without cameras.
    """
    return _Descriptions(env).episode(env)


class _Descriptions:
    """States what episodes are about; reads the task file once."""

    def __init__(self, env: SkillEnv | LongTaskEnv) -> None:
        if not env._specs:
            raise _core.Error("describe: the environment has no cameras (make it with some)")
        with open(env.tasks_file, encoding="utf-8") as stream:
            tasks = json.load(stream)["tasks"]
        chosen = set(env.task.tasks)
        self._tasks = [task for task in tasks if task["name"] in chosen]
        self._subtask = env.subtask_index

    def episode(self, env: SkillEnv | LongTaskEnv) -> Description:
        legend = env.camera(env._specs[0].name)["legend"]
        task = self._find(legend, env.state()["target"])
        subtasks = task["subtasks"]
        if self._subtask is not None:
            subtasks = subtasks[self._subtask:self._subtask + 1]
        return {"task": task["name"], "legend": legend,
                "base": _pose(task["subtasks"][self._subtask or 0]["start"]["robot"]),
                "instructions": [subtask["description"] for subtask in subtasks]}

    def _find(self, legend: dict[int, str], target: str) -> dict[str, Any]:
        """Returns the task with the target object and the target link that the legend names."""
        found = [task for task in self._tasks if not target or target in task["assets"]]
        links = [name.split("/", 1)[1] for name in legend.values() if "/" in name]
        for link in links if len(found) > 1 else []:
            word = re.compile(rf'"{re.escape(link)}(_joint)?"')
            named = [task for task in found if word.search(
                "\n".join(task["subtasks"][self._subtask or 0]["program"]))]
            found = named or found
        chosen: dict[str, Any] = (found or self._tasks)[0]
        return chosen


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command ``python -m simwright.demonstrations``; returns its exit code."""
    from ._recording_command import main as command
    return command(arguments)


if __name__ == "__main__":
    sys.exit(main())
