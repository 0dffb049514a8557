"""A program of a user; it is type-checked, not run. mypy --strict must accept it."""

from __future__ import annotations

from pathlib import Path
from typing import Iterator

import gymnasium
import numpy as np
from numpy.typing import NDArray

import simwright
from simwright import cameras, demonstrations, envs, rewards, scenes, skills
from simwright.sb3 import VecEnv


def show(name: str, detail: str, done: int, total: int, elapsed: float) -> None:
    print(f"{name} {detail}: {done}/{total}, {elapsed:.1f} s")


def weigh(folder: Path) -> float:
    """Returns the mass, kg, of what the library makes."""
    mass = 0.0
    for outcome in simwright.assets.library("mug,microwave", folder, count=2, progress=show):
        if outcome["folder"] is None:
            print(outcome["refusal"], [finding.sentence for finding in outcome["findings"]])
            continue
        asset = simwright.assets.read(outcome["folder"])
        if isinstance(asset, simwright.assets.Asset):
            mass += asset.mass
        else:
            mass += sum(link.mass for link in asset.links)
            print([joint["name"] for joint in asset.joints])
    return mass


def inertia(vertices: list[list[float]], triangles: NDArray[np.int32]) -> NDArray[np.float64]:
    solid, facts = simwright.geometry.make_solid(simwright.mesh(vertices, triangles))
    parts, decomposition = simwright.geometry.decompose(solid, max_parts=8)
    print(facts["method"], len(parts), parts[0].area, decomposition["concavity"])
    return simwright.geometry.mass_properties(solid, 600.0, wall_thickness=0.002).inertia


def picture(mesh: simwright.Mesh) -> NDArray[np.uint8]:
    camera = simwright.render.orbit_camera((0, 0, 0.05), 0.4, 0.5, 0.0, 0.8, 64, 64)
    renderer = simwright.render.DifferentiableRenderer(mesh, colors=np.ones((8, 3)))
    image = renderer.render(camera)
    light = renderer.backward(color=np.ones_like(image["color"]))["light"]
    print(light.shape, simwright.physics.sample("mug")["mass"]["sample"])
    return simwright.render.render([mesh], camera)["color"]


def act(folder: Path) -> Iterator[float]:
    """Yields the rewards of an episode."""
    side = cameras.camera("side", position=(0.5, 1.2, 0.6), target=np.array([0.5, 0.0, 0.2]))
    policy = skills.load("open_drawer")
    env = envs.SkillEnv("open_drawer", cameras=["wrist", side], images=["rgb", "depth"],
                        look={"tint": 0.2}, render_mode="rgb_array",
                        action_space=policy.action_space)
    observation, _ = env.reset(seed=1)
    ended = False
    while not ended:
        action = policy.act(observation["state"][None])[0]
        observation, reward, terminated, truncated, info = env.step(action)
        ended = terminated or truncated or bool(info["success"])
        yield reward
    print(env.state()["gripper_pose"], env.camera("side")["intrinsics"][0], env.render().shape)
    many = envs.SkillVectorEnv(64, cell="open_drawer", action_space="osc_delta")
    _, gains, *_ = many.step(np.zeros((64, 7)))
    yield float(gains.mean())
    model_env = VecEnv(gymnasium.make_vec("simwright/OpenDrawer-v0", num_envs=4))
    print(model_env.num_envs, skills.evaluate("open_drawer", policy=policy)["interval"])
    episodes = demonstrations.record("open_drawer", 3, policy=policy, cameras="front", seed=2)
    print(demonstrations.write_robomimic(folder / "drawers.hdf5", episodes)["steps"])


def clutter(folder: Path) -> list[float]:
    """Returns the penetrations, m, of settled scenes."""
    try:
        report = scenes.generate("dimsum", folder, count=3, assets=[folder / "assets"])
    except simwright.Error as error:
        print(error.where)
        return []
    print(report["scenes"])
    assets = scenes.AssetSet.read(folder)
    found = []
    for objects in scenes.read(folder, first=1):
        settled = scenes.make_feasible(objects, assets, progress=False)
        found.append(scenes.total_penetration(settled["objects"], assets))
    scenes.export(folder, folder / "worlds", formats=["mjcf", "sdf"])
    return found


program = rewards.compile("def reward(x):\n    return x * x\n", shapes={"x": []})
reward, success, components = program({"x": np.zeros(4, np.float32)})
print(program.entry, program.inputs[0]["width"], simwright.__version__, simwright.threads())
