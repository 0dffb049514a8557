"""Scenes: datasets, feasibility and metrics."""

import numpy as np
import pytest

import simwright as sw


@pytest.fixture(scope="module")
def dimsum(tmp_path_factory, dimsum_assets):
    folder = tmp_path_factory.mktemp("scenes") / "dimsum"
    report = sw.scenes.generate("dimsum", folder, count=3, seed=2, assets=dimsum_assets)
    return folder, report


def test_generated_scenes(dimsum):
    folder, report = dimsum
    scenes = sw.scenes.read(folder)
    assert len(scenes) == 3 == report["scenes"]
    assert sum(map(len, scenes)) / 3 == pytest.approx(report["objects_mean"], rel=1e-6)
    assets = sw.scenes.AssetSet.read(str(folder / "assets"))
    for scene in scenes:
        assert all(one.category in assets for one in scene)
        assert sum(one.welded for one in scene) >= 1
        assert sw.scenes.total_penetration(scene, assets) < 1e-3
    assert len(sw.scenes.read(folder, first=1, count=1)) == 1


def test_apples_that_overlap_are_pushed_apart(mugs):
    assets = sw.scenes.AssetSet.read(str(mugs))
    def at(x):
        pose = np.eye(4)
        pose[0, 3] = x
        return pose

    apples = [sw.scenes.SceneObject("apple", at(0.0)), sw.scenes.SceneObject("apple", at(0.03)),
              sw.scenes.SceneObject("mug", at(0.4))]
    before = sw.scenes.total_penetration(apples, assets)
    assert before > 0.01
    settled = sw.scenes.make_feasible(apples, assets, min_objects=2)
    assert settled["valid"] and settled["penetration"] < 1e-4
    positions = [one.pose[:3, 3] for one in settled["objects"]]
    assert np.linalg.norm(positions[0] - positions[1]) > 0.05
    assert sw.scenes.total_penetration(settled["objects"], assets) < 1e-3


def test_samples_of_a_shipped_model(tmp_path, dimsum_assets):
    report = sw.scenes.sample(tmp_path / "tables", type="dimsum", count=2, steps=20,
                              assets=dimsum_assets)
    assert len(sw.scenes.read(tmp_path / "tables")) == report["scenes"]
    worlds = sw.scenes.export(tmp_path / "tables", tmp_path / "worlds", formats=["mjcf"])
    assert len(worlds["scenes"]) == report["scenes"]
    assert list((tmp_path / "worlds").glob("scene_*/*.xml"))


def test_bad_scenes(mugs, tmp_path):
    assets = sw.scenes.AssetSet.read(str(mugs))
    with pytest.raises(sw.Error, match="sofa"):
        sw.scenes.total_penetration([sw.scenes.SceneObject("sofa", np.eye(4))], assets)
    with pytest.raises(sw.Error, match="pose"):
        sw.scenes.SceneObject("mug", np.zeros((4, 4)))
    with pytest.raises(sw.Error):
        sw.scenes.generate("opera", tmp_path / "x", count=1)
    with pytest.raises(sw.Error, match="opera"):
        sw.scenes.sample(tmp_path / "x", type="opera")
    with pytest.raises(sw.Error):
        sw.scenes.read(tmp_path)
    with pytest.raises(sw.Error, match="seed"):
        sw.scenes.generate("dimsum", tmp_path / "x", count=1, seed=-1)
    with pytest.raises(sw.Error, match="count"):
        sw.scenes.sample(tmp_path / "x", type="dimsum", count=1.5)
    with pytest.raises(sw.Error, match="objects.*SceneObject"):
        sw.scenes.total_penetration(["mug"], assets)
    with pytest.raises(sw.Error, match="assets.*AssetSet"):
        sw.scenes.make_feasible([], str(mugs))
    assert not (tmp_path / "x").exists()
    assert "dimsum" in sw.scenes.types()
