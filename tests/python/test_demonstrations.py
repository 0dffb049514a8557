"""Recording of demonstrations; what their writers need (peers/ reads what they write)."""

import importlib.util
import json
import zlib

import numpy as np
import pytest

import simwright as sw
from simwright import _core, demonstrations, envs
from simwright._cells import cell_tasks
from simwright._mcap import png
from simwright._robomimic import xyzw
from simwright._runs import RunPolicies

DRAWER = dict(skill="open_drawer", instances=4, image_size=24)


@pytest.fixture(scope="module")
def episodes():
    """Episodes 0 to 3 of seed 3, of which the last one fails."""
    return list(demonstrations.record(count=4, keep="all", seed=3,
                                      images=["rgb", "depth", "segmentation"], **DRAWER))


def test_shapes(episodes):
    for index, episode in enumerate(episodes):
        count = len(episode)
        assert (episode.index, episode.seed, episode.skill) == (index, 3, "open_drawer")
        assert episode.states.shape == (count + 1, 70) and episode.states.dtype == np.float32
        assert episode.joints.shape == (count + 1, 7) and episode.openings.shape == (count + 1,)
        assert episode.tools.shape == (count + 1, 4, 4) and episode.actions.shape == (count, 7)
        assert episode.commands.shape == (count, 8) and episode.rewards.shape == (count,)
        assert set(episode.images) == {f"{name}{kind}" for name in ("front", "wrist")
                                       for kind in ("", "_depth", "_segmentation")}
        assert episode.images["front"].shape == (count + 1, 24, 24, 3)
        assert episode.images["front"].dtype == np.uint8
        assert episode.images["wrist_depth"].shape == (count + 1, 24, 24)
        assert np.allclose(np.diff(episode.times), 0.05) and len(episode.times) == count + 1
        assert episode.dones.sum() == 1 and episode.dones[-1]
        assert episode.camera_poses["wrist"].shape == (count + 1, 4, 4)


def test_success_is_the_goal_held_for_half_a_second(episodes):
    for episode in episodes:
        assert episode.success == bool(episode.goals[-10:].all())
        # The drawer is 70 % open at the goal, by the simulated joint.
        entry = next(iter(episode.objects.values()))
        travel = np.abs(entry["joints"] - entry["joints"][0]).max(axis=1)
        assert (travel[-1] > 0.15) == episode.success
    assert [episode.success for episode in episodes].count(False) == 1


def test_the_environment_repeats_an_episode(episodes):
    env = envs.SkillEnv(cell="open_drawer", instances=4)
    env.reset(seed=3)
    observation, _ = env.reset()
    for step, action in enumerate(episodes[1].actions):
        np.testing.assert_array_equal(observation, episodes[1].states[step])
        np.testing.assert_array_equal(env.state()["robot_joints"], episodes[1].joints[step])
        observation, reward, terminated, _, info = env.step(action)
        assert np.float32(reward) == episodes[1].rewards[step]
    assert terminated and info["is_success"]
    np.testing.assert_array_equal(observation, episodes[1].states[-1])


def test_joint_targets_repeat_the_motion(episodes):
    """Targets that are not relative to the object open the same drawers, on the same path."""
    env = envs.SkillEnv(cell="open_drawer", instances=4, action_space="joint_targets")
    env.reset(seed=3)
    for episode in episodes[:3]:
        space, actions = episode.chosen_actions("joint_targets")
        assert space == "joint_targets" and np.abs(actions).max() <= 1.0
        deviations = []
        for step, action in enumerate(np.concatenate([actions, np.repeat(actions[-1:], 10, axis=0)])):
            _, _, terminated, truncated, info = env.step(action)
            if step < len(episode):
                deviation = np.abs(env.state()["robot_joints"] - episode.joints[step + 1]).max()
                deviations.append(deviation)
            if terminated or truncated:
                break
        assert info["is_success"] and np.mean(deviations) < 0.03  # rad
        env.reset()


def test_the_instruction_names_the_drawer_that_opens(episodes):
    for episode in episodes[:3]:
        (name, entry), = episode.objects.items()
        moved = np.abs(entry["joints"][-1] - entry["joints"][0])
        number = int(entry["joint_names"][int(moved.argmax())].split("_")[1])
        assert episode.task == f"open_{name}_drawer_{number + 1}"
        unit = name.replace("_", " ")
        assert episode.instruction == f"Open drawer {number + 1} of the {unit}."


def test_depth_belongs_to_the_camera(episodes):
    """The frame between the fingertips projects among the gripper's pixels, at their depth."""
    episode = episodes[0]
    for step in (0, len(episode)):
        tool = episode.base @ episode.tools[step]
        point = np.linalg.inv(episode.camera_poses["front"][step]) @ tool[:, 3]
        fx, fy, cx, cy = episode.intrinsics["front"]
        column, row = fx * point[0] / point[2] + cx, fy * point[1] / point[2] + cy
        label = {name: number for number, name in episode.legend.items()}["gripper"]
        rows, columns = np.nonzero(episode.images["front_segmentation"][step] == label)
        assert rows.min() - 2 <= row <= rows.max() + 2
        assert columns.min() - 2 <= column <= columns.max() + 2
        depth = episode.images["front_depth"][step][rows, columns]
        assert depth.min() - 0.1 < point[2] < depth.max() + 0.1


def test_equal_seeds_give_equal_episodes(episodes):
    again = next(demonstrations.record(count=1, seed=3, look="wide", **DRAWER))
    twice = next(demonstrations.record(count=1, seed=3, look="wide", **DRAWER))
    other = next(demonstrations.record(count=1, seed=4, look="wide", **DRAWER))
    for name in ("states", "joints", "actions", "commands", "rewards"):
        np.testing.assert_array_equal(getattr(again, name), getattr(twice, name))
        # Looks do not change the physics.
        np.testing.assert_array_equal(getattr(again, name), getattr(episodes[0], name))
    np.testing.assert_array_equal(again.images["front"], twice.images["front"])
    assert np.abs(again.images["front"].astype(int) - episodes[0].images["front"]).mean() > 2.0
    assert len(other) != len(again) or np.abs(other.states - again.states).max() > 1e-3


def test_failed_episodes_are_left_out(episodes):
    kept = list(demonstrations.record("open_drawer", 4, cameras=[], instances=4, seed=3))
    assert all(episode.success and not episode.images for episode in kept)
    assert [episode.index for episode in kept[:3]] == [0, 1, 2] and kept[3].index > 3
    np.testing.assert_array_equal(kept[1].actions, episodes[1].actions)


class Still:
    """A policy that does nothing, and counts its calls."""

    calls = 0

    def act(self, observations):
        self.calls += 1
        assert observations.shape == (1, 70)
        return np.zeros((1, 7), np.float32)


def test_policies():
    policy = Still()
    episode, = demonstrations.record("open_drawer", 1, policy=policy, cameras=[], instances=4,
                                     keep="all", episode_seconds=0.5)
    assert policy.calls == len(episode) == 10 and not episode.success
    assert not episode.actions.any()
    with pytest.raises(sw.Error, match="0 of 20 episodes succeeded"):
        list(demonstrations.record("open_drawer", 1, policy=Still(), cameras=[], instances=4,
                                   episode_seconds=0.5))
    shipped, = demonstrations.record("open_drawer", 1, policy="shipped", cameras=[], instances=4)
    loaded = sw.skills.load("open_drawer").act(shipped.states[:-1])
    # The network in a batch and one by one differ in their last digits.
    np.testing.assert_allclose(np.clip(loaded, -1, 1), shipped.actions, atol=1e-4)


def test_a_long_task():
    episode, = demonstrations.record("apple_into_drawer", 1, cameras=["front"], image_size=16)
    assert episode.success and len(episode.instructions) == 4
    assert sorted(set(episode.subtasks.tolist())) == [0, 1, 2, 3]
    assert (np.diff(episode.subtasks) >= 0).all()
    assert (episode.states[:, :4].argmax(axis=1) == episode.subtasks).all()


@pytest.mark.parametrize("kwargs, word", [
    (dict(skill="fly"), "fly"), (dict(count=0), "count"), (dict(count=2.5), "count"),
    (dict(keep="best"), "keep"), (dict(policy="random"), "random"), (dict(policy=3), "policy"),
    (dict(cameras=["back"]), "back"), (dict(images=["heat"]), "heat"), (dict(speed=3), "speed"),
    (dict(skill="apple_into_drawer", policy="shipped"), "no policy"),
    (dict(action_space="delta"), "focus"), (dict(split="test"), "split"),
    (dict(seed=-1), "seed"), (dict(seed=1.5), "seed"), (dict(image_size=64.5), "image_size"),
])
def test_bad_settings(kwargs, word):
    with pytest.raises(sw.Error, match=word):
        demonstrations.record(**{"skill": "open_drawer", "instances": 4, **kwargs})


def test_bad_actions(episodes):
    with pytest.raises(sw.Error, match="joint_targets"):
        episodes[0].chosen_actions("torques")


def test_quaternions_of_rotations():
    """Against Rodrigues' formula of random axes and angles, half turns included."""
    rng = np.random.default_rng(1)
    axes = rng.normal(size=(50, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    angles = np.concatenate([rng.uniform(0, np.pi, 45), [0.0, np.pi, np.pi, np.pi, np.pi]])
    axes[46:49] = np.eye(3)
    cross = np.zeros((50, 3, 3))
    for row, column, axis, sign in [(0, 1, 2, -1), (0, 2, 1, 1), (1, 2, 0, -1)]:
        cross[:, row, column] = sign * axes[:, axis]
        cross[:, column, row] = -sign * axes[:, axis]
    sine, cosine = np.sin(angles)[:, None, None], np.cos(angles)[:, None, None]
    rotations = np.eye(3) + sine * cross + (1 - cosine) * cross @ cross
    expected = np.concatenate([np.sin(angles / 2)[:, None] * axes, np.cos(angles / 2)[:, None]], 1)
    same = np.abs((xyzw(rotations) * expected).sum(axis=1))
    np.testing.assert_allclose(same, 1.0, atol=1e-12)


def test_png_chunks():
    image = np.random.default_rng(1).integers(0, 256, (5, 7, 3)).astype(np.uint8)
    data = png(image)
    start = data.index(b"IDAT")
    length = int.from_bytes(data[start - 4:start], "big")
    rows = np.frombuffer(zlib.decompress(data[start + 4:start + 4 + length]), np.uint8)
    np.testing.assert_array_equal(rows.reshape(5, 22)[:, 1:].reshape(5, 7, 3), image)


@pytest.mark.parametrize("module, extra, write", [
    ("lerobot", "lerobot", demonstrations.write_lerobot),
    ("mcap_ros2", "mcap", demonstrations.write_mcap),
    ("h5py", "robomimic", demonstrations.write_robomimic),
])
def test_missing_extras(module, extra, write, tmp_path, capsys, episodes):
    if importlib.util.find_spec(module) is not None:
        pytest.skip(f"{module} is installed")
    remedy = f"pip install '.[{extra}]'"
    with pytest.raises(sw.Error) as raised:
        write(tmp_path / "demos", episodes)
    assert remedy in str(raised.value)
    code = demonstrations.main(["--skill", "open_drawer", "--format", extra, "-o",
                                str(tmp_path / "demos")])
    printed = capsys.readouterr().err
    assert code == 1 and printed.count("\n") == 1
    assert printed.startswith("error: ") and remedy in printed
    assert not any(tmp_path.iterdir())


def test_command_line_errors(capsys, tmp_path):
    with pytest.raises(SystemExit) as stopped:
        demonstrations.main(["--help"])
    assert stopped.value.code == 0 and "--cameras" in capsys.readouterr().out
    with pytest.raises(SystemExit) as stopped:
        demonstrations.main(["--skill", "open_drawer", "--format", "zip", "-o", "x"])
    assert stopped.value.code == 2


def test_a_folder_of_train_is_recorded_with_its_policies(tmp_path):
    run = tmp_path / "run"
    tasks = cell_tasks("open_drawer", "train", 4)
    name = json.loads(tasks.read_text())["tasks"][0]["name"]
    sw.tasks.train(tasks, name, run, num_envs=16, samples=4096, imitated_samples=2048, episodes=4,
                   action_space="guided", progress=False)
    recorded, = demonstrations.record(run=run, count=1, keep="all", cameras=[], progress=False,
                                      episode_seconds=1.0)
    assert recorded.action_space == "guided" and recorded.task == name and len(recorded) == 20
    policy = sw.skills.load(next(run.glob("*/policy.pt")))
    np.testing.assert_allclose(recorded.actions, np.clip(policy.act(recorded.states[:-1]), -1, 1),
                               atol=1e-6)
    with pytest.raises(sw.Error, match="run"):
        demonstrations.record("open_drawer", run=run)
    with pytest.raises(sw.Error):
        demonstrations.record(run=tmp_path)


def test_each_subtask_of_a_run_has_its_policy():
    names = ["open_drawer", "pick_up_cup"]
    policies = [sw.skills.load(name) for name in names]
    folder = sw.skills._models()
    acting = RunPolicies({"action_space": "focus", "subtasks": [
        {"policy": str(_core.shipped_policy_path(str(folder), name))} for name in names]})
    states = np.random.default_rng(1).normal(size=(1, 2 + 80)).astype(np.float32)
    for index, policy in enumerate(policies):
        states[0, :2] = np.arange(2) == index
        own = np.ascontiguousarray(states[:, 2:2 + policy.observation_size])
        np.testing.assert_array_equal(acting.act(states), policy.act(own))


class Silent:
    """A policy whose act returns nothing, or one action that is not in a batch."""

    def __init__(self, answer=None):
        self.answer = answer

    def act(self, observations):
        return self.answer


@pytest.mark.parametrize("policy, word", [
    (Silent(), r"the policy's act returned None \(return an array \(1, 7\)\)"),
    (Silent(np.zeros(7)), r"act returned an array \(7,\)"),
    (lambda env: None, "the function returned None"),
])
def test_policies_that_return_no_action(policy, word):
    with pytest.raises(sw.Error, match=word):
        next(demonstrations.record("open_drawer", 1, policy=policy, cameras=[], instances=4))


def test_a_function_acts():
    calls = []

    def act(env):
        calls.append(env.state()["seconds"])
        return np.zeros(env.action_space.shape)

    episode, = demonstrations.record("open_drawer", 1, policy=act, keep="all", cameras=[],
                                     progress=False, instances=4, episode_seconds=0.5)
    np.testing.assert_allclose(calls, np.arange(10) * 0.05, atol=1e-9)
    assert not episode.actions.any()
