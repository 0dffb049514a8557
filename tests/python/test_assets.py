"""Assets: what Python reads is what the files say."""

import json
import xml.etree.ElementTree as xml

import numpy as np
import pytest

import simwright as sw
from conftest import SOURCE


def test_a_library_asset(mugs):
    asset = sw.assets.read(mugs / "mug_1")
    urdf = xml.parse(mugs / "mug_1" / "mug_1.urdf").getroot()
    inertial = urdf.find("link/inertial")
    assert asset.mass == pytest.approx(float(inertial.find("mass").get("value")), rel=1e-6)
    stated = inertial.find("inertia")
    assert asset.inertia[0, 0] == pytest.approx(float(stated.get("ixx")), rel=1e-5)
    assert asset.category == "mug" and len(asset.parts) > 1
    volume = sw.geometry.mass_properties(asset.solid, 1.0).volume
    assert asset.volume == pytest.approx(volume, rel=1e-6)
    assert asset.solid.bounds[0, 2] == pytest.approx(0.0, abs=1e-3)
    image = sw.render.render(asset.visual, sw.render.orbit_camera((0, 0, 0.05), 0.4, 0.5, 0, 0.5, 64, 64))
    assert image["mask"].mean() > 0.1


def test_import_a_mesh(tmp_path):
    made = sw.assets.import_assets(SOURCE / "examples" / "chair.obj", tmp_path, category="chair")
    assert len(made) == 1 and made[0]["refusal"] == "" and "pass" in made[0]["grade"]
    checked = sw.assets.check(made[0]["folder"])
    assert checked["passed"] is True
    with pytest.raises(sw.Error, match="exists"):
        sw.assets.import_assets([SOURCE / "examples" / "chair.obj"], tmp_path, category="chair")


def test_an_articulated_asset(tmp_path):
    made = sw.assets.library("microwave", tmp_path, check=False)[0]
    asset = sw.assets.read(made["folder"])
    assert isinstance(asset, sw.assets.ArticulatedAsset)
    door = next(joint for joint in asset.joints if joint["type"] == "revolute")
    closed, opened = asset.visual(), asset.visual({door["name"]: door["upper"]})
    assert np.abs(closed.mesh.vertices - opened.mesh.vertices).max() > 0.1
    described = json.loads((tmp_path / "microwave_1" / "asset.json").read_text())
    assert described["name"] == asset.name
    assert sum(link.mass for link in asset.links) > 1.0


def test_physics():
    mug = sw.physics.sample("coffee mug", seed=3)
    assert mug["category"] == "coffee mug"
    assert mug["mass"]["min"] <= mug["mass"]["sample"] <= mug["mass"]["max"]
    assert mug == sw.physics.sample("coffee mug", seed=3)
    assert "mug" in sw.physics.categories()
    with pytest.raises(sw.Error, match="flumph"):
        sw.physics.sample("flumph zzz")


def test_progress_is_reported(tmp_path):
    seen = []
    sw.assets.library("apple", tmp_path, count=3, check=False,
                      progress=lambda *state: seen.append(state))
    names = {state[0] for state in seen}
    assert "" in names and len(names) > 1
    last = [state for state in seen if state[0]][-1]
    assert last[2] == last[3] > 0  # all steps done


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_a_progress_function_that_fails_is_not_fatal(tmp_path):
    def broken(*state):
        raise ValueError("a bar that breaks")

    made = sw.assets.library("apple", tmp_path, check=False, progress=broken)
    assert made[0]["refusal"] == ""


def test_lift_refuses_what_it_cannot_read(tmp_path):
    (tmp_path / "photo.png").write_bytes(b"not a picture")
    with pytest.raises(sw.Error, match="photo.png"):
        sw.assets.lift(tmp_path / "photo.png", "apple", tmp_path / "out")
    with pytest.raises(sw.Error, match="shape"):
        sw.assets.lift(SOURCE / "examples" / "apple.jpg", "apple", tmp_path / "out", shape="cube")
    with pytest.raises(sw.Error):
        sw.assets.read(tmp_path)
    with pytest.raises(sw.Error):
        sw.assets.check("/nowhere")


@pytest.mark.parametrize("arguments, word", [
    (dict(seed=-1), "seed"), (dict(seed=1.5), "seed"), (dict(count=0), "count"),
    (dict(count="two"), "count"), (dict(kind=None), "kind"), (dict(output=""), "output.*empty"),
])
def test_library_refuses(arguments, word, tmp_path):
    with pytest.raises(sw.Error, match=word):
        sw.assets.library(**{"kind": "apple", "output": tmp_path / "out", **arguments})
    with pytest.raises(sw.Error, match="unit"):
        sw.assets.import_assets("chair.obj", tmp_path / "out", unit="mm")
    assert not (tmp_path / "out").exists()


def test_lift(tmp_path):
    lifted = sw.assets.lift(SOURCE / "examples" / "apple.jpg", "apple", tmp_path / "apple", fast=True,
                            shape="free")
    asset = sw.assets.read(lifted["folder"])
    assert lifted["silhouette_iou"] > 0.9 and 0.05 < asset.mass < 0.5
