"""Reads files of grasps as ACRONYM's tools and Isaac's readers do, and prints the first grasp.

Usage: read_grasps.py FILE.h5 FILE.yaml
"""
import sys

import h5py
import numpy as np
import yaml

with h5py.File(sys.argv[1], "r") as data:
    name = data["object/file"][()]
    name = name if isinstance(name, str) else name.decode("utf-8")
    scale = float(data["object/scale"][()])
    mass = float(data["object/mass"][()])
    transforms = np.array(data["grasps/transforms"])
    success = np.array(data["grasps/qualities/flex/object_in_gripper"])
    assert transforms.shape == (len(success), 4, 4), transforms.shape
    print("acronym", name, scale, mass, len(success), int(success.sum()), *transforms[0].ravel())

with open(sys.argv[2]) as file:
    grasps = yaml.safe_load(file)
assert grasps["format"] == "isaac_grasp" and grasps["format_version"] == 1.0
one = grasps["grasps"]["grasp_0"]
print("isaac", len(grasps["grasps"]), one["confidence"], *one["position"], one["orientation"]["w"],
      *one["orientation"]["xyz"], *one["cspace_position"].values(),
      *one["pregrasp_cspace_position"].values())
