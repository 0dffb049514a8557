"""Reward programs against the same functions in numpy and torch."""

import numpy as np
import pytest

import simwright as sw

PROGRAM = """
def compute_reward(position, goal, speed):
    distance = torch.norm(position - goal, dim=-1)
    near = torch.exp(-5.0 * distance)
    still = 1.0 / (1.0 + speed ** 2)
    reward = near + 0.1 * still
    success = distance < 0.05
    return reward, success
"""
COMPONENTS = """
def compute_reward(position, speed):
    near = torch.exp(-5.0 * torch.norm(position, dim=-1))
    still = 1.0 / (1.0 + speed ** 2)
    return near + 0.1 * still, {"near": near, "still": still}
"""


def batch(count, seed=1):
    rng = np.random.default_rng(seed)
    return {"position": rng.normal(size=(count, 3)).astype(np.float32) * 0.1,
            "goal": rng.normal(size=(count, 3)).astype(np.float32) * 0.1,
            "speed": rng.normal(size=count).astype(np.float32)}


@pytest.fixture(scope="module")
def program():
    return sw.rewards.compile(PROGRAM, shapes={"position": [3], "goal": [3], "speed": []})


@pytest.mark.parametrize("count", [1, 7, 5000])
def test_numpy(program, count):
    inputs = batch(count)
    reward, success, none = program(**inputs)
    distance = np.linalg.norm(inputs["position"].astype(float) - inputs["goal"], axis=1)
    near, still = np.exp(-5.0 * distance), 1.0 / (1.0 + inputs["speed"].astype(float) ** 2)
    np.testing.assert_allclose(reward, near + 0.1 * still, rtol=1e-5)
    assert none == {}
    np.testing.assert_array_equal(success, distance < 0.05)
    assert reward.dtype == np.float32 and success.dtype == bool and reward.shape == (count,)


def test_components():
    program = sw.rewards.compile(COMPONENTS, shapes={"position": [3], "speed": []})
    inputs = batch(9)
    del inputs["goal"]
    reward, success, components = program(**inputs)
    near = np.exp(-5.0 * np.linalg.norm(inputs["position"].astype(float), axis=1))
    assert success is None and list(components) == ["near", "still"]
    np.testing.assert_allclose(components["near"], near, rtol=1e-5)
    np.testing.assert_allclose(reward, components["near"] + 0.1 * components["still"], rtol=1e-6)


def test_torch(program):
    torch = pytest.importorskip("torch")
    inputs = batch(100)
    reward, success, _ = program(**{key: torch.from_numpy(value) for key, value in inputs.items()})
    expected, expected_success, _ = program(**inputs)
    assert isinstance(reward, torch.Tensor) and success.dtype == torch.bool
    np.testing.assert_array_equal(reward.numpy(), expected)
    np.testing.assert_array_equal(success.numpy(), expected_success)


def test_threads_do_not_matter(program):
    inputs = batch(5000)
    results = []
    try:
        for threads in (1, 2):
            sw.set_threads(threads)
            results.append(program(**inputs)[0])
    finally:
        sw.set_threads(0)
    np.testing.assert_array_equal(*results)


def test_a_program_of_a_scene(tmp_path):
    made = sw.assets.library("microwave", tmp_path, check=False)[0]
    source = """
def compute_reward(env):
    angle = env.get_joint_state("microwave_1", "door_joint")
    return angle, angle > 0.5
"""
    joints = [joint["name"] for joint in sw.assets.read(made["folder"]).joints]
    program = sw.rewards.compile(source.replace("door_joint", joints[0]),
                                 assets=[str(made["folder"])])
    assert [slot["key"] for slot in program.inputs] == [f"joint_state/microwave_1/{joints[0]}"]
    angles = np.array([0.1, 0.9], np.float32)
    reward, success, _ = program({program.inputs[0]["key"]: angles})
    np.testing.assert_array_equal(reward, angles)
    assert success.tolist() == [False, True]


def test_errors(program):
    with pytest.raises(sw.Error, match="line|2:|3:"):
        sw.rewards.compile("def compute_reward(x):\n    return undefined_name\n")
    inputs = batch(5)
    with pytest.raises(sw.Error, match="'speed'.*missing"):
        program(position=inputs["position"], goal=inputs["goal"])
    with pytest.raises(sw.Error, match="'height'"):
        program(**inputs, height=np.zeros(5))
    with pytest.raises(sw.Error, match="'goal'.*12 numbers"):
        program(**{**inputs, "goal": inputs["goal"][:4]})
    with pytest.raises(sw.Error, match="real|array"):
        program(**{**inputs, "speed": object()})
    with pytest.raises(sw.Error, match="batch of 0"):
        program(**{key: value[:0] for key, value in inputs.items()})
    with pytest.raises(sw.Error, match="count: is 2.5"):
        program(inputs, count=2.5)


def test_tensors_without_a_counterpart_are_refused(program):
    torch = pytest.importorskip("torch")
    inputs = {key: torch.from_numpy(value) for key, value in batch(4).items()}
    with pytest.raises(sw.Error, match=r"'speed'.*speed\.detach\(\)"):
        program({**inputs, "speed": inputs["speed"].clone().requires_grad_()})
    with pytest.raises(sw.Error, match="'speed'.*BFloat16.*float32"):
        program({**inputs, "speed": inputs["speed"].to(torch.bfloat16)})


SQUARE = "def compute_reward(x, y):\n    return x * x\n"


@pytest.mark.parametrize("arguments, word", [
    (dict(source=None), "source.*NoneType"), (dict(source=SQUARE.encode()), "source.*bytes"),
    (dict(shapes={"zz": [3]}), "'zz' is no parameter of compute_reward.*x"),
    (dict(shapes={"x": 3}), "shapes: 'x'"), (dict(shapes={"x": [2.5]}), "shapes: 'x'"),
    (dict(shapes=[3]), "shapes"), (dict(assets="nope"), "nope"), (dict(assets=3), "assets"),
    (dict(entry=None), "entry"),
])
def test_compile_refuses(arguments, word):
    with pytest.raises(sw.Error, match=word):
        sw.rewards.compile(**{"source": SQUARE, **arguments})
    # A parameter that the program does not read has a shape too.
    assert sw.rewards.compile(SQUARE, shapes={"y": [3]}).entry == "compute_reward"
