"""Trains a policy on camera images by behaviour cloning, and measures it on unseen objects.

    PYTHONPATH=build/python python bench/python/visual_policy.py -o out/visual_policy
    PYTHONPATH=build/python python bench/python/visual_policy.py -o out/visual_policy --resume

It records demonstrations of the scripted expert, trains a small network, and prints its success
beside that of the shipped policy, which sees the simulated state. Before the motion, the network is
told what to act on: the outline of the target in a depth image of the camera "shoulder", as a click
on a segmenter gives it, from which follow the target's centre, the direction of its face, and the
position and extent of what protrudes from the face (`goal_of`). During the motion it sees the image
of the camera "wrist" with depth, the gripper's opening and the tool's orientation. All is expressed
in the tool's frame: each pixel carries its point there, and each feature of the convolutional
network becomes the mean of these points, weighted by a softmax (spatial softmax, Levine et al., JMLR
2016, in three dimensions). The output is a chunk of poses of the tool in the same frame, as in Chi
et al., "Universal Manipulation Interface", RSS 2024. Neither inputs nor actions know the simulated
pose of the object.

While recording, the expert is pushed off its way now and then, and the network learns how it
returns, but not the pushes: without them the network's own errors lead to states that no
demonstration shows (Laskey et al., "DART", CoRL 2017). While training, a linear layer also estimates
the simulated state from the network's features, which makes the features show where the object is;
the state is not used afterwards.

Each stage is resumed where it stopped: recording by blocks of 20 demonstrations, training by epoch,
measuring by episode. --minutes bounds the training. docs/demonstrations.md has the results, and
those of earlier designs.
"""

import argparse
import json
import math
import time
from pathlib import Path

import numpy as np
import torch
from torch import nn

import simwright as sw
from simwright import cameras, demonstrations, envs

BLOCK = 20
# The arm arrives at a commanded pose about three steps later.
LEAD = 3
INPUTS = 15  # numbers of `inputs_of`
PROTRUDES = 0.008  # m before the face
FAR = 0.6  # m, the largest depth that the network tells apart


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


def outlined_points(depth, segmentation, legend, base_from_camera, intrinsics):
    """Returns the points (n, 3) of the target that a depth image shows, in the robot's base, m: of
    its link if it has one, else of its object."""
    names = {number: name for number, name in legend.items() if number > 2}
    links = [number for number, name in names.items() if "/" in name]
    for labels in (links, list(names)):
        rows, columns = np.nonzero(np.isin(segmentation, labels) & (depth > 0))
        if len(rows) >= 20:
            break
    else:
        raise SystemExit("error: the camera does not see the target")
    fx, fy, cx, cy = intrinsics
    z = depth[rows, columns].astype(np.float64)
    points = np.stack([(columns + 0.5 - cx) / fx * z, (rows + 0.5 - cy) / fy * z, z], axis=1)
    return points @ base_from_camera[:3, :3].T + base_from_camera[:3, 3]


def face_of(points):
    """Returns the points (m, 3) of the plane that most of the points lie in, within 4 mm, and its
    unit normal towards the robot (RANSAC, then a least-squares fit)."""
    rng = np.random.default_rng(0)
    most = np.zeros(len(points), bool)
    for _ in range(200):
        a, b, c = points[rng.choice(len(points), 3, replace=False)]
        normal = np.cross(b - a, c - a)
        length = np.linalg.norm(normal)
        if length < 1e-9:
            continue
        near = np.abs((points - a) @ normal) < 0.004 * length
        if near.sum() > most.sum():
            most = near
    face = points[most]
    normal = np.linalg.svd(face - face.mean(axis=0), full_matrices=False)[2][2]
    return face, normal * np.sign(-normal @ face.mean(axis=0))


def goal_of(points):
    """Returns what the network knows of the target (11), in the robot's base: the centre of its face
    (3), the unit normal of the face, towards the robot (3), the middle of what protrudes from it (3;
    the centre if nothing does), and its extent sideways and upwards (2), m."""
    face, normal = face_of(points)
    centre = np.median(face, axis=0)
    height = (points - centre) @ normal
    before = points[(height > PROTRUDES) & (height < 0.1)]
    middle, extent = centre, np.zeros(2)
    if len(before) >= 3:
        middle = np.median(before, axis=0)
        sideways = np.cross([0.0, 0.0, 1.0], normal)
        sideways /= max(np.linalg.norm(sideways), 1e-9)
        extent = np.stack([before @ sideways, before @ np.cross(normal, sideways)]).std(axis=1)
    return np.concatenate([centre, normal, middle, extent])


def inputs_of(tools, openings, goals):
    """Returns the numbers that the network sees (n, INPUTS), of poses (n, 4, 4) of the tool in the
    robot's base, openings (n) and goals (n, 11): the opening, the direction up, and the goal, all in
    the tool's frame."""
    to_tool = tools[:, :3, :3].transpose(0, 2, 1)

    def turned(vectors):
        return (to_tool @ vectors[..., None])[..., 0]

    position = tools[:, :3, 3]
    return np.concatenate([
        openings[:, None], to_tool[:, :, 2], turned(goals[:, :3] - position), turned(goals[:, 3:6]),
        turned(goals[:, 6:9] - position), goals[:, 9:]], axis=1).astype(np.float32)


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
    """Returns the cameras of an environment, and what it renders of them."""
    named = cameras.defaults(3 * told.image_size, 3 * told.image_size)
    return {"cameras": [named["shoulder"], "wrist"], "image_size": told.image_size,
            "look": told.look, "images": ["rgb", "depth", "segmentation"]}


def wrist_rays(intrinsics, tool_from_camera, size):
    """Returns the directions (3, size, size) in the tool's frame that times the depth give the
    points of the wrist's pixels from the camera, and the camera's position there (3), m."""
    fx, fy, cx, cy = intrinsics
    rows, columns = np.mgrid[:size, :size] + 0.5
    rays = np.stack([(columns - cx) / fx, (rows - cy) / fy, np.ones((size, size))])
    turned = np.tensordot(tool_from_camera[:3, :3], rays, axes=1)
    return turned.astype(np.float32), tool_from_camera[:3, 3].astype(np.float32)


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
        rows = {key: [] for key in ("wrist", "depths", "rays", "eyes", "tools", "openings",
                                    "grippers", "states", "pushed", "goals", "lengths")}
        expert = PushedExpert(told.pushes, [told.seed, block])
        for episode in demonstrations.record(
                told.skill, count, policy=expert, seed=told.seed + block, progress=False,
                instances=told.instances, **cameras_of(told)):
            points = outlined_points(
                episode.images["shoulder_depth"][0], episode.images["shoulder_segmentation"][0],
                episode.legend, np.linalg.inv(episode.base) @ episode.camera_poses["shoulder"][0],
                episode.intrinsics["shoulder"])
            rays, eye = wrist_rays(
                episode.intrinsics["wrist"], np.linalg.inv(episode.base @ episode.tools[0])
                @ episode.camera_poses["wrist"][0], told.image_size)
            for key, value in (
                    ("wrist", episode.images["wrist"][:-1]), ("rays", rays[None]),
                    ("depths", episode.images["wrist_depth"][:-1].astype(np.float16)),
                    ("eyes", eye[None]), ("tools", episode.tools[:-1]),
                    ("openings", episode.openings[:-1]), ("grippers", episode.targets[:, -1]),
                    ("states", episode.states[:-1]), ("pushed", np.array(expert.pushed)),
                    ("goals", goal_of(points)[None]), ("lengths", [len(episode)])):
                rows[key].append(value)
        partial = path.with_suffix(".partial.npz")
        np.savez(partial, **{key: np.concatenate(value) for key, value in rows.items()})
        partial.replace(path)
        print(f"recorded {block * BLOCK + count} of {told.demos} "
              f"({(time.monotonic() - began) / count:.1f} s each)", flush=True)
    return paths


class Demonstrations:
    """All frames in memory; `batch` makes inputs and chunks of actions of frame numbers."""

    def __init__(self, paths, chunk):
        loaded = [np.load(path) for path in paths]
        rows = {key: np.concatenate([one[key] for one in loaded]) for key in loaded[0].files}
        lengths = rows["lengths"]
        self.count = int(lengths.sum())
        last = np.repeat(np.cumsum(lengths), lengths)[:, None] - 1
        steps = np.arange(self.count)[:, None] + np.arange(chunk + LEAD)
        steps = np.minimum(steps, last)  # beyond the end of an episode, the last target repeats
        # A push until the target's step changes the target.
        pushed = np.logical_or.accumulate(rows["pushed"][steps], axis=1)[:, LEAD:]
        self.known = torch.tensor(~pushed, dtype=torch.float32)
        self.wrist = torch.from_numpy(rows["wrist"])
        self.depths = torch.from_numpy(rows["depths"])
        self.rays, self.eye = (torch.from_numpy(rows[key][0]) for key in ("rays", "eyes"))
        self.inputs = torch.from_numpy(inputs_of(rows["tools"], rows["openings"],
                                                 np.repeat(rows["goals"], lengths, axis=0)))
        self.motions = torch.from_numpy(self._motions(rows["tools"], steps[:, LEAD:]))
        self.opens = torch.from_numpy((0.5 * (rows["grippers"] + 1)).astype(np.float32)[
            steps[:, :chunk]])
        states = torch.from_numpy(rows["states"])
        self.states = (states - states.mean(dim=0)) / (states.std(dim=0) + 1e-3)

    @staticmethod
    def _motions(tools, steps):
        """Returns the tool's poses at `steps` (N, chunk) in its frame at the row's step: position,
        m, and rotation vector, rad (N, chunk, 6)."""
        now = tools[:, :3, :3].transpose(0, 2, 1)[:, None]
        moved = now @ (tools[steps, :3, 3] - tools[:, None, :3, 3])[..., None]
        turned = rotation_vectors(now @ tools[steps, :3, :3])
        return np.concatenate([moved[..., 0], turned], axis=2).astype(np.float32)


class VisualPolicy(nn.Module):
    """A convolutional network for the image with depth, whose features become points in the tool's
    frame, and a multilayer perceptron over all inputs."""

    def __init__(self, chunk, state_size, rays, eye):
        """Takes what `wrist_rays` returns."""
        super().__init__()
        self.chunk = chunk
        self.register_buffer("rays", rays)
        self.register_buffer("eye", eye)
        layers, channels = [], 6
        for width, stride in ((16, 2), (32, 2), (48, 1), (48, 1)):
            layers += [nn.Conv2d(channels, width, 3, stride, 1), nn.ReLU()]
            channels = width
        # The layout "channels last" without normalisation is fast on a processor.
        self.features = nn.Sequential(*layers).to(memory_format=torch.channels_last)
        self.trunk = nn.Sequential(nn.Linear(4 * channels + INPUTS, 512), nn.ReLU(), nn.Dropout(0.1),
                                   nn.Linear(512, 512), nn.ReLU())
        self.head = nn.Linear(512, 7 * chunk)
        # A linear path from the inputs, which extrapolates to goals outside the training set.
        self.direct = nn.Linear(INPUTS, 7 * chunk, bias=False)
        self.state = nn.Linear(512, state_size)
        for name, shape in (("mean", (INPUTS,)), ("scale", (INPUTS,)), ("motion_scale", (chunk, 6))):
            self.register_buffer(name, torch.ones(shape))

    @staticmethod
    def _keypoints(features, points):
        """Returns each feature map's mean, and the mean of the pixels' points weighted by the
        softmax of the map (N, 4 C)."""
        stride = points.shape[-1] // features.shape[-1]
        points = points[:, :, stride // 2::stride, stride // 2::stride].flatten(2)
        features = features.contiguous().flatten(2)
        found = torch.softmax(features, dim=2) @ points.transpose(1, 2)
        return torch.cat([features.mean(dim=2), found.flatten(1)], dim=1)

    def forward(self, images, depths, inputs, shift=0):
        """Returns a chunk of motions (N, chunk, 6), poses in the present tool's frame, the logits
        that the gripper opens (N, chunk), and the estimated standardised state (N, O). ``shift``:
        pixels of random translation, while training."""
        pixels = images.permute(0, 3, 1, 2).float() / 255 - 0.5
        depths = torch.where(depths > 0, depths.float().clamp(max=FAR), FAR)[:, None]
        if self.training:  # random gain of each colour channel; noise of the depth
            pixels = pixels * (0.8 + 0.4 * torch.rand(len(pixels), 3, 1, 1))
            depths = depths * (1 + 0.005 * torch.randn_like(depths))
        points = (self.rays * depths + self.eye[:, None, None]) / FAR
        seen = torch.cat([pixels, points], dim=1)
        if shift:
            side = pixels.shape[-1]
            seen = nn.functional.pad(seen, [shift] * 4, mode="replicate")
            top, left = torch.randint(0, 2 * shift + 1, (2,)).tolist()
            seen = seen[:, :, top:top + side, left:left + side]
        features = self.features(seen.contiguous(memory_format=torch.channels_last))
        seen = self._keypoints(features, 3 * seen[:, 3:])
        known = (inputs - self.mean) / self.scale
        if self.training:  # noise, so that no demonstration is known by its exact goal
            known = known + 0.03 * torch.randn_like(known)
        features = self.trunk(torch.cat([known, seen], dim=1))
        actions = (self.head(features) + self.direct(known)).view(len(features), self.chunk, 7)
        return actions[..., :6] * self.motion_scale, actions[..., 6], self.state(features)


def losses_of(policy, data, frames, shift):
    """Returns the losses of the actions and of the state."""
    motions, opens, states = policy(data.wrist[frames], data.depths[frames], data.inputs[frames],
                                    shift)
    errors = ((motions - data.motions[frames]).abs() / policy.motion_scale).mean(dim=2)
    errors = errors + 0.2 * nn.functional.binary_cross_entropy_with_logits(
        opens, data.opens[frames], reduction="none")
    known = data.known[frames]
    return (errors * known).sum() / known.sum(), (states - data.states[frames]).abs().mean()


def train(told, data, path):
    """Trains until the epochs or minutes are used; continues from a checkpoint at `path`."""
    torch.manual_seed(told.seed)
    policy = VisualPolicy(told.chunk, data.states.shape[1], data.rays, data.eye)
    policy.mean.copy_(data.inputs.mean(dim=0))
    policy.scale.copy_(data.inputs.std(dim=0) + 1e-3)
    policy.motion_scale.copy_(data.motions.std(dim=0) + 1e-4)
    optimizer = torch.optim.AdamW(policy.parameters(), lr=1e-3, weight_decay=1e-2)
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
        sums = np.zeros(2)
        batches = torch.randperm(data.count).split(told.batch)
        for frames in batches:
            loss, state_loss = losses_of(policy, data, frames, told.shift)
            optimizer.zero_grad()
            (loss + told.state_weight * state_loss).backward()
            nn.utils.clip_grad_norm_(policy.parameters(), 5.0)
            optimizer.step()
            sums += loss.item(), state_loss.item()
        state = {"epoch": epoch + 1, "seconds": time.monotonic() - began}
        partial = path.with_suffix(".partial")
        torch.save({"policy": policy.state_dict(), "optimizer": optimizer.state_dict(),
                    "state": state}, partial)
        partial.replace(path)
        loss, state_loss = sums / len(batches)
        print(f"epoch {epoch + 1} of {told.epochs}: loss {loss:.4f}, state {state_loss:.4f}, "
              f"{state['seconds'] / 60:.1f} min", flush=True)
    return policy.eval(), state


def action_of(pose, opens):
    """Returns the action in the space "absolute" of a pose (4, 4) of the tool in the robot's base
    (docs/python.md)."""
    front = np.diag([1.0, -1.0, -1.0])
    turn = rotation_vectors(front.T @ pose[:3, :3]) / np.pi
    action = np.concatenate([front.T @ (pose[:3, 3] - [0.5, 0.0, 0.3]) / 0.5, turn, [opens]])
    return np.clip(action, -1, 1).astype(np.float32)


def run(env, observation, policy, execute):
    """Runs an episode; returns whether it succeeded."""
    told = demonstrations.describe(env)
    base_from_world = np.linalg.inv(told["base"])
    camera = env.camera("shoulder")
    goal = goal_of(outlined_points(
        observation["shoulder_depth"], observation["shoulder_segmentation"], told["legend"],
        base_from_world @ camera["pose"], camera["intrinsics"]))[None]
    while True:
        state = env.state()
        tool = base_from_world @ state["gripper_pose"]
        inputs = inputs_of(tool[None], np.array([state["gripper_opening"]]), goal)
        with torch.inference_mode():
            motions, opens, _ = policy(torch.from_numpy(observation["wrist"][None]),
                                       torch.from_numpy(observation["wrist_depth"][None]),
                                       torch.from_numpy(inputs))
        for motion, opening in zip(motions[0, :execute].double().numpy(),
                                   torch.sign(opens[0]).double().numpy()):
            pose = np.eye(4)
            pose[:3, :3], pose[:3, 3] = rotation(motion[3:]), motion[:3]
            observation, _, terminated, truncated, info = env.step(action_of(tool @ pose, opening))
            if terminated or truncated:
                return bool(info["is_success"])


def measure(told, policy, path):
    """Returns the successes of the episodes, continued from those in `path`."""
    results = json.loads(path.read_text()) if path.exists() else []
    env = envs.SkillEnv(cell=told.skill, split="unseen", action_space="absolute", **cameras_of(told))
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
    add("--instances", type=int, default=100, help="of the objects")
    add("--image-size", type=int, default=64, help="pixels a side at the wrist; shoulder: 3 times")
    add("--look", choices=["wide"], default=None, help="randomises looks")
    add("--pushes", type=float, default=0.04, help="probability that a push starts at a step")
    add("--state-weight", type=float, default=0.5, help="of the estimated state in the loss")
    add("--shift", type=int, default=2, help="of images in training, pixels at most")
    add("--chunk", type=int, default=12, help="actions predicted at once, 0.05 s each")
    add("--execute", type=int, default=8, help="of them that are executed")
    add("--epochs", type=int, default=30, help="at most")
    add("--minutes", type=float, default=60.0, help="of training, at most")
    add("--batch", type=int, default=64, help="frames")
    add("--episodes", type=int, default=100, help="of the measurement")
    add("--threads", type=int, default=2, help="of the training")
    add("--seed", type=int, default=1, help="of all stages")
    told = parser.parse_args()
    if told.output.exists() and not told.resume:
        parser.error(f"{told.output} exists (give --resume, or another folder)")
    torch.set_num_threads(told.threads)
    data = Demonstrations(record(told, told.output / "demonstrations"), told.chunk)
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
