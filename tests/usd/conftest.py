import json

import pytest

from judges import KINDS, run


@pytest.fixture(scope="session")
def assets(tmp_path_factory):
    """By kind: the folder of an asset of the library."""
    folder = tmp_path_factory.mktemp("assets") / "library"
    run("library", "--kind", ",".join(KINDS), "--no-check", "-o", folder)
    return {kind: folder / f"{kind}_1" for kind in KINDS}


@pytest.fixture(scope="session")
def exported(assets, tmp_path_factory):
    """By kind: the asset.json of an asset of the library, and its layer."""
    folder = tmp_path_factory.mktemp("usd")
    found = {}
    for kind, asset in assets.items():
        run("export", asset, "--format", "usd", "-o", folder / kind)
        found[kind] = json.loads((asset / "asset.json").read_text()), folder / kind / f"{kind}_1.usda"
    return found


@pytest.fixture(scope="session")
def scenes(tmp_path_factory):
    """A folder with two exported scenes of steamer baskets on a table."""
    folder = tmp_path_factory.mktemp("scenes")
    run("scene", "generate", "--type", "dimsum", "--count", 2, "-o", folder / "data")
    run("scene", "export", folder / "data", "--format", "usd", "-o", folder / "worlds")
    return folder / "worlds"


@pytest.fixture(scope="session")
def worlds(assets, tmp_path_factory):
    """By format: the folder of the world of a task with the Panda, the microwave and other objects."""
    folder = tmp_path_factory.mktemp("worlds")
    run("tasks", assets["microwave"], "--count", 6, "-o", folder / "tasks.json")
    task = json.loads((folder / "tasks.json").read_text())["tasks"][0]["name"]
    for kind in ("usd", "mjcf"):
        run("export", folder / "tasks.json", "--world", "--task", task, "--format", kind,
            "-o", folder / kind)
    return {kind: folder / kind for kind in ("usd", "mjcf")}
