"""LeRobotDataset v3, written by the package lerobot."""

from __future__ import annotations

import contextlib
import copy
import importlib
import os
import shutil
import warnings
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, Iterable, Iterator

import numpy as np

from . import _core
from ._output import Totals, need, placed

if TYPE_CHECKING:
    from ._types import ImageArray, Path, RecordedActions, WrittenTotals
    from .demonstrations import Episode

_FRAMES_PER_SECOND = 20


def write_lerobot(root: Path, episodes: Iterable[Episode],
                  repo_id: str = "simwright/demonstrations", fps: int = _FRAMES_PER_SECOND,
                  videos: bool = True, actions: RecordedActions = "joint_targets",
                  ) -> WrittenTotals:
    """Writes demonstrations as a LeRobotDataset.

    Args:
        root (path): the folder; it must not exist.
        episodes: iterable of Episode with equal cameras and robots.
        repo_id (str): the data set's name; nothing is uploaded.
        fps (int): 20, as recorded.
        videos (bool): images as videos; False: as PNG within the tables.
        actions (str): "joint_targets", the commanded joints in rad and the gripper's command, or
            "policy", the policy's own actions.

    Returns:
        dict: ``path``, ``episodes``, ``steps``, ``successes``.

    Raises:
        Error: where lerobot is missing, there is no episode, or the folder exists.
    """
    module = need("lerobot.datasets.lerobot_dataset", "lerobot")
    if fps != _FRAMES_PER_SECOND:
        raise _core.Error(f"fps: is {fps} (the episodes have 20 frames per second)")
    totals = Totals(root)
    with placed(root, False) as partial, _quiet():
        dataset = None
        try:
            for episode in episodes:
                told = _features(episode, actions, videos)
                if dataset is None:
                    described = told
                    # The package changes the features that it is given.
                    dataset = module.LeRobotDataset.create(
                        repo_id=repo_id, fps=fps, features=copy.deepcopy(told), root=partial,
                        robot_type=episode.robot, use_videos=videos,
                        image_writer_threads=2 if episode.images else 0)
                elif told != described:
                    raise _core.Error(f"{root}: episode {totals.episodes} has other features than "
                                      "the first one (record them with equal settings)")
                for frame in _frames(episode, actions):
                    dataset.add_frame(frame)
                dataset.save_episode()
                totals.add(episode)
            report = totals.report()
        finally:
            if dataset is not None:
                dataset.finalize()
                _stop_threads(dataset)
        _remove_empty(partial / "images")
    return report


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Leaves out what the encoder, the tables' bars and numpy's notice about labels print."""
    datasets = importlib.import_module("datasets")
    shown = not datasets.are_progress_bars_disabled()
    os.environ.setdefault("SVT_LOG", "1")  # errors alone
    datasets.disable_progress_bars()
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "Converting input from bool", RuntimeWarning)
            yield
    finally:
        if shown:
            datasets.enable_progress_bars()


def _remove_empty(folder: FilePath) -> None:
    """Removes a folder without files: the encoder leaves those of the images that it has read."""
    if folder.is_dir() and not any(path.is_file() for path in folder.rglob("*")):
        shutil.rmtree(folder)


def _stop_threads(dataset: Any) -> None:
    """Ends the threads that write images, which would write into a folder that is removed."""
    stop = getattr(dataset, "stop_image_writer", None)
    writer = getattr(dataset, "writer", None)
    stop = stop or getattr(writer, "stop_image_writer", None)
    if stop is not None:
        stop()


def _pictures(episode: Episode) -> dict[str, ImageArray]:
    """Returns the colour images by camera; the format has no other kinds."""
    return {name: images for name, images in episode.images.items() if images.ndim == 4
            and images.dtype == np.uint8}


def _features(episode: Episode, actions: RecordedActions, videos: bool) -> dict[str, Any]:
    def numbers(size: int, names: list[str] | None) -> dict[str, Any]:
        return {"dtype": "float32", "shape": (size,), "names": names}

    joints = list(episode.joint_names)
    size = episode.actions.shape[1]
    observed = [f"policy_{i}" for i in range(episode.states.shape[1])]
    acted = [f"action_{i}" for i in range(size)]
    features = {
        "observation.state": numbers(len(joints) + 1, joints + ["gripper_opening"]),
        "observation.environment_state": numbers(len(observed), observed),
        "policy_action": numbers(size, acted),
        "action": numbers(len(joints) + 1, joints + ["gripper"]) if actions == "joint_targets"
        else numbers(size, acted),
        "next.reward": numbers(1, None),
        "next.done": {"dtype": "bool", "shape": (1,), "names": None},
        "next.success": {"dtype": "bool", "shape": (1,), "names": None},
        "episode_success": {"dtype": "bool", "shape": (1,), "names": None},
    }
    for name, images in _pictures(episode).items():
        features[f"observation.images.{name}"] = {
            "dtype": "video" if videos else "image", "shape": images.shape[1:],
            "names": ["height", "width", "channels"]}
    return features


def _frames(episode: Episode, actions: RecordedActions) -> Iterator[dict[str, Any]]:
    """Yields the T frames of an episode."""
    pictures = _pictures(episode)
    own = np.concatenate([episode.joints, episode.openings[:, None]], axis=1).astype(np.float32)
    chosen = (episode.targets if actions == "joint_targets"
              else episode.chosen_actions(actions)[1]).astype(np.float32)
    for step in range(len(episode)):
        frame = {
            "observation.state": own[step],
            "observation.environment_state": episode.states[step],
            "policy_action": episode.actions[step],
            "action": chosen[step],
            "next.reward": episode.rewards[step:step + 1],
            "next.done": episode.dones[step:step + 1],
            "next.success": episode.goals[step:step + 1],
            "episode_success": np.array([episode.success]),
            "task": episode.instructions[int(episode.subtasks[step])],
        }
        for name, images in pictures.items():
            frame[f"observation.images.{name}"] = images[step]
        yield frame
