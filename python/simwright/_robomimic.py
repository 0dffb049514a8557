"""robomimic's HDF5 data sets, with images."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Iterable, Sequence

import numpy as np

from . import _core
from ._output import Totals, need, placed

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ._types import FloatArray, Float32Array, Path, RecordedActions, WrittenTotals
    from .demonstrations import Episode

# robomimic drops an incomplete batch of the mask "valid"; this is its default batch.
_BATCH_STEPS = 100


def xyzw(rotations: ArrayLike) -> FloatArray:
    """Returns the quaternions (N, 4) of rotation matrices (N, 3, 3), x y z w, with w >= 0."""
    matrices = np.asarray(rotations, dtype=np.float64)
    # Bar-Itzhack 2000: the eigenvector of the largest eigenvalue, for any rotation.
    m = np.moveaxis(matrices, 0, -1)
    rows = np.zeros((4, 4, matrices.shape[0]))
    rows[0, 0], rows[1, 1], rows[2, 2] = (m[0, 0] - m[1, 1] - m[2, 2], m[1, 1] - m[0, 0] - m[2, 2],
                                          m[2, 2] - m[0, 0] - m[1, 1])
    rows[3, 3] = m[0, 0] + m[1, 1] + m[2, 2]
    pairs = {(0, 1): m[0, 1] + m[1, 0], (0, 2): m[0, 2] + m[2, 0], (1, 2): m[1, 2] + m[2, 1],
             (0, 3): m[2, 1] - m[1, 2], (1, 3): m[0, 2] - m[2, 0], (2, 3): m[1, 0] - m[0, 1]}
    for (row, column), value in pairs.items():
        rows[row, column] = rows[column, row] = value
    vectors = np.linalg.eigh(np.moveaxis(rows, -1, 0))[1][:, :, -1]
    return np.where(vectors[:, 3:] < 0.0, -vectors, vectors)


def write_robomimic(path: Path, episodes: Iterable[Episode],
                    actions: RecordedActions = "joint_targets",
                    valid_share: float = 0.1) -> WrittenTotals:
    """Writes demonstrations as robomimic's HDF5.

    Args:
        path (path): of the file; an existing one is replaced.
        episodes: iterable of Episode with equal cameras and robots.
        actions (str): "joint_targets", the commanded joints, or "policy", the policy's own actions.
        valid_share (float): share of demonstrations in the mask "valid".

    Returns:
        dict: ``path``, ``episodes``, ``steps``, ``successes``.

    Raises:
        Error: where h5py is missing, there is no episode, or the file cannot be written.
    """
    h5py = need("h5py", "robomimic")
    if not 0.0 < valid_share <= 0.5:
        raise _core.Error(f"valid_share: is {valid_share} (give a share above 0, at most 0.5)")
    totals = Totals(path)
    lengths: list[int] = []
    successes: list[bool] = []
    starts = None
    with placed(path, True) as partial:
        with h5py.File(partial, "w") as file:
            data = file.create_group("data")
            for episode in episodes:
                chosen = episode.chosen_actions(actions)
                described = _described(episode, chosen[0])
                if starts is None:
                    starts = described
                    data.attrs["env_args"] = json.dumps(_env_args(episode, chosen[0]))
                elif described != starts:
                    raise _core.Error(f"{path}: episode {totals.episodes} has other observations "
                                      "than the first one (record them with equal settings)")
                _write_demo(data.create_group(f"demo_{totals.episodes}"), episode, chosen[1])
                lengths.append(len(episode))
                successes.append(episode.success)
                totals.add(episode)
            data.attrs["total"] = totals.steps
            report = totals.report()
            _write_masks(h5py, file, lengths, successes, valid_share)
    return report


def _described(episode: Episode, action_space: str) -> tuple[Any, ...]:
    """Returns what all episodes of a file share."""
    return (action_space, episode.robot, episode.skill, episode.states.shape[1:],
            {name: images.shape[1:] for name, images in episode.images.items()})


def _env_args(episode: Episode, action_space: str) -> dict[str, Any]:
    title = "".join(word.capitalize() for word in episode.skill.split("_"))
    known = [entry["name"] for entry in _core.cells() + _core.long_tasks()]
    name = title if episode.skill in known else "Task"
    return {"env_name": f"simwright/{name}-v0", "type": 2, "env_version": _core.__version__,
            "env_kwargs": {"robot": episode.robot, "action_space": action_space,
                           "cameras": list(episode.intrinsics)}}


def _observations(episode: Episode) -> dict[str, NDArray[Any]]:
    """Returns the observations by key, of T + 1 rows."""
    count = len(episode) + 1
    fingers = np.repeat(0.5 * episode.openings[:, None], 2, axis=1)
    subtasks = np.zeros((count, len(episode.instructions)), np.float32)
    subtasks[np.arange(count), episode.subtasks] = 1.0
    found: dict[str, NDArray[Any]] = {
        "robot0_joint_pos": episode.joints.astype(np.float32),
        "robot0_eef_pos": episode.tools[:, :3, 3].astype(np.float32),
        "robot0_eef_quat": xyzw(episode.tools[:, :3, :3]).astype(np.float32),
        "robot0_gripper_qpos": fingers.astype(np.float32),
        "policy": episode.states, "subtask": subtasks}
    for name, images in episode.images.items():
        image = name if name.endswith(("_depth", "_segmentation")) else f"{name}_image"
        found[image] = images[..., None] if images.ndim == 3 else images
    return found


def _states(episode: Episode) -> FloatArray:
    """Returns the simulated states (T, D): subtask, joints, opening, and for each object its
    position, quaternion (x y z w), world, and joints."""
    parts = [episode.subtasks[:, None], episode.joints, episode.openings[:, None]]
    for entry in episode.objects.values():
        parts += [entry["poses"][:, :3, 3], xyzw(entry["poses"][:, :3, :3]), entry["joints"]]
    return np.concatenate(parts, axis=1)[:-1]


def _write_demo(group: Any, episode: Episode, actions: Float32Array) -> None:
    group.attrs["num_samples"] = len(episode)
    group.attrs["task"] = episode.task
    group.attrs["instruction"] = episode.instruction
    group.attrs["success"] = episode.success
    group.attrs["seed"], group.attrs["index"] = episode.seed, episode.index
    group.create_dataset("actions", data=actions)
    group.create_dataset("policy_actions", data=episode.actions)
    group.create_dataset("states", data=_states(episode))
    group.create_dataset("rewards", data=episode.rewards)
    group.create_dataset("dones", data=episode.dones.astype(np.uint8))
    for key, values in _observations(episode).items():
        # Images are packed: a step is read at a time.
        packed = dict(compression="gzip", compression_opts=4,
                      chunks=(1,) + values.shape[1:]) if values.ndim > 2 else {}
        group.create_dataset(f"obs/{key}", data=values[:-1], **packed)
        group.create_dataset(f"next_obs/{key}", data=values[1:], **packed)


def _write_masks(h5py: Any, file: Any, lengths: Sequence[int], successes: Sequence[bool],
                 share: float) -> None:
    count = len(lengths)
    wanted = max(1, round(share * count))
    step = max(1, count // wanted)
    order = list(range(count - 1, -1, -step))[:wanted]
    order += [index for index in range(count - 1, -1, -1) if index not in order]
    valid: set[int] = set()
    for index in order:
        enough = len(valid) >= wanted and sum(lengths[i] for i in valid) >= _BATCH_STEPS
        if enough or len(valid) >= count // 2:
            break
        valid.add(index)
    masks = {"train": [i for i in range(count) if i not in valid], "valid": sorted(valid),
             "success": [i for i in range(count) if successes[i]],
             "failure": [i for i in range(count) if not successes[i]]}
    for name, members in masks.items():
        if members:
            names = np.array([f"demo_{index}" for index in members], dtype="S")
            file.create_dataset(f"mask/{name}", data=names)
