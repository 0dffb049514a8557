"""Trains a policy on camera images by behaviour cloning, and measures it on unseen objects.

    PYTHONPATH=build/python python bench/python/visual_policy.py -o out/visual_policy
    PYTHONPATH=build/python python bench/python/visual_policy.py -o out/visual_policy --resume

It records demonstrations of the scripted expert, with a camera above the robot's shoulder and one at
the wrist, trains a small network and prints its success beside that of the shipped policy, which
sees the simulated state. The network sees both images, the robot's joints, gripper opening and tool
pose, and what to act on: the outline of the target in the first image of the shoulder, as a click on
a segmenter gives it (--goal outline), or the number in the instruction (--goal number). It predicts a chunk of poses of
the tool relative to the present one (--actions tool), as in Chi et al., "Universal Manipulation
Interface", RSS 2024, or of joints relative to the present ones (--actions joints), so that neither
inputs nor actions know the object's pose.

While recording, the expert is pushed off its way now and then, and the network learns how it
returns, but not the pushes: without them the network's own errors lead to states that no
demonstration shows (Laskey et al., "DART", CoRL 2017). While training, a linear layer also estimates
the simulated state from the network's features, which makes the features show where the object is;
the state is not used afterwards.

Each stage is resumed where it stopped: recording by blocks of 20 demonstrations, training by epoch,
measuring by episode. --minutes bounds the training.
"""

import argparse
import json
import math
import re
import time
from pathlib import Path

import numpy as np
import torch
from torch import nn

import simwright as sw
from simwright import cameras, demonstrations, envs

BLOCK = 20
# The arm arrives at a commanded pose about three steps later (at joints: one).
LEAD = 3
NUMBERS = 8
CAMERAS = ("shoulder", "wrist")
# Strides of the convolutions of a camera's network.
STRIDES = {"shoulder": (2, 2, 2, 1), "wrist": (2, 2, 1, 1)}


def body(joints, opening, tool):
    """Returns what the robot knows of itself (17): joints, opening, tool position and two axes."""
    parts = [joints, [opening], tool[:3, 3], tool[:3, 0], tool[:3, 2]]
    return np.concatenate(parts).astype(np.float32)


def rotation_vectors(rotations):
    """Returns axis times angle (..., 3), rad, of rotations (..., 3, 3) below half a turn."""
    angles = np.arccos(np.clip((np.trace(rotations, axis1=-2, axis2=-1) - 1) / 2, -1, 1))
    axes = np.stack([rotations[..., 2, 1] - rotations[..., 1, 2],
                     rotations[..., 0, 2] - rotations[..., 2, 0],
                     rotations[..., 1, 0] - rotations[..., 0, 1]], axis=-1)
    return axes * (angles / np.maximum(2 * np.sin(angles), 1e-9))[..., None]


def rotation(vector):
    """Returns the rotation matrix (3, 3) of a rotation vector (3), rad."""
    angle = np.linalg.norm(vector)
    x, y, z = vector / max(angle, 1e-12)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def tool_poses(bodies):
    """Returns positions (N, 3) and rotations (N, 3, 3) of the tool in `bodies` (N, 17)."""
    x, z = bodies[:, 11:14], bodies[:, 14:17]
    return bodies[:, 8:11], np.stack([x, np.cross(z, x), z], axis=-1)


def outline(segmentation, legend):
    """Returns the pixels (H, W) uint8 of the target: its link if it has one, else its object."""
    names = {number: name for number, name in legend.items() if number > 2}
    links = [number for number, name in names.items() if "/" in name]
    return np.isin(segmentation, links or list(names)).astype(np.uint8)


def number_of(instruction):
    """Returns the first number of the instruction, one-hot (NUMBERS)."""
    found = re.search(r"\d+", instruction)
    hot = np.zeros(NUMBERS, np.float32)
    hot[min(int(found.group()) if found else 0, NUMBERS - 1)] = 1.0
    return hot


class PushedExpert:
    """The scripted expert; a random action replaces its own in bursts of 0.1 to 0.4 s."""

    def __init__(self, share, seed):
        self._share = share
        self._rng = np.random.default_rng(seed)
        self._left = 0
        self.pushed = []  # by step of the present episode

    def __call__(self, env):
        action = env.expert_action()
        if env.state()["seconds"] == 0.0:
            self.pushed, self._left = [], 0
        if self._left == 0 and self._rng.random() < self._share:
            self._left = int(self._rng.integers(2, 9))
            direction = self._rng.normal(size=len(action) - 1)
            self._push = self._rng.uniform(0.2, 1.0) * direction / np.abs(direction).max()
        self.pushed.append(self._left > 0)
        if self._left > 0:
            self._left -= 1
            action[:-1] = self._push
        return action


def cameras_of(told):
    """Returns the cameras: the shoulder's sees the front of furniture, which "front" does not."""
    side = told.image_size * 3 // 2
    return [cameras.defaults(side, side)["shoulder"], "wrist"]


def record(told, folder):
    """Records the demonstrations that are missing; returns the paths of all blocks."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for block in range(-(-told.demos // BLOCK)):
        path = folder / f"block_{block:04d}.npz"
        paths.append(path)
        if path.exists():
            continue
        began = time.monotonic()
        count = min(BLOCK, told.demos - block * BLOCK)
        rows = {key: [] for key in (*CAMERAS, "bodies", "targets", "joints", "lengths",
                                    "outlines", "numbers", "states", "pushed")}
        expert = PushedExpert(told.pushes, [told.seed, block])
        for episode in demonstrations.record(
                told.skill, count, policy=expert, cameras=cameras_of(told), image_size=told.image_size, look=told.look,
                images=["rgb", "segmentation"], seed=told.seed + block, progress=False,
                **({"instances": told.instances} if told.instances else {})):
            for name in CAMERAS:
                rows[name].append(episode.images[name][:-1])
            rows["bodies"].append(np.stack([body(*one) for one in zip(
                episode.joints[:-1], episode.openings[:-1], episode.tools[:-1])]))
            rows["targets"].append(episode.targets.astype(np.float32))
            rows["joints"].append(episode.joints[:-1].astype(np.float32))
            rows["states"].append(episode.states[:-1])
            rows["pushed"].append(np.array(expert.pushed))
            rows["lengths"].append([len(episode)])
            first = episode.images["shoulder_segmentation"][:1]
            rows["outlines"].append(outline(first, episode.legend))
            rows["numbers"].append(number_of(episode.instruction)[None])
        partial = path.with_suffix(".partial.npz")
        np.savez(partial, **{key: np.concatenate(value) for key, value in rows.items()})
        partial.replace(path)
        print(f"recorded {block * BLOCK + count} of {told.demos} "
              f"({(time.monotonic() - began) / count:.1f} s each)", flush=True)
    return paths


class Demonstrations:
    """All frames in memory; `batch` makes inputs and chunks of actions of frame numbers."""

    def __init__(self, paths, told):
        loaded = [np.load(path) for path in paths]
        self._rows = {key: np.concatenate([one[key] for one in loaded]) for key in loaded[0].files}
        lengths = self._rows["lengths"]
        self.count = int(lengths.sum())
        ends = np.cumsum(lengths)
        self._episode = np.repeat(np.arange(len(lengths)), lengths)
        # Beyond the end of an episode, the last target repeats.
        last = ends[self._episode][:, None] - 1
        steps = np.arange(self.count)[:, None] + np.arange(told.chunk)
        if told.actions == "tool":
            targets = self._tool_targets(np.minimum(steps + LEAD, last))
        else:
            targets = self._rows["targets"][np.minimum(steps, last), :7]
            targets = targets - self._rows["joints"][:, None]
        gripper = self._rows["targets"][np.minimum(steps, last), 7:]
        self.motion_scale = torch.tensor(targets.std(axis=0) + 1e-4)
        self._targets = torch.tensor(np.concatenate([targets, gripper], axis=2))
        # A push until the target's step changes the target.
        lead = LEAD if told.actions == "tool" else 1
        until = np.minimum(np.arange(self.count)[:, None] + np.arange(told.chunk + lead), last)
        pushed = np.logical_or.accumulate(self._rows["pushed"][until], axis=1)[:, lead:]
        self._known = torch.tensor(~pushed, dtype=torch.float32)
        self._goal = told.goal
        states = self._rows["states"]
        self._states = torch.tensor((states - states.mean(axis=0)) / (states.std(axis=0) + 1e-3))
        self.state_size = states.shape[1]
        self.body_mean = torch.tensor(self._rows["bodies"].mean(axis=0))
        self.body_scale = torch.tensor(self._rows["bodies"].std(axis=0) + 1e-3)

    def _tool_targets(self, steps):
        """Returns the tool's poses at `steps` (N, chunk) in its frame at the row's step: position,
        m, and rotation vector, rad (N, chunk, 6)."""
        positions, rotations = tool_poses(self._rows["bodies"])
        now = rotations.transpose(0, 2, 1)[:, None]  # tool from base
        moved = now @ (positions[steps] - positions[:, None])[..., None]
        turned = rotation_vectors(now @ rotations[steps])
        return np.concatenate([moved[..., 0], turned], axis=2).astype(np.float32)

    def batch(self, frames):
        """Returns the inputs, the targets (N, chunk, M + 1), which of them are known (N, chunk), and
        the standardised states (N, O)."""
        episodes = self._episode[frames]
        images = [torch.from_numpy(self._rows[name][frames]) for name in CAMERAS]
        return (images, torch.from_numpy(self._rows["outlines"][episodes]),
                torch.from_numpy(self._rows["bodies"][frames]),
                torch.from_numpy(self._rows["numbers"][episodes])), self._targets[frames], \
            self._known[frames], self._states[frames]


class VisualPolicy(nn.Module):
    """A convolutional network for each camera, and a multilayer perceptron over all inputs."""

    def __init__(self, chunk, goal, state_size, motion_size):
        super().__init__()
        self.chunk, self.goal = chunk, goal
        self.eyes = nn.ModuleList(self._eye(3 + (goal == "outline" and name == CAMERAS[0]),
                                            STRIDES[name]) for name in CAMERAS)
        size = 2 * 3 * 48 + 17 + (NUMBERS if goal == "number" else 0)
        self.trunk = nn.Sequential(nn.Linear(size, 512), nn.ReLU(), nn.Dropout(0.1),
                                   nn.Linear(512, 512), nn.ReLU())
        self.head = nn.Linear(512, (motion_size + 1) * chunk)
        self.state = nn.Linear(512, state_size)
        for name, shape in (("body_mean", (17,)), ("body_scale", (17,)),
                            ("motion_scale", (chunk, motion_size))):
            self.register_buffer(name, torch.ones(shape))

    @staticmethod
    def _eye(channels, strides):
        layers = []
        for width, stride in zip((16, 32, 48, 48), strides):
            layers += [nn.Conv2d(channels, width, 3, stride, 1), nn.ReLU()]
            channels = width
        # Five times as fast on the processor as 32 and 64 channels with GroupNorm, channels first.
        return nn.Sequential(*layers).to(memory_format=torch.channels_last)

    @staticmethod
    def _points(features):
        """Returns each feature map's mean, and its mean position by softmax over its pixels
        (N, 3 C)."""
        features = features.contiguous()
        count, channels, height, width = features.shape
        weights = torch.softmax(features.flatten(2), dim=2).view(count, channels, height, width)
        rows = torch.linspace(-1, 1, height)
        columns = torch.linspace(-1, 1, width)
        return torch.cat([features.mean(dim=(2, 3)), (weights.sum(3) * rows).sum(2),
                          (weights.sum(2) * columns).sum(2)], dim=1)

    def forward(self, images, outlines, bodies, numbers, shift=0):
        """Returns a chunk of motions (N, chunk, M), relative to the present pose or joints, the logits
        that the gripper opens (N, chunk), and the estimated standardised state (N, O). ``shift``:
        pixels of random translation, while training."""
        parts = [(bodies - self.body_mean) / self.body_scale]
        for name, image, eye in zip(CAMERAS, images, self.eyes):
            pixels = image.permute(0, 3, 1, 2).float() / 255 - 0.5
            if self.training:  # other colours
                pixels = pixels * (0.8 + 0.4 * torch.rand(len(pixels), 3, 1, 1))
            if self.goal == "outline" and name == CAMERAS[0]:
                pixels = torch.cat([pixels, outlines[:, None].float()], dim=1)
            if shift:
                side = pixels.shape[-1]
                pixels = nn.functional.pad(pixels, [shift] * 4, mode="replicate")
                top, left = torch.randint(0, 2 * shift + 1, (2,)).tolist()
                pixels = pixels[:, :, top:top + side, left:left + side]
            pixels = pixels.contiguous(memory_format=torch.channels_last)
            parts.append(self._points(eye(pixels)))
        if self.goal == "number":
            parts.append(numbers)
        features = self.trunk(torch.cat(parts, dim=1))
        actions = self.head(features).view(len(features), self.chunk, -1)
        return actions[..., :-1] * self.motion_scale, actions[..., -1], self.state(features)


def train(told, data, path):
    """Trains until the epochs or minutes are used; continues from a checkpoint at `path`."""
    torch.manual_seed(told.seed)
    policy = VisualPolicy(told.chunk, told.goal, data.state_size, data.motion_scale.shape[1])
    for name in ("body_mean", "body_scale", "motion_scale"):
        getattr(policy, name).copy_(getattr(data, name))
    optimizer = torch.optim.AdamW(policy.parameters(), lr=1e-3, weight_decay=1e-4)
    state = {"epoch": 0, "seconds": 0.0}
    if path.exists():
        saved = torch.load(path, weights_only=True)
        policy.load_state_dict(saved["policy"])
        optimizer.load_state_dict(saved["optimizer"])
        state = saved["state"]
    began = time.monotonic() - state["seconds"]
    for epoch in range(state["epoch"], told.epochs):
        spent = time.monotonic() - began
        if spent > 60 * told.minutes:
            break
        # The rate falls as the epochs or the minutes are used, whichever are used first.
        share = max(epoch / told.epochs, spent / (60 * told.minutes))
        for group in optimizer.param_groups:
            group["lr"] = 1e-5 + 0.5 * (1e-3 - 1e-5) * (1 + math.cos(math.pi * share))
        torch.manual_seed(told.seed + epoch)
        order = np.random.default_rng([told.seed, epoch]).permutation(data.count)
        losses = []
        for start in range(0, data.count, told.batch):
            inputs, targets, known, states = data.batch(order[start:start + told.batch])
            motions, opens, estimated = policy(*inputs, shift=told.shift)
            errors = ((motions - targets[..., :-1]).abs() / policy.motion_scale).mean(dim=2)
            errors = errors + 0.2 * nn.functional.binary_cross_entropy_with_logits(
                opens, 0.5 * (targets[..., -1] + 1), reduction="none")
            loss = (errors * known).sum() / known.sum()
            state_loss = (estimated - states).abs().mean()
            optimizer.zero_grad()
            (loss + told.state_weight * state_loss).backward()
            nn.utils.clip_grad_norm_(policy.parameters(), 5.0)
            optimizer.step()
            losses.append([loss.item(), state_loss.item()])
        state = {"epoch": epoch + 1, "seconds": time.monotonic() - began}
        partial = path.with_suffix(".partial")
        torch.save({"policy": policy.state_dict(), "optimizer": optimizer.state_dict(),
                    "state": state}, partial)
        partial.replace(path)
        loss, state_loss = np.mean(losses, axis=0)
        print(f"epoch {epoch + 1} of {told.epochs}: loss {loss:.4f}, state {state_loss:.4f}, "
              f"{state['seconds'] / 60:.1f} min", flush=True)
    return policy.eval(), state


class _Sight:
    """Makes the network's inputs of an environment's observation."""

    def __init__(self, env, observation):
        self._env = env
        told = demonstrations.describe(env)
        first = observation["shoulder_segmentation"][None]
        self._outline = torch.from_numpy(outline(first, told["legend"]))
        self._number = torch.from_numpy(number_of(told["instructions"][0])[None])
        self._base_from_world = np.linalg.inv(told["base"])

    def __call__(self, observation):
        state = self._env.state()
        tool = self._base_from_world @ state["gripper_pose"]
        images = [torch.from_numpy(observation[name][None]) for name in CAMERAS]
        own = body(state["robot_joints"], state["gripper_opening"], tool)
        return (images, self._outline, torch.from_numpy(own[None]), self._number), \
            state["robot_joints"], tool


def action_of(pose, opens):
    """Returns the action in the space "absolute" of a pose (4, 4) of the tool in the robot's base
    (docs/python.md)."""
    front = np.diag([1.0, -1.0, -1.0])
    turn = rotation_vectors(front.T @ pose[:3, :3]) / np.pi
    return np.concatenate([front.T @ (pose[:3, 3] - [0.5, 0.0, 0.3]) / 0.5, turn, [opens]])


def run(env, observation, policy, execute):
    """Runs an episode; returns whether it succeeded."""
    sight = _Sight(env, observation)
    lower, upper = np.array([limits for _, *limits in env.task.arm_joints]).T
    while True:
        inputs, joints, tool = sight(observation)
        with torch.inference_mode():
            motions, opens, _ = policy(*inputs)
        for motion, open_share in zip(motions[0, :execute].double().numpy(),
                                      torch.tanh(0.5 * opens[0]).double().numpy()):
            if len(motion) == 6:
                pose = np.eye(4)
                pose[:3, :3], pose[:3, 3] = rotation(motion[3:]), motion[:3]
                action = action_of(tool @ pose, open_share)
            else:
                action = np.append((2 * (joints + motion) - lower - upper) / (upper - lower),
                                   open_share)
            observation, _, terminated, truncated, info = env.step(
                np.clip(action, -1, 1).astype(np.float32))
            if terminated or truncated:
                return bool(info["is_success"])


def measure(told, policy, path):
    """Returns the successes of the episodes, continued from those in `path`."""
    results = json.loads(path.read_text()) if path.exists() else []
    env = envs.SkillEnv(cell=told.skill, split="unseen",
                        action_space="absolute" if told.actions == "tool" else "joint_targets",
                        cameras=cameras_of(told), image_size=told.image_size, look=told.look,
                        images=["rgb", "segmentation"])
    observation, _ = env.reset(seed=told.seed)
    for episode in range(told.episodes):
        if episode >= len(results):
            results.append(run(env, observation, policy, told.execute))
            path.write_text(json.dumps(results))
        observation, _ = env.reset()
    return results[:told.episodes]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0],
                                     formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    add = parser.add_argument
    add("-o", "--output", type=Path, required=True, help="folder of demonstrations and checkpoints")
    add("--resume", action="store_true", help="continues in a folder that exists")
    add("--skill", default="open_drawer", help="a skill of the Panda")
    add("--demos", type=int, default=200, help="number of demonstrations")
    add("--instances", type=int, default=None, help="of the objects; default: the skill's")
    add("--image-size", type=int, default=64, help="pixels a side at the wrist; the shoulder's are larger")
    add("--look", choices=["wide"], default=None, help="randomises looks")
    add("--goal", choices=["outline", "number"], default="outline", help="what to act on")
    add("--pushes", type=float, default=0.02, help="probability that a push starts at a step")
    add("--state-weight", type=float, default=0.5, help="of the estimated state in the loss")
    add("--shift", type=int, default=2, help="of images in training, pixels at most")
    add("--actions", choices=["tool", "joints"], default="tool", help="what the network predicts")
    add("--chunk", type=int, default=8, help="actions predicted at once, 0.05 s each")
    add("--execute", type=int, default=4, help="of them that are executed")
    add("--epochs", type=int, default=140, help="at most")
    add("--minutes", type=float, default=60.0, help="of training, at most")
    add("--batch", type=int, default=64, help="frames")
    add("--episodes", type=int, default=100, help="of the measurement")
    add("--threads", type=int, default=2, help="of the training")
    add("--seed", type=int, default=1, help="of all stages")
    told = parser.parse_args()
    if told.output.exists() and not told.resume:
        parser.error(f"{told.output} exists (give --resume, or another folder)")
    torch.set_num_threads(told.threads)
    data = Demonstrations(record(told, told.output / "demonstrations"), told)
    policy, state = train(told, data, told.output / "policy.pt")
    results = measure(told, policy, told.output / f"episodes_{state['epoch']}.json")
    shipped = sw.skills.evaluate(told.skill, told.episodes, seed=told.seed, progress=False)
    low, high = sw.skills.wilson_interval(sum(results), len(results))
    print(f"{told.skill}: {told.demos} demonstrations, {data.count} frames, {state['epoch']} "
          f"epochs, {state['seconds'] / 60:.1f} min of training")
    print(f"images: {sum(results)} of {len(results)} unseen episodes, 95 % {low:.2f} to {high:.2f}")
    print(f"state:  {shipped['successes']} of {shipped['episodes']}, 95 % "
          f"{shipped['interval'][0]:.2f} to {shipped['interval'][1]:.2f} (shipped policy)")
    (told.output / "result.json").write_text(json.dumps({
        "images": {"successes": sum(results), "episodes": len(results), "interval": [low, high]},
        "state": {"successes": shipped["successes"], "episodes": shipped["episodes"],
                  "interval": list(shipped["interval"])},
        "training": state, "demonstrations": told.demos, "frames": data.count}, indent=1))


if __name__ == "__main__":
    main()
