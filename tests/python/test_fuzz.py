"""Arguments of any kind raise exceptions; none crashes the interpreter."""

import gymnasium
import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import simwright as sw
from simwright import _core, envs

FAST = settings(max_examples=60, deadline=None,
                suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])
# Functions of the package say what is wrong with an argument; classes of the compiled module are
# called as they are.
STATED = (sw.Error, gymnasium.error.Error)
ALLOWED = (*STATED, TypeError, ValueError, OverflowError)

arrays = hnp.arrays(dtype=st.sampled_from([np.float64, np.float32, np.int32, np.int64, bool, "U3",
                                           np.complex128, object]),
                    shape=hnp.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=8))
anything = st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=8),
                     st.binary(max_size=8), st.lists(st.integers(), max_size=3), arrays)


def attempt(call, *arguments, **named):
    compiled = getattr(call, "__module__", "") == "simwright._core"
    try:
        return call(*arguments, **named)
    except ALLOWED if compiled else STATED:
        return None


_env = None


def environment():
    global _env
    if _env is None:
        _env = envs.SkillVectorEnv(num_envs=2, cell="open_drawer", instances=4)
    return _env


@FAST
@given(vertices=anything, triangles=anything, density=anything)
def test_meshes(vertices, triangles, density):
    mesh = attempt(sw.mesh, vertices, triangles)
    attempt(_core.Mesh, vertices, triangles)
    if mesh is not None:
        attempt(sw.geometry.mass_properties, mesh, density)
        attempt(sw.geometry.make_solid, mesh)
        attempt(sw.render.DifferentiableRenderer, mesh, colors=vertices)


@FAST
@given(vertices=hnp.arrays(np.float64, st.tuples(st.integers(0, 8), st.just(3)),
                           elements=st.floats(-2, 2)),
       triangles=hnp.arrays(np.int32, st.tuples(st.integers(0, 8), st.just(3)),
                            elements=st.integers(-1, 8)))
def test_nearly_valid_meshes(vertices, triangles):
    mesh = attempt(sw.mesh, vertices, triangles)
    if mesh is None:
        return
    attempt(sw.geometry.mass_properties, mesh, 1.0)
    attempt(sw.geometry.decompose, mesh, max_parts=2)
    attempt(sw.render.render, mesh, sw.render.orbit_camera((0, 0, 0), 3.0, 0.3, 0.1, 0.8, 16, 16))


@FAST
@given(action=anything, seed=anything)
def test_environments(action, seed):
    env = environment()
    attempt(env.reset, seed=seed)
    env.reset(seed=1)
    attempt(env.step, action)
    observations = env.step(np.zeros((2, 7), np.float32))[0]
    assert np.isfinite(observations).all()


@FAST
@given(text=st.one_of(anything, st.text(max_size=200)), value=anything)
def test_texts(text, value):
    attempt(sw.rewards.compile, text)
    attempt(sw.physics.sample, text, value)
    attempt(sw.skills.load, text)
    attempt(sw.geometry.read_mesh, text)
    attempt(sw.cameras.camera, text, pose=value)
    attempt(sw.cameras.look, value)
    attempt(sw.scenes.SceneObject, text, value)


@FAST
@given(observations=anything, name=st.sampled_from(["open_drawer", "pick_up_cup"]))
def test_policies(observations, name):
    attempt(sw.skills.load(name).act, observations)


PROGRAM = sw.rewards.compile("def compute_reward(x, y):\n    return (x - y) ** 2\n")


@FAST
@given(x=anything, y=anything, count=anything)
def test_rewards(x, y, count):
    attempt(PROGRAM, x=x, y=y, count=count)
    attempt(PROGRAM, x=x, y=y)
