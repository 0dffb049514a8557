"""Reads an exported file as robomimic does, with h5py alone, and holds it against robomimic's schema.
Prints episodes, then of each the steps and where the thing ends as the robot sees it."""
import json
import sys

import h5py
import numpy

with h5py.File(sys.argv[1], "r") as file:
    data = file["data"]
    env = json.loads(data.attrs["env_args"])
    kwargs = env["env_kwargs"]
    assert env["type"] == 2 and env["env_name"].startswith("simwright/")
    episodes = [json.loads(note) for note in file["simwright/notes"][:]]
    assert len(episodes) == len(data) and "episodes" not in kwargs
    assert len(data.attrs["env_args"]) < 4096  # robomimic's tools print it whole
    names = [f"demo_{i}" for i in range(len(data))]
    assert sorted(names) == sorted(data)
    total = 0
    print("demos", len(data))
    for name, episode in zip(names, episodes):
        demo = data[name]
        n = int(demo.attrs["num_samples"])
        total += n
        assert sum(episode["steps"]) == n and len(episode["starts"]) == len(kwargs["subtasks"])
        assert demo["actions"].shape == (n, 7) and numpy.abs(demo["actions"][()]).max() <= 1.0
        assert demo["rewards"].shape == demo["dones"].shape == (n,)
        assert demo["dones"][()].tolist() == [0] * (n - 1) + [1]
        assert demo["states"].shape[0] == n
        assert sorted(demo["obs"]) == sorted(demo["next_obs"])
        border = set(numpy.cumsum(episode["steps"]) - 1)
        inner = [i for i in range(n - 1) if i not in border]
        for key in demo["obs"]:
            now, after = demo["obs"][key][()], demo["next_obs"][key][()]
            assert now.shape == after.shape and now.shape[0] == n and now.dtype == numpy.float32
            assert numpy.isfinite(now).all() and numpy.isfinite(after).all()
            # What is seen after one step is what is seen before the next.
            assert (after[inner] == now[[i + 1 for i in inner]]).all(), key
        assert (demo["obs/subtask"][()].sum(axis=1) == 1).all()
        turn = demo["obs/robot0_eef_quat"][()]
        assert numpy.abs(numpy.linalg.norm(turn, axis=1) - 1).max() < 1e-5
        print(name, n, *demo["next_obs/object"][n - 1, :3].tolist())
    assert int(data.attrs["total"]) == total
    train = {name.decode() for name in file["mask/train"][:]}
    valid = {name.decode() for name in file["mask/valid"][:]}
    assert train and valid and not train & valid and train | valid == set(names)
    # A batch of robomimic's defaults, of which its loader drops what is less, or half of all.
    steps = sum(int(data[name].attrs["num_samples"]) for name in valid)
    assert steps >= 100 or 2 * (len(valid) + 1) > len(names), steps
