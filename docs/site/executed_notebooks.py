"""Hook of mkdocs: shows the executed copies of notebooks, where there are any.

tests/python/test_notebooks.py writes them to build/notebooks, or to the folder in the variable
SIMWRIGHT_EXECUTED_NOTEBOOKS. A copy of an older notebook is not shown.
"""

import json
import os
from pathlib import Path


def _sources(path):
    """Returns the texts of the cells of a notebook."""
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return ["".join(cell["source"]) for cell in cells]


def on_pre_page(page, config, files):
    """Replaces the source of a notebook's page by the executed copy."""
    source = Path(page.file.abs_src_path)
    if source.suffix != ".ipynb":
        return page
    folder = os.environ.get("SIMWRIGHT_EXECUTED_NOTEBOOKS", "build/notebooks")
    executed = Path(config["config_file_path"]).parent / folder / source.name
    if executed.exists() and _sources(executed) == _sources(source):
        page.file.abs_src_path = str(executed)
    return page
