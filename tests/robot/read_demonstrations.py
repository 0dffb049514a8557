"""Reads a robomimic file as robomimic does, with h5py alone, prints what is in it, and writes one
of its own beside it."""
import json
import sys

import h5py
import numpy

with h5py.File(sys.argv[1], "r") as file:
    data = file["data"]
    env = json.loads(data.attrs["env_args"])
    print("env", env["env_name"], env["type"], env["env_kwargs"]["horizon"])
    print("total", int(data.attrs["total"]), len(data))
    for name in sorted(data, key=lambda text: int(text[5:])):
        demo = data[name]
        n = int(demo.attrs["num_samples"])
        assert demo["rewards"].shape == demo["dones"].shape == (n,)
        assert demo["actions"].dtype == numpy.float64 and demo["obs/eye"].dtype == numpy.uint8
        assert numpy.abs(demo["actions"][()]).max() <= 1.0
        print(name, n, *(value.hex() for value in demo["actions"][()].ravel().tolist()),
              *(value.hex() for value in demo["states"][-1].tolist()),
              *(value.hex() for value in demo["rewards"][()].tolist()),
              *demo["dones"][()].tolist(), *demo["obs/pose"].shape,
              demo["next_obs/pose"][n - 1, 2].item().hex(), *demo["obs/eye"].shape,
              demo["obs/eye"][0].sum())
    for key in sorted(file["mask"]):
        # robomimic's own line for a filter.
        print(key, *[element.decode("utf-8") for element in numpy.array(file["mask"][key][:])])

with h5py.File(sys.argv[2], "w") as file:
    data = file.create_group("data")
    for i in (0, 2, 10):
        demo = data.create_group(f"demo_{i}")
        demo.attrs["num_samples"] = 4
        demo.create_dataset("actions", data=numpy.full((4, 2), i / 16))
        demo.create_dataset("states", data=numpy.arange(12.0).reshape(4, 3))
        demo.create_dataset("rewards", data=numpy.arange(4, dtype=numpy.float32))
        demo.create_dataset("dones", data=numpy.array([0, 0, 0, 1]))
        demo.create_dataset("obs/pose", data=numpy.ones((4, 3)), compression="gzip")
    data.attrs["total"] = 12
    data.attrs["env_args"] = json.dumps({"env_name": "Lift", "type": 1, "env_kwargs": {}})
    file["mask/valid"] = numpy.array(["demo_10", "demo_2"], dtype="S")
    file["mask/text"] = numpy.array(["demo_0"], dtype=h5py.string_dtype())
