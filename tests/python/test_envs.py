"""Gymnasium environments: semantics, equality with the compiled loop, faults."""

import multiprocessing
import threading

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode

import simwright as sw
from simwright import _core, envs
from simwright._cells import cell_tasks

DRAWER = dict(cell="open_drawer", instances=4)
SPACES = ["focus", "guided", "delta", "osc_delta", "absolute", "joints", "joint_targets"]


@pytest.fixture(scope="module")
def drawer():
    env = envs.SkillEnv(**DRAWER)
    yield env
    env.close()


def random_actions(shape, seed):
    return np.random.default_rng(seed).uniform(-1, 1, shape).astype(np.float32)


def test_all_cells_and_long_tasks_are_registered():
    names = set(sw.skills.names())
    assert len(names) == 13
    for name in names:
        title = "".join(word.capitalize() for word in name.split("_"))
        spec = gymnasium.spec(f"simwright/{title}-v0")
        assert spec.kwargs["cell"] == name and spec.vector_entry_point
    for name in ("CupIntoMicrowave", "AppleIntoDrawer", "CupOutOfCabinet", "Task", "LongTask"):
        gymnasium.spec(f"simwright/{name}-v0")


@pytest.mark.filterwarnings("ignore:.*Box observation space.*")
@pytest.mark.parametrize("kwargs", [
    {}, {"action_space": "osc_delta"},
    {"cameras": ["front", "wrist"], "images": ["rgb", "depth", "segmentation", "normal"],
     "image_size": 32, "look": "wide", "render_mode": "rgb_array"},
])
def test_check_env(kwargs):
    check_env(gymnasium.make("simwright/OpenDrawer-v0", instances=4, **kwargs).unwrapped)


@pytest.mark.parametrize("action_space", SPACES)
def test_action_spaces(action_space):
    env = envs.SkillEnv(**DRAWER, action_space=action_space)
    assert env.action_space.shape == ((8,) if "joint" in action_space else (7,))
    env.reset(seed=1)
    for _ in range(5):
        observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
    assert env.observation_space.contains(observation) and np.isfinite(reward)


def tool(env):
    return env.state()["gripper_pose"]


def test_osc_delta_moves_as_robosuite_does():
    env = envs.SkillEnv(**DRAWER, action_space="osc_delta")
    for axis in range(3):
        for sign in (-1.0, 1.0):
            env.reset(seed=5)
            start = tool(env)
            # 0.2 of 0.05 m a step, 0.1 m in ten steps.
            action = np.zeros(7, np.float32)
            action[axis] = sign * 0.2
            for _ in range(10):
                env.step(action)
            shift = tool(env)[:3, 3] - start[:3, 3]
            # Each step starts from the pose of the arm, as in robosuite: the arm lags behind.
            assert 0.5 * 0.1 < shift[axis] * sign < 0.1
            assert np.abs(np.delete(shift, axis)).max() < 0.03
    env.reset(seed=5)
    start = tool(env)
    for _ in range(10):
        env.step(np.array([0, 0, 0, 0, 0, 0.1, 0], np.float32))  # 0.05 rad a step about z
    turned = tool(env)[:3, :3] @ start[:3, :3].T
    assert 0.25 < np.arctan2(turned[1, 0], turned[0, 0]) < 0.5


def test_osc_delta_closes_the_gripper_with_one():
    env = envs.SkillEnv(**DRAWER, action_space="osc_delta")
    env.reset(seed=5)
    close = np.array([0, 0, 0, 0, 0, 0, 1], np.float32)
    for _ in range(20):
        env.step(close)
    closed = env.state()["gripper_opening"]
    for _ in range(20):
        env.step(-close)
    assert closed < 0.005 and env.state()["gripper_opening"] > 0.06


def test_joint_targets_are_reached():
    env = envs.SkillEnv(**DRAWER, action_space="joint_targets")
    env.reset(seed=2)
    lower = np.array([-2.8973, -1.7628, -2.8973, -3.0718, -2.8973, -0.0175, -2.8973])
    upper = np.array([2.8973, 1.7628, 2.8973, -0.0698, 2.8973, 3.7525, 2.8973])
    wanted = env.state()["robot_joints"][:7] + np.array([0.1, -0.1, 0.1, -0.1, 0.1, 0.1, -0.1])
    action = np.append((2 * wanted - lower - upper) / (upper - lower), 0.0).astype(np.float32)
    for _ in range(30):
        env.step(action)
    np.testing.assert_allclose(env.state()["robot_joints"][:7], wanted, atol=0.01)


def test_zero_actions_stay_in_the_users_spaces():
    for action_space in ("delta", "osc_delta", "joints"):
        env = envs.SkillEnv(**DRAWER, action_space=action_space)
        env.reset(seed=3)
        before = tool(env)[:3, 3]
        for _ in range(20):
            env.step(np.zeros(env.action_space.shape, np.float32))
        assert np.linalg.norm(tool(env)[:3, 3] - before) < 0.01


def test_the_vector_environment_equals_single_ones():
    single = envs.SkillEnv(**DRAWER, episode_seconds=1.0)
    vector = envs.SkillVectorEnv(num_envs=3, **DRAWER, episode_seconds=1.0)
    observations, infos = vector.reset(seed=7)
    expected, _ = single.reset(seed=7)
    np.testing.assert_array_equal(observations[0], expected)
    episodes = 0
    for step in range(45):
        actions = random_actions((3, 7), step)
        observations, rewards, terminated, truncated, infos = vector.step(actions)
        expected, reward, single_terminated, single_truncated, info = single.step(actions[0])
        assert (rewards[0], terminated[0], truncated[0]) == (
            np.float32(reward), single_terminated, single_truncated)
        assert infos["success"][0] == info["success"] or terminated[0]
        if single_terminated or single_truncated:
            np.testing.assert_array_equal(infos["final_obs"][0], expected)
            assert infos["_final_obs"][0] and infos["_final_info"][0]
            expected, _ = single.reset()  # the next episode of the seed
            episodes += 1
        np.testing.assert_array_equal(observations[0], expected)
    assert episodes == 2


def test_images_of_the_vector_environment_equal_single_ones():
    kwargs = dict(**DRAWER, episode_seconds=0.5, cameras=["front"], image_size=32,
                  images=["rgb", "depth"])
    single, vector = envs.SkillEnv(**kwargs), envs.SkillVectorEnv(num_envs=2, **kwargs)
    batch, _ = vector.reset(seed=4)
    one, _ = single.reset(seed=4)
    for step in range(12):
        np.testing.assert_array_equal(batch["front"][0], one["front"])
        np.testing.assert_array_equal(batch["front_depth"][0], one["front_depth"])
        actions = random_actions((2, 7), step)
        batch, _, terminated, truncated, infos = vector.step(actions)
        one, _, ended, out_of_time, _ = single.step(actions[0])
        if ended or out_of_time:
            np.testing.assert_array_equal(infos["final_obs"][0]["front"], one["front"])
            one, _ = single.reset()


def test_vector_environment_declares_its_mode():
    vector = gymnasium.make_vec("simwright/OpenDrawer-v0", num_envs=2, instances=4)
    assert isinstance(vector.unwrapped, envs.SkillVectorEnv)
    assert vector.metadata["autoreset_mode"] == AutoresetMode.SAME_STEP
    assert vector.observation_space.shape == (2, *vector.single_observation_space.shape)


def test_seeds(drawer):
    first, _ = drawer.reset(seed=11)
    second, _ = drawer.reset()
    again, _ = drawer.reset(seed=11)
    np.testing.assert_array_equal(first, again)
    assert np.abs(first - second).max() > 1e-3
    np.testing.assert_array_equal(second, drawer.reset()[0])
    vector = envs.SkillVectorEnv(num_envs=4, **DRAWER)
    one, _ = vector.reset(seed=[1, 2, 3, 4])
    two, _ = vector.reset(seed=[1, 2, 3, 4])
    other, _ = vector.reset(seed=[1, 2, 3, 5])
    np.testing.assert_array_equal(one, two)
    assert np.abs(one - other).max() > 1e-3
    with pytest.raises(sw.Error, match="4"):
        vector.reset(seed=[1])


def test_threads_do_not_matter():
    results = []
    try:
        for threads in (1, 2):
            sw.set_threads(threads)
            vector = envs.SkillVectorEnv(num_envs=8, **DRAWER)
            vector.reset(seed=1)
            for step in range(10):
                observations = vector.step(random_actions((8, 7), step))[0]
            results.append(observations)
    finally:
        sw.set_threads(0)
    np.testing.assert_array_equal(*results)


def test_the_expert_opens_the_drawer_and_ends_the_episode(drawer):
    observation, _ = drawer.reset(seed=3)
    total = 0.0
    for step in range(160):
        observation, reward, terminated, truncated, info = drawer.step(drawer.expert_action())
        total += reward
        if terminated or truncated:
            break
    assert terminated and info["is_success"] and info["success"] and total > 10.0
    state = drawer.state()
    joints = state["objects"][state["target"]]["joints"]
    assert max(joints.values()) > 0.05
    with pytest.raises(sw.Error, match="reset"):
        drawer.step(np.zeros(7, np.float32))


def test_the_shipped_policy_does_in_python_what_it_does_in_the_program():
    policy = sw.skills.load("open_drawer")
    measured = sw.skills.evaluate("open_drawer", episodes=12, seed=5)
    env = envs.SkillEnv(cell="open_drawer", split="unseen", action_space=policy.action_space)
    successes = 0
    observation, _ = env.reset(seed=5)
    for _ in range(12):
        ended = False
        while not ended:
            action = policy.act(observation[None])[0]
            observation, _, terminated, truncated, info = env.step(action)
            ended = terminated or truncated
        successes += info["is_success"]
        observation, _ = env.reset()
    assert successes == measured["successes"] >= 8
    low, high = measured["interval"]
    assert low < measured["success"] < high or measured["success"] == 1.0


def test_policies_name_their_action_space():
    # Files of before guided actions state none.
    assert sw.skills.load("close_drawer").action_space == "focus"
    assert sw.skills.load("pick_up_cup").action_space == "focus"
    assert sw.skills.load("open_drawer").action_space == "guided"


def test_a_task_file():
    file = cell_tasks("open_drawer", "train", 4)
    env = gymnasium.make("simwright/Task-v0", tasks=str(file), task="open_*")
    assert env.reset(seed=1)[0].shape == env.observation_space.shape
    with pytest.raises(sw.Error, match="no task 'bake'"):
        gymnasium.make("simwright/Task-v0", tasks=str(file), task="bake")
    with pytest.raises(sw.Error, match="missing.json"):
        gymnasium.make("simwright/Task-v0", tasks="/nowhere/missing.json")


@pytest.mark.filterwarnings("ignore:.*Box observation space.*")
def test_a_long_task_by_its_experts():
    env = gymnasium.make("simwright/AppleIntoDrawer-v0", render_mode="rgb_array").unwrapped
    check_env(env)
    solved = False
    for seed in (1, 2, 3):
        observation, info = env.reset(seed=seed)
        subtasks = [info["subtask"]]
        ended = False
        while not ended:
            assert env.observation_space.contains(observation)
            assert observation[: len(env.task.subtasks)].argmax() == subtasks[-1]
            observation, _, terminated, truncated, info = env.step(env.expert_action())
            if info["subtask"] != subtasks[-1]:
                subtasks.append(info["subtask"])
            ended = terminated or truncated
        if info["is_success"]:
            solved = True
            assert terminated and subtasks == [0, 1, 2, 3]
    assert solved


def test_cameras_see_the_gripper_where_it_is():
    spec = sw.cameras.camera("side", position=(0.4, 1.6, 0.8), target=(0.4, 0.0, 0.4), width=160,
                             height=120)
    env = envs.SkillEnv(**DRAWER, cameras=[spec], images=["segmentation", "depth"])
    observation, _ = env.reset(seed=2)
    seen = env.camera("side")
    ids = {name: label for label, name in seen["legend"].items()}
    assert {"robot", "gripper"} <= set(ids)
    point = np.linalg.inv(seen["pose"]) @ tool(env)[:, 3]
    fx, fy, cx, cy = seen["intrinsics"]
    column, row = fx * point[0] / point[2] + cx, fy * point[1] / point[2] + cy
    rows, columns = np.nonzero(observation["side_segmentation"] == ids["gripper"])
    assert rows.size > 20
    # The tool frame lies between the fingertips, within the gripper's pixels.
    assert columns.min() - 6 <= column <= columns.max() + 6
    assert rows.min() - 6 <= row <= rows.max() + 6
    nearest = observation["side_depth"][rows, columns].min()
    assert abs(nearest - point[2]) < 0.2


def test_looks_change_by_seed_and_images_do_not_need_them():
    env = envs.SkillEnv(**DRAWER, cameras=["front"], image_size=48, look={"floor_color": 1.0})
    first = env.reset(seed=1)[0]["front"]
    second = env.reset(seed=2)[0]["front"]
    np.testing.assert_array_equal(first, env.reset(seed=1)[0]["front"])
    assert np.abs(first.astype(int) - second.astype(int)).mean() > 5.0


class Graded:
    """Refuses to become an array, as a tensor that requires a gradient does."""

    def __array__(self, *arguments, **named):
        raise RuntimeError("use tensor.detach().numpy() instead")


@pytest.mark.parametrize("action, word", [
    (Graded(), "action: .*detach"), (np.zeros(6), "shape"), (np.zeros((1, 7)), "shape"), ("left", "numbers"), (None, "numbers"),
    (np.zeros(7, complex), "numbers"), ([[0] * 7, [0]], "numbers"), (7, "shape"),
])
def test_bad_actions(drawer, action, word):
    drawer.reset(seed=1)
    with pytest.raises(sw.Error, match=word):
        drawer.step(action)
    assert np.isfinite(drawer.step(np.zeros(7))[1])  # the episode goes on


def test_an_action_that_is_not_finite_ends_its_episode(drawer):
    drawer.reset(seed=1)
    action = np.zeros(7, np.float32)
    action[2] = np.nan
    observation, reward, terminated, truncated, info = drawer.step(action)
    assert terminated and not truncated and reward == 0.0 and np.isfinite(observation).all()
    assert info["fault"] == "the action is not finite in 2" and not info["is_success"]
    vector = envs.SkillVectorEnv(num_envs=4, **DRAWER)
    vector.reset(seed=1)
    actions = np.zeros((4, 7), np.float32)
    actions[2, [1, 5]] = np.inf, np.nan
    observations, rewards, terminated, truncated, infos = vector.step(actions)
    assert terminated.tolist() == [False, False, True, False] and not truncated.any()
    assert infos["final_info"]["fault"][2] == "the action of environment 2 is not finite in 1, 5"
    assert not infos["final_info"]["is_success"].any() and np.isfinite(observations).all()
    assert np.isfinite(vector.step(np.zeros((4, 7)))[0]).all()


def test_a_closed_environment_says_so():
    for env in (envs.SkillEnv(**DRAWER), envs.SkillVectorEnv(num_envs=2, **DRAWER)):
        env.reset(seed=1)
        env.close()
        env.close()
        for call in (env.reset, lambda: env.step(np.zeros(7))):
            with pytest.raises(sw.Error, match="closed"):
                call()


def step_in_child(queue):
    vector = envs.SkillVectorEnv(num_envs=4, **DRAWER)
    vector.reset(seed=1)
    queue.put(vector.step(np.zeros((4, 7), np.float32))[0])


def test_forked_processes_work():
    parent = envs.SkillVectorEnv(num_envs=4, **DRAWER)
    parent.reset(seed=1)
    expected = parent.step(np.zeros((4, 7), np.float32))[0]
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    child = context.Process(target=step_in_child, args=(queue,))
    child.start()
    np.testing.assert_array_equal(queue.get(timeout=120), expected)
    child.join(timeout=60)
    assert child.exitcode == 0
    np.testing.assert_array_equal(parent.reset(seed=1)[0], _core_reset(4))


def _core_reset(count):
    task = _core.PreparedTask(str(cell_tasks("open_drawer", "train", 4)), ["*"], _core.TaskSettings())
    return _core.VectorEpisodes(task, 0, count, True).reset(1)


def test_gymnasiums_own_vector_environments_work_in_processes():
    vector = gymnasium.make_vec("simwright/OpenDrawer-v0", num_envs=2, instances=4,
                                vectorization_mode="async")
    observations, _ = vector.reset(seed=1)
    assert np.isfinite(vector.step(np.zeros((2, 7), np.float32))[0]).all()
    vector.close()


def test_the_shoulder_sees_the_drawer_that_the_front_camera_does_not():
    env = envs.SkillEnv(**DRAWER, cameras=["front", "shoulder"], image_size=48,
                        images=["segmentation"])
    observation, _ = env.reset(seed=2)
    seen = {"front": [], "shoulder": []}
    for _ in range(8):
        for name, counts in seen.items():
            drawer = [label for label, what in env.camera(name)["legend"].items() if "/" in what]
            counts.append(int(np.isin(observation[f"{name}_segmentation"], drawer).sum()))
        observation, _ = env.reset()
    assert min(seen["shoulder"]) > 20, seen
    assert np.median(seen["shoulder"]) > 2 * np.median(seen["front"]), seen


def test_environments_are_for_one_thread_at_a_time():
    env = envs.SkillVectorEnv(4, **DRAWER)
    env.reset(seed=1)
    refused = []

    def work(call):
        for _ in range(40):
            try:
                call()
            except sw.Error as error:
                refused.append(str(error))

    actions = np.zeros(env.action_space.shape, np.float32)
    threads = [threading.Thread(target=work, args=(call,)) for call in
               (lambda: env.reset(seed=2), lambda: env.step(actions), lambda: env.step(actions))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert refused and all("another thread" in text for text in refused)
