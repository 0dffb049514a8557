"""Reward programs: a restricted Python, compiled and run over batches of environments."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING, Any, Iterable, Mapping

from . import _arguments as checked
from . import _core

if TYPE_CHECKING:
    from ._types import Float32Array, Paths, RewardInput

__all__ = ["Program", "compile"]


def _is_tensor(value: object) -> bool:
    return type(value).__module__.split(".")[0] == "torch"


class Program:
    """A compiled reward function. Constant and thread-safe.

    Attributes:
        entry (str): the function's name.
        inputs (list of dict): what it reads: ``key``, ``shape``, ``width``, ``uniform`` ...
        has_success (bool): whether it returns success.
        operations (int): instructions per environment.
        findings (list of Finding): what the compiler has to say.
    """

    def __init__(self, program: _core.RewardProgram) -> None:
        self._program = program
        self.entry: str = program.entry
        self.inputs: list[RewardInput] = program.slots
        self.has_success: bool = program.has_success
        self.operations: int = program.operations
        self.findings: list[_core.Finding] = program.findings
        self._keys = {slot["key"]: slot for slot in self.inputs}

    def __repr__(self) -> str:
        return f"Program({self.entry}, reads {', '.join(self._keys) or 'nothing'})"

    def __call__(self, inputs: Mapping[str, Any] | None = None, count: int | None = None,
                 **parameters: Any) -> tuple[Any, Any, dict[str, Any]]:
        """Computes rewards.

        Args:
            inputs (dict): key to numpy array or torch tensor (main memory), float32: (N, width), or
                (N) where the width is 1; inputs that are the same for all environments are numbers.
                Parameters of the function may be given by name instead.
            count (int): N; None: from the arrays.

        Returns:
            (reward, success, components): reward (N) float32; success (N) bool or None; components
            name to (N) or (N, width). Tensors if an input is a tensor, which shares their memory.

        Raises:
            Error: for an input that is missing, unknown, of another shape or type, or that requires
                a gradient, which rewards do not have.
        """
        given = dict(checked.mapping("inputs", inputs))
        given.update(parameters)
        torch_used = any(_is_tensor(value) for value in given.values())
        arrays = {}
        for key, value in given.items():
            if key not in self._keys:
                raise _core.Error(f"the input {key!r}: is not read by the program (it reads "
                                  f"{', '.join(self._keys) or 'nothing'})")
            arrays[key] = self._array(key, value)
        if count is None:
            count = max([array.shape[0] for key, array in arrays.items()
                         if not self._keys[key]["uniform"]], default=1)
            if count == 0:
                raise _core.Error("the inputs: are a batch of 0 (give at least one environment)")
        reward, success, components = self._program.run(arrays, checked.integer("count", count, 1))
        if not torch_used:
            return reward, success, components
        import torch

        return (torch.from_numpy(reward), None if success is None else torch.from_numpy(success),
                {name: torch.from_numpy(array) for name, array in components.items()})

    @staticmethod
    def _array(key: str, value: Any) -> Float32Array:
        import numpy as np

        if _is_tensor(value):
            if value.requires_grad:
                raise _core.Error(f"the input '{key}': requires a gradient, which rewards do not "
                                  f"have (give {key}.detach())")
            if value.device.type != "cpu":
                raise _core.Error(f"the input '{key}': is on {value.device} (move it to the cpu)")
        try:
            array = np.asarray(value.numpy() if _is_tensor(value) else value)
            if array.dtype.kind not in "fiub":
                raise TypeError(f"its type is {array.dtype}")
            with np.errstate(over="ignore"):
                array = np.ascontiguousarray(array, dtype=np.float32)
        except (TypeError, ValueError, RuntimeError) as error:
            raise _core.Error(f"the input '{key}': is not an array of real numbers: {error} "
                              "(give float32)") from None
        return array if array.ndim > 0 else array.reshape(1)


def compile(source: str, assets: Paths = (), entry: str = "",
            shapes: Mapping[str, Iterable[int]] | None = None) -> Program:
    """Parses, checks and compiles a reward function; Python never runs it.

    Args:
        source (str): its text (docs/rewards.md describes the language).
        assets (path or list of paths): PATH or NAME=PATH of the assets that it names; empty: any name is
            accepted, and joint limits are inputs.
        entry (str): the function; empty: found by its name.
        shapes (dict): trailing shapes of tensor parameters, e.g. {"pos": [3]}; others are inferred.

    Returns:
        Program: called with arrays or tensors.

    Raises:
        Error: for a fault, with its line and column, or a shape of an unknown parameter.
    """
    source = checked.text("source", source)
    sides = {}
    for name, shape in checked.mapping("shapes", shapes).items():
        name = checked.text("shapes", name)
        what = f"shapes: '{name}'"
        sides[name] = [checked.integer(what, side, 1)
                       for side in checked.listed(what, shape, "a list of ints")]
    program = Program(_core.compile_reward(source, checked.paths("assets", assets),
                                           checked.text("entry", entry), sides))
    known = {slot["key"]: None for slot in program.inputs}
    known.update(dict.fromkeys(_parameters(source, program.entry)))
    for name in sides:
        if name not in known:
            raise _core.Error(f"shapes: '{name}' is no parameter of {program.entry} (it has "
                              f"{', '.join(known) or 'none'})")
    return program


def _parameters(source: str, function: str) -> list[str]:
    """Returns the names of a function's parameters, of which a program may read only some."""
    try:
        tree = ast.parse(source)
    except (SyntaxError, ValueError):  # Python refuses some text that the compiler accepts
        return []
    return [one.arg for node in ast.walk(tree)
            if isinstance(node, ast.FunctionDef) and node.name == function
            for one in node.args.posonlyargs + node.args.args + node.args.kwonlyargs]
