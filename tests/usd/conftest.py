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
