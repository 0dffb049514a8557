"""Runs reward programs as Python does, for the test that compares ours with it.

run_corpus.py FOLDER [--speed N REPEATS]: reads FOLDER/manifest.txt (a program a block: its file, how
to call it, and the numbers that it reads) and writes FOLDER/results.txt. Nothing here comes from the
interpreter under test: functions of the environment and rotations are written out anew.
"""
import inspect
import math
import sys

import numpy as np
import torch

torch.set_num_threads(1)
torch.jit.script = lambda function: function  # it wants source files

NAMES = {
    "link_position": ["get_pose_by_link_name", "get_position_by_asset_link_name",
                      "get_center_by_asset_link_name", "get_link_position", "get_link_state"],
    "link_orientation": ["get_orientation_by_link_name"],
    "link_linear_velocity": ["get_linear_velocity_by_link_name"],
    "link_angular_velocity": ["get_angular_velocity_by_link_name"],
    "link_bounding_box": ["get_bounding_box_link"],
    "asset_position": ["get_position"],
    "asset_orientation": ["get_orientation"],
    "asset_linear_velocity": ["get_linear_velocity"],
    "asset_angular_velocity": ["get_angular_velocity"],
    "asset_bounding_box": ["get_bounding_box"],
    "gripper_position": ["get_robot_gripper_pose", "get_robot_gripper_position"],
    "gripper_orientation": ["get_robot_gripper_orientation"],
    "gripper_linear_velocity": ["get_robot_gripper_velocity"],
    "gripper_angular_velocity": ["get_robot_gripper_angular_velocity"],
    "gripper_opening": ["get_robot_gripper_opening"],
    "gripper_contact": ["get_robot_gripper_contact"],
    "grasped": ["check_grasped", "is_grasped"],
    "joint_state": ["get_state_by_joint_name", "get_state_by_asset_joint_name", "get_joint_state"],
    "joint_velocity": ["get_velocity_by_joint_name"],
    "goal_position": ["get_goal_pose", "get_goal_position"],
}
FLAGS = {"gripper_contact", "grasped"}
LIMITS = {("microwave", "joint_0"): (0.25, 1.5), ("microwave", "joint_1"): (-0.125, 0.375)}


class Environment:
    """The environment as all its rows, or (row given) as one environment with numpy values."""

    def __init__(self, slots, count, row=None):
        self.slots, self.row = slots, row
        self.env_num = self.num_envs = count
        self.device = "cpu"
        self.env = self

    def read(self, kind, asset="", part=""):
        key = (kind, asset, part)
        if key not in self.slots:  # read by the program, of no weight in its result
            key = next(k for k in self.slots if k[0] == kind) if any(
                k[0] == kind for k in self.slots) else None
        value = self.slots[key] if key else torch.zeros(self.num_envs, 4 if "orient" in kind else 3)
        if kind in FLAGS:
            value = value > 0.5
        if self.row is None:
            return value.clone()
        one = value[self.row].numpy()
        return one.copy() if one.ndim else one.item()

    def box(self, value):
        return value[..., 0:3], value[..., 3:6]

    def get_bounding_box(self, asset):
        return self.box(self.read("asset_bounding_box", asset))

    def get_bounding_box_link(self, asset, link):
        return self.box(self.read("link_bounding_box", asset, link))

    def get_eef_pos(self):
        return self.read("gripper_position"), self.read("gripper_orientation")

    def get_limits_by_joint_name(self, asset, joint):
        return dict(zip(("lower", "upper"), LIMITS[asset, joint]))

    get_joint_limits = get_limits_by_joint_name

    def get_joint_limit(self, asset, joint):
        return LIMITS[asset, joint]

    def get_joint_upper_limit(self, asset, joint):
        return LIMITS[asset, joint][1]

    def get_joint_lower_limit(self, asset, joint):
        return LIMITS[asset, joint][0]

    def in_bbox(self, point, low, high):
        inside = (low <= point) & (point <= high)
        return inside.all(-1)

    def get_distance(self, a, b):
        return ((a - b) ** 2).sum(-1) ** 0.5


def add_reader(kind, name):
    def read(self, asset_name="", part_name=""):
        return self.read(kind, asset_name, part_name)
    if not hasattr(Environment, name):
        setattr(Environment, name, read)


for kind, names in NAMES.items():
    for name in names:
        add_reader(kind, name)


def as_helper(name):
    return lambda simulator, *arguments: getattr(simulator, name)(*arguments)


def matrix_of(q):
    """Rotation matrices [N, 3, 3] of unit quaternions xyzw, from how they turn the axes."""
    x, y, z, w = q.unbind(-1)
    rows = [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),
            2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
            2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]
    return torch.stack(rows, dim=-1).reshape(*q.shape[:-1], 3, 3)


def quat_rotate(q, v):
    return (matrix_of(q) @ v.unsqueeze(-1)).squeeze(-1)


def quat_rotate_inverse(q, v):
    return (matrix_of(q).transpose(-1, -2) @ v.unsqueeze(-1)).squeeze(-1)


def quat_mul(a, b):
    """The matrix of left multiplication by a, times b."""
    x, y, z, w = a.unbind(-1)
    left = torch.stack([w, -z, y, x, z, w, -x, y, -y, x, w, z, -x, -y, -z, w], dim=-1)
    return (left.reshape(*a.shape[:-1], 4, 4) @ b.unsqueeze(-1)).squeeze(-1)


def quat_conjugate(q):
    return q * torch.tensor([-1.0, -1.0, -1.0, 1.0])


def quat_diff_rad(a, b):
    cosine = (a * b).sum(-1).abs().double()
    return (2 * torch.acos(cosine.clamp(max=1.0))).float()


def quat_axis(q, axis=0):
    return matrix_of(q)[..., :, axis]


def normalize(x, eps=1e-9):
    return x / x.norm(p=2, dim=-1).clamp(min=eps).unsqueeze(-1)


def normalize_angle(x):
    return x - 2 * math.pi * torch.round(x / (2 * math.pi))


def quat_from_angle_axis(angle, axis):
    half = (angle / 2).unsqueeze(-1)
    return torch.cat([normalize(axis) * torch.sin(half), torch.cos(half)], dim=-1)


def get_euler_xyz(q):
    m = matrix_of(q)
    roll = torch.atan2(m[..., 2, 1], m[..., 2, 2])
    pitch = torch.asin(-m[..., 2, 0].clamp(-1, 1))
    yaw = torch.atan2(m[..., 1, 0], m[..., 0, 0])
    return tuple(angle % (2 * math.pi) for angle in (roll, pitch, yaw))


def namespace():
    names = {"torch": torch, "np": np, "math": math, "Tensor": torch.Tensor,
             "F": torch.nn.functional}
    for function in (quat_rotate, quat_rotate_inverse, quat_mul, quat_conjugate, quat_diff_rad,
                     quat_axis, normalize, normalize_angle, quat_from_angle_axis, get_euler_xyz):
        names[function.__name__] = function
    names["quat_unit"], names["quat_apply"] = normalize, quat_rotate
    helpers = [n for group in NAMES.values() for n in group]
    helpers += ["get_bounding_box", "get_bounding_box_link", "get_eef_pos", "get_joint_limit",
                "in_bbox"]
    for name in helpers:
        names[name] = as_helper(name)
    return names


def read_programs(path):
    """Blocks of the manifest: 'program FILE ENTRY MODE N', then 'slot KIND ASSET PART
    shared|flags|numbers SHAPE NUMBERS' with '-' for what is empty; what is shared is one number."""
    programs = []
    for line in open(path):
        words = line.split()
        if words[0] == "program":
            programs.append({"file": words[1], "entry": words[2], "mode": words[3],
                             "count": int(words[4]), "slots": {}, "parameters": {}})
            continue
        program = programs[-1]
        kind, asset, part = (word if word != "-" else "" for word in words[1:4])
        values = torch.tensor([float(w) for w in words[6:]], dtype=torch.float32)
        if words[4] == "shared":
            value = values[0].item()
        else:
            sizes = [int(s) for s in words[5].split(",")] if words[5] != "-" else []
            value = values.reshape(program["count"], *sizes)
            value = value > 0.5 if words[4] == "flags" else value
        if kind == "parameter":
            program["parameters"][part] = value
        else:
            program["slots"][kind, asset, part] = value
    return programs


def load(program):
    source = open(program["file"]).read().replace("from isaacgymenvs.utils.torch_jit_utils import *", "")
    names = namespace()
    exec(compile(source, program["file"], "exec"), names)
    return names[program["entry"]]


def call(program, function, row=None):
    environment = Environment(program["slots"], program["count"], row)
    arguments = []
    for name, parameter in inspect.signature(function).parameters.items():
        if name in ("env", "self"):
            arguments.append(environment)
        elif name not in program["parameters"]:
            break  # it and those after it have defaults
        else:
            value = program["parameters"][name]
            if row is not None and torch.is_tensor(value):
                value = value[row].numpy()
            value = value.clone() if torch.is_tensor(value) else value
            arguments.append(int(value) if parameter.annotation is int else value)
    return function(*arguments)


def numbers(value, count):
    value = torch.as_tensor(value).detach().double()
    rows = value.reshape(count, -1) if value.numel() % count == 0 and value.dim() else \
        value.reshape(1, -1).expand(count, -1)
    return " ".join(repr(v) for v in rows.flatten().tolist())


def run(program, out):
    function = load(program)
    count = program["count"]
    if program["mode"] == "each":
        results = [call(program, function, row) for row in range(count)]
        if isinstance(results[0], tuple):
            result = tuple(torch.tensor([float(r[i]) for r in results]) for i in range(2))
        else:
            result = torch.tensor([float(r) for r in results])
    else:
        result = call(program, function)
    reward, extra = result if isinstance(result, tuple) else (result, None)
    out.write(f"program {program['file']}\nreward {numbers(reward, count)}\n")
    if isinstance(extra, dict):
        for key, value in extra.items():
            key = key.replace(" ", "~")
            out.write(f"component:{key} {numbers(value, count)}\n")
    elif extra is not None:
        out.write(f"success {numbers(extra, count)}\n")


def main():
    folder = sys.argv[1]
    with open(f"{folder}/results.txt", "w") as out, np.errstate(all="ignore"):
        for program in read_programs(f"{folder}/manifest.txt"):
            run(program, out)


if __name__ == "__main__":
    main()
