"""The type hints, as mypy sees them: of the package, of a program, and of one with mistakes."""

import ast
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import simwright

PACKAGE = Path(simwright.__file__).parent
PROGRAMS = Path(__file__).parent / "typed"
SETTINGS = """[mypy]
strict = True
show_error_codes = True
# torch alone would take most of the time.
[mypy-torch.*]
follow_imports = skip
[mypy-tqdm.*,h5py.*]
ignore_missing_imports = True
# nanobind writes lists and dicts without their members.
[mypy-simwright._core]
disallow_any_generics = False
[mypy-simwright.autograd]
disallow_subclassing_any = False
"""


@pytest.fixture(scope="module")
def reported(tmp_path_factory):
    """What mypy reports, in one run: by file name, the codes of each line's errors."""
    folder = tmp_path_factory.mktemp("mypy")
    (folder / "mypy.ini").write_text(SETTINGS)
    programs = sorted(PROGRAMS.glob("*.py"))
    package = sorted(PACKAGE.glob("*.py"))
    run = subprocess.run(
        [sys.executable, "-m", "mypy", "--config-file", str(folder / "mypy.ini"), "--cache-dir",
         str(folder / "cache"), "--no-error-summary", "--hide-error-context", "--no-pretty",
         *map(str, package), *map(str, programs)],
        env={**os.environ, "MYPYPATH": str(PACKAGE.parent)}, capture_output=True, text=True,
        timeout=300, cwd=folder)
    assert run.returncode in (0, 1) and run.stderr == "", run.stdout + run.stderr
    found = {}
    for line in run.stdout.splitlines():
        match = re.match(r"(.+?):(\d+): error: .*\[([a-z-]+)\]$", line)
        if match is None:
            assert re.match(r".+?:\d+: note: ", line), line
            continue
        lines = found.setdefault(Path(match[1]).name, {})
        lines.setdefault(int(match[2]), set()).add(match[3])
    return found


def test_the_package_has_no_errors(reported):
    assert {name: lines for name, lines in reported.items()
            if name != "mistaken_program.py"} == {}


def test_each_mistake_is_reported(reported):
    expected = {}
    for number, line in enumerate((PROGRAMS / "mistaken_program.py").read_text().splitlines(), 1):
        match = re.search(r"# error: (.+)$", line)
        if match:
            expected[number] = set(match[1].split(", "))
    assert len(expected) > 20
    assert reported["mistaken_program.py"] == expected


def test_hints_cost_no_import_and_are_python_3_9():
    """The module of the types is not imported, and all modules are Python 3.9."""
    assert "simwright._types" not in sys.modules
    for file in PACKAGE.glob("*.py"):
        ast.parse(file.read_text(), feature_version=(3, 9))


def test_modules_are_imported_at_their_first_use():
    """The attributes of the package that need torch or Stable-Baselines3 cost nothing before."""
    program = """
import sys
import simwright
assert not {"torch", "stable_baselines3", "simwright.demonstrations"} & set(sys.modules)
assert callable(simwright.demonstrations.record) and callable(simwright.envs.SkillEnv)
assert not hasattr(simwright, "nothing")
print(simwright.autograd.render.__module__, simwright.sb3.VecEnv.__name__)
"""
    for needed in ("gymnasium", "stable_baselines3", "torch"):
        pytest.importorskip(needed)
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True,
                         timeout=120, env={**os.environ, "PYTHONPATH": str(PACKAGE.parent)})
    assert run.stdout == "simwright.autograd VecEnv\n", run.stderr


@pytest.mark.parametrize("module", ["assets", "cameras", "demonstrations", "envs", "geometry",
                                    "physics", "render", "rewards", "scenes", "skills", "tasks"])
def test_each_public_function_is_annotated(module):
    """Checks by syntax, apart from mypy, that no argument or result was left out."""
    tree = ast.parse((PACKAGE / f"{module}.py").read_text())
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    assert functions
    for function in functions:
        arguments = function.args.args + function.args.kwonlyargs
        bare = [one.arg for one in arguments
                if one.annotation is None and one.arg not in ("self", "cls")]
        assert not bare and function.returns is not None, f"{module}.{function.name}"
