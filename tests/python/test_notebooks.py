"""Executes the notebooks of docs/notebooks with quick settings, by this interpreter.

Their last cells assert figures. With SIMWRIGHT_EXECUTED_NOTEBOOKS the executed copies, with their
pictures, are written to that folder.
"""

import importlib.util
import os
import sys
from pathlib import Path

import pytest

from conftest import SOURCE

nbclient = pytest.importorskip("nbclient", reason="nbclient is missing (requirements.txt)")
import nbformat  # noqa: E402
from jupyter_client.kernelspec import KernelSpec, KernelSpecManager  # noqa: E402
from jupyter_client.manager import AsyncKernelManager  # noqa: E402

FOLDER = SOURCE / "docs" / "notebooks"
# The most code cells of a notebook, and the fewest pictures that it shows.
MOST_CELLS = 12
PICTURES = {"photo_to_asset": 4, "reward_to_policy": 5, "scene_to_simulator": 4, "lerobot": 3}
# The package that a notebook needs beside those of requirements.txt.
NEEDS = {"lerobot": "lerobot"}
CELL_SECONDS = 300


class CurrentInterpreter(KernelSpecManager):
    """Starts kernels by this interpreter, whatever kernels are installed."""

    def get_kernel_spec(self, kernel_name):
        return KernelSpec(argv=[sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"],
                          display_name=kernel_name, language="python")


def execute(notebook, folder):
    """Executes a notebook in a folder, in place; raises CellExecutionError if a cell raises."""
    manager = AsyncKernelManager(kernel_name="python3",
                                 kernel_spec_manager=CurrentInterpreter())
    client = nbclient.NotebookClient(notebook, km=manager, timeout=CELL_SECONDS,
                                     resources={"metadata": {"path": str(folder)}})
    client.execute()
    return notebook


def read(name):
    return nbformat.read(FOLDER / f"{name}.ipynb", as_version=4)


def code_cells(notebook):
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def outputs(notebook):
    return [output for cell in code_cells(notebook) for output in cell.outputs]


def pictures(notebook):
    return sum("image/png" in output.get("data", {}) for output in outputs(notebook))


def printed(notebook):
    return "".join(output.text for output in outputs(notebook) if output.output_type == "stream")


def new_notebook(*sources):
    return nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(text) for text in sources])


def test_kernels_are_of_this_interpreter(tmp_path):
    notebook = execute(new_notebook("import os, sys\nprint(sys.executable, os.getcwd())"), tmp_path)
    assert printed(notebook).split() == [sys.executable, str(tmp_path)]


def test_a_cell_that_raises_fails(tmp_path):
    with pytest.raises(nbclient.exceptions.CellExecutionError, match="ZeroDivisionError"):
        execute(new_notebook("print(1)", "1 / 0"), tmp_path)


def test_all_notebooks_are_executed():
    assert {path.stem for path in FOLDER.glob("*.ipynb")} == set(PICTURES)


@pytest.mark.parametrize("name", PICTURES)
def test_notebooks_are_small_and_without_outputs(name):
    notebook = read(name)
    nbformat.validate(notebook)
    cells = code_cells(notebook)
    assert 0 < len(cells) <= MOST_CELLS
    assert all(not cell.outputs and cell.execution_count is None for cell in cells)
    assert "assert " in cells[-1].source
    assert (FOLDER / f"{name}.ipynb").stat().st_size < 30_000


@pytest.mark.parametrize("name", PICTURES)
def test_notebook(name, tmp_path, monkeypatch):
    if name in NEEDS and importlib.util.find_spec(NEEDS[name]) is None:
        pytest.skip(f"{NEEDS[name]} is missing (tests/python/peers)")
    monkeypatch.setenv("SIMWRIGHT_NOTEBOOK_QUICK", "1")
    monkeypatch.delenv("MPLBACKEND", raising=False)  # the kernel's own shows pictures
    notebook = execute(read(name), tmp_path)
    kept = os.environ.get("SIMWRIGHT_EXECUTED_NOTEBOOKS")
    if kept:
        Path(kept).mkdir(parents=True, exist_ok=True)
        unfinished = Path(kept) / f"{name}.unfinished"
        nbformat.write(notebook, unfinished)
        unfinished.replace(Path(kept) / f"{name}.ipynb")
    assert all(cell.execution_count for cell in code_cells(notebook))
    assert pictures(notebook) >= PICTURES[name]
