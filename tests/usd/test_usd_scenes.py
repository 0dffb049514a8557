"""Judges exported scenes: usd-core's checker, and Newton, which finds the objects where they are."""

import json

import numpy as np

from judges import findings, newton_model
from pxr import Usd, UsdGeom, UsdPhysics


def described(folder):
    return json.loads((folder / "scene.json").read_text())["objects"]


def test_the_checker_finds_nothing(scenes):
    for folder in scenes.glob("scene_*"):
        stage = Usd.Stage.Open(str(folder / "scene.usda"))
        assert findings(stage) == []
        root = stage.GetDefaultPrim()
        assert Usd.ModelAPI(root).GetKind() == "assembly"
        for one in described(folder):
            prim = root.GetChild(one["name"])
            assert prim.IsInstance() and Usd.ModelAPI(prim).GetKind() == "component"
            assert prim.GetPrototype().GetChildren()


def test_objects_are_where_the_scene_has_them(scenes):
    for folder in scenes.glob("scene_*"):
        stage = Usd.Stage.Open(str(folder / "scene.usda"))
        cache = UsdGeom.XformCache()
        for one in described(folder):
            prim = stage.GetDefaultPrim().GetChild(one["name"])
            pose = np.array(cache.GetLocalToWorldTransform(prim)).T
            np.testing.assert_allclose(pose[:3, 3], one["translation"], atol=1e-12)
            w, *v = one["quaternion_wxyz"]
            axes = [axis + 2 * w * np.cross(v, axis) + 2 * np.cross(v, np.cross(v, axis))
                    for axis in np.eye(3)]
            np.testing.assert_allclose(pose[:3, :3], np.array(axes).T, atol=1e-12)
            assert prim.HasAPI(UsdPhysics.RigidBodyAPI) != one["welded"]
            assert prim.HasAPI(UsdPhysics.MassAPI) != one["welded"]


def test_newton_reads_bodies_shapes_and_the_floor(scenes):
    for folder in scenes.glob("scene_*"):
        read = newton_model(folder / "scene.usda")
        free = {one["name"]: one for one in described(folder) if not one["welded"]}
        bodies = {label.split("/")[-1]: number for number, label in enumerate(read.body_label)}
        assert set(bodies) == set(free)
        for name, one in free.items():
            asset = json.loads((folder / one["urdf"]).with_name("asset.json").read_text())
            number = bodies[name]
            np.testing.assert_allclose(read.body_mass.numpy()[number], asset["mass"], rtol=1e-6)
            np.testing.assert_allclose(read.body_q.numpy()[number][:3], one["translation"], atol=1e-6)
        labels = [str(label) for label in read.shape_label]
        for one in described(folder):
            assert any(f"/{one['name']}/collision_" in label for label in labels), one["name"]
        assert any(label.endswith("/ground/plane") for label in labels)
