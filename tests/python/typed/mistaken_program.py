"""A program with mistakes; it is type-checked, not run. mypy must report each line that has a
comment `error`, with the codes stated there, and no other line."""

import numpy as np

import simwright
from simwright import cameras, demonstrations, envs, scenes, skills

simwright.assets.read(3)  # error: arg-type
simwright.assets.lift("mug.png", "mug", "out", shape="cube")  # error: arg-type
simwright.assets.library("mug", "out")[0]["fodler"]  # error: typeddict-item
simwright.assets.read("mug").mass  # error: union-attr
simwright.assets.import_assets("mug.obj", "out", hight=0.1)  # error: call-arg
simwright.assets.chek("mug")  # error: attr-defined
mesh = simwright.mesh([[0.0, 0.0, 0.0]], [[0, 0, 0]])
mesh.vertexes  # error: attr-defined
mesh.area = 2.0  # error: misc
simwright.geometry.decompose(mesh, threshold="small")  # error: arg-type
simwright.geometry.mass_properties(mesh, 600.0).inertia.upper()  # error: attr-defined
camera = simwright.render.orbit_camera((0, 0, 0), 1.0, 0.5, 0.0, 0.8, 64, 64)
simwright.render.render("mesh.obj", camera)  # error: arg-type
simwright.physics.sample("mug")["mass"]["mean"]  # error: typeddict-item
env = envs.SkillEnv("open_drawer", action_space="torques")  # error: arg-type
env.step(env.expert_action())  # error: arg-type
env.reset(1)  # error: call-arg
env.state()["gripper"]  # error: typeddict-item
reward: str = env.step(np.zeros(7))[1]  # error: assignment
envs.SkillVectorEnv(cell="open_drawer", images=["colour"])  # error: list-item
cameras.camera("side", width="wide")  # error: arg-type
skills.load("open_drawer").forward(np.zeros((1, 8)))  # error: attr-defined
skills.evaluate("open_drawer", split="test")  # error: arg-type
scenes.export("dimsum", "worlds", formats=["gltf"])  # error: list-item
scenes.make_feasible(scenes.read("dimsum"), scenes.AssetSet.read("set"))  # error: arg-type
scenes.generate("dimsum", "out", progress=lambda name: None)  # error: arg-type, misc
demonstrations.record("open_drawer", keep="failures")  # error: arg-type
next(demonstrations.record("open_drawer")).jonts  # error: attr-defined
