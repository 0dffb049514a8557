"""What environments, cameras and evaluations refuse, before they make any object."""

import numpy as np
import pytest

import simwright as sw
from simwright import envs

DRAWER = dict(cell="open_drawer", instances=4)


def test_bad_settings():
    for kwargs, word in [(dict(cell="fly"), "fly"), (dict(), "cell"), (dict(**DRAWER, split="x"), "split"),
                         (dict(cell="open_drawer", instances=0), "instances"),
                         (dict(**DRAWER, action_space="thought"), "thought"),
                         (dict(**DRAWER, cameras=["back"]), "back"),
                         (dict(**DRAWER, cameras=["front"], images=["heat"]), "heat"),
                         (dict(**DRAWER, look={"fog": 1}), "fog"),
                         (dict(**DRAWER, look={"tint": 7.0}, cameras=["front"]), "tint"),
                         (dict(**DRAWER, render_mode="human"), "human"),
                         (dict(**DRAWER, episode_seconds=-1.0), "episode"),
                         (dict(**DRAWER, subtask=3), "subtask"),
                         (dict(**DRAWER, subtask=1.5), "subtask"),
                         (dict(cell="open_drawer", instances=2.5), "instances"),
                         (dict(**DRAWER, task="zz"), "no task 'zz'"),
                         (dict(**DRAWER, finger_friction=1.0), "finger_friction: is 1.0"),
                         (dict(**DRAWER, proved_grasps=1), "proved_grasps: is 1"),
                         (dict(**DRAWER, cameras=3), "cameras"),
                         (dict(**DRAWER, cameras=[None]), "None"),
                         (dict(**DRAWER, images=["heat"]), "heat"),
                         (dict(**DRAWER, cameras="front", images=[]), "images: is empty"),
                         (dict(**DRAWER, cameras="front", image_size=64.5), "image_size"),
                         (dict(**DRAWER, cameras="front", image_size=(64,)), "image_size"),
                         (dict(**DRAWER, cameras="front", image_size=None), "image_size"),
                         (dict(**DRAWER, cameras="front", image_size=(64, 0)), "image_size.*height"),
                         (dict(**DRAWER, render_mode="rgb_array", render_size=64), "render_size")]:
        with pytest.raises(sw.Error, match=word):
            envs.SkillEnv(**kwargs)
    for count in (0, 2.5, "two"):
        with pytest.raises(sw.Error, match="num_envs"):
            envs.SkillVectorEnv(num_envs=count, **DRAWER)
    with pytest.raises(sw.Error, match="render"):
        envs.SkillEnv(**DRAWER).render()


def test_images_have_keys_of_their_own():
    view = dict(position=(0.5, 1.2, 0.6), target=(0.5, 0.0, 0.2), width=16, height=16)
    named = [sw.cameras.camera("front_depth", **view), "front"]
    with pytest.raises(sw.Error, match="'front_depth' and one of 'front'.*key 'front_depth'"):
        envs.SkillEnv(**DRAWER, cameras=named, images=["depth", "rgb"])
    with pytest.raises(sw.Error, match="two cameras are called 'wrist'"):
        envs.SkillVectorEnv(2, **DRAWER, cameras=["wrist", "wrist"])
    both = envs.SkillEnv(**DRAWER, cameras=named, image_size=16, images=["rgb", "rgb"])
    assert set(both.reset(seed=1)[0]) == {"state", "front", "front_depth"}


def test_an_episode_has_to_begin():
    single, vector = envs.SkillEnv(**DRAWER), envs.SkillVectorEnv(2, **DRAWER)
    for env, shape in ((single, 7), (vector, (2, 7))):
        with pytest.raises(sw.Error, match="not begun"):
            env.step(np.zeros(shape))
        for seed in (2**64, -1, 1.5, "one"):
            with pytest.raises(sw.Error, match="seed: is"):
                env.reset(seed=seed)
    with pytest.raises(sw.Error, match="seed: is -2"):
        vector.reset(seed=[1, -2])
    first = single.reset(seed=2**64 - 1)[0]
    np.testing.assert_array_equal(first, vector.reset(seed=np.uint64(2**64 - 1))[0][0])


@pytest.mark.parametrize("arguments, word", [
    (dict(position=(0, 0, 1), target=(0, 0, 0)), "'top'.*another up"),
    (dict(position=(0, 0, 1), target=(0, 0, 1)), "'top'.*own position"),
    (dict(position=(0, 0), target=(0, 0, 1)), "'top': position.*shape"),
    (dict(pose=np.eye(4), width=2.5), "'top': width"), (dict(pose=np.eye(4), mount=3), "mount"),
    (dict(pose=np.eye(4), vertical_fov="wide"), "vertical_fov"),
])
def test_bad_cameras(arguments, word):
    with pytest.raises(sw.Error, match=word):
        sw.cameras.camera("top", **arguments)


def test_bad_default_cameras_and_looks():
    with pytest.raises(sw.Error, match="width: is -1"):
        sw.cameras.defaults(-1, 0)
    for look in ("narrow", 3, {"wide": 1.0}, {"tint": "red"}, {"tint": 5}, {"shadow": (0.1,)}):
        with pytest.raises(sw.Error, match="look: "):
            sw.cameras.look(look)


@pytest.mark.parametrize("arguments, word", [
    (dict(seed=-1), "seed"), (dict(episodes=0), "episodes"), (dict(episodes=-1), "episodes"),
    (dict(policy=3), "policy: is 3"), (dict(policy="random"), "random"), (dict(skill="fly"), "fly"),
])
def test_evaluate_refuses(arguments, word, monkeypatch):
    monkeypatch.setattr(sw.skills, "cell_tasks", None)  # no object is made before
    with pytest.raises(sw.Error, match=word):
        sw.skills.evaluate(**{"skill": "open_drawer", **arguments})


def test_evaluate_refuses_a_policy_of_another_skill(monkeypatch):
    names = sw.skills.names()
    sizes = {name: sw.skills.load(name).observation_size for name in names}
    other = next(name for name in names if sizes[name] != sizes["open_drawer"])
    monkeypatch.setattr(sw.skills, "cell_tasks", None)
    with pytest.raises(sw.Error, match="policy: takes .* open_drawer has 70"):
        sw.skills.evaluate("open_drawer", policy=sw.skills.load(other))


def test_wilson_intervals():
    # Against the roots of the score equation (p - 0.8)^2 = z^2 p (1 - p) / 10.
    z = 1.959963984540054
    middle, root = (0.8 + z * z / 20) / (1 + z * z / 10), z * np.sqrt(0.016 + z * z / 400)
    low, high = sw.skills.wilson_interval(8, 10)
    assert low == pytest.approx(middle - root / (1 + z * z / 10), abs=1e-3)
    assert high == pytest.approx(middle + root / (1 + z * z / 10), abs=1e-3)
    for successes, count in [(11, 10), (-1, -1), (-1, 10), (1.5, 10)]:
        with pytest.raises(sw.Error, match="successes|count"):
            sw.skills.wilson_interval(successes, count)
