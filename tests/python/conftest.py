"""What the tests share: a cache of their own, and objects that take seconds to make."""

import os
import shutil
from pathlib import Path

import numpy as np
import pytest

SOURCE = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session", autouse=True)
def cache(tmp_path_factory):
    """Keeps the cells of the tests apart from the user's. Under ctest, the test programs share
    them, and they are made again for each build of the compiled module."""
    shared = os.environ.get("SIMWRIGHT_TEST_CACHE")
    if shared:
        from simwright import _core

        folder = Path(shared) / str(os.stat(_core.__file__).st_mtime_ns)
        folder.mkdir(parents=True, exist_ok=True)
        for other in Path(shared).iterdir():
            if other != folder:
                shutil.rmtree(other, ignore_errors=True)
    else:
        folder = tmp_path_factory.mktemp("cache")
    os.environ["SIMWRIGHT_CACHE"] = str(folder)
    return folder


@pytest.fixture(scope="session", autouse=True)
def silent():
    import simwright

    simwright.set_progress(False)


@pytest.fixture(scope="session")
def cube():
    """The unit cube from 0 to 1, closed and outward."""
    import simwright

    vertices = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return simwright.mesh(vertices, triangles)


@pytest.fixture(scope="session")
def dimsum_assets(tmp_path_factory):
    """The folder of the library's assets of the scene type dimsum."""
    import simwright

    folder = tmp_path_factory.mktemp("scenes") / "raw"
    simwright.scenes.generate("dimsum", folder, count=1, raw=True)
    return folder / "assets"


@pytest.fixture(scope="session")
def mugs(tmp_path_factory):
    """A folder with a mug and an apple of the library."""
    import simwright

    folder = tmp_path_factory.mktemp("assets")
    made = simwright.assets.library("mug,apple", folder, check=False)
    assert [outcome["refusal"] for outcome in made] == ["", ""]
    return folder
