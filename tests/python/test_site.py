"""The documentation site builds without a warning and shows every public name of the package."""

import html
import importlib
import inspect
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import simwright as sw
from conftest import SOURCE

pytest.importorskip("mkdocs", reason="mkdocs is missing (requirements.txt)")
MODULES = [path.stem for path in (SOURCE / "docs" / "api").glob("*.md")] + ["autograd", "sb3"]
PAGES = {"autograd": "render", "sb3": "envs"}


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    package = Path(sw.__file__).parent.parent
    subprocess.run([sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--config-file",
                    SOURCE / "mkdocs.yml", "--site-dir", folder], check=True,
                   env={**os.environ, "SIMWRIGHT_PACKAGE": str(package), "NO_MKDOCS_2_WARNING": "1"})
    return folder


def text_of(page):
    """Returns the words of a page, without markup."""
    main = page.read_text(encoding="utf-8").split("<article", 1)[1].split("</article>", 1)[0]
    return " ".join(html.unescape(re.sub("<[^>]*>", "", main)).split())


def ids_of(page):
    return set(re.findall(r' id="([^"]+)"', page.read_text(encoding="utf-8")))


@pytest.mark.parametrize("name", MODULES)
def test_public_names_are_shown(site, name):
    module = sw if name == "simwright" else importlib.import_module("simwright." + name)
    ids = ids_of(site / "api" / PAGES.get(name, name) / "index.html")
    public = [one for one in module.__all__ if not inspect.ismodule(getattr(module, one))]
    assert public
    missing = [one for one in public if f"{module.__name__}.{one}" not in ids]
    assert not missing, f"{name}: {missing} are not on the page"


@pytest.mark.parametrize("name", ["assets.Asset.parts", "cameras.LookRanges.tint", "geometry.Mesh.vertices",
                                  "render.Camera.pose", "scenes.SceneObject.welded", "skills.Policy.act"])
def test_compiled_classes_show_their_members(site, name):
    assert f"simwright.{name}" in ids_of(site / "api" / name.split(".")[0] / "index.html")


@pytest.mark.parametrize("path", sorted((SOURCE / "docs" / "notebooks").glob("*.ipynb")),
                         ids=lambda path: path.stem)
def test_notebooks_are_pages(site, path):
    shown = text_of(site / "notebooks" / path.stem / "index.html")
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        line = cell["source"][-1].strip()
        words = " ".join(re.sub(r"[`#]", "", line).split()) if cell["cell_type"] == "markdown" else line
        assert " ".join(words.split()) in shown, line
