"""What the tests of exported USD share: the program, and the programs that judge its layers."""

import os
import subprocess

import pytest

pytest.importorskip("pxr.Usd", reason="usd-core is missing (./setup.sh --usd)")
newton = pytest.importorskip("newton", reason="newton is missing (./setup.sh --usd)")
from pxr import UsdValidation  # noqa: E402

PROGRAM = os.environ["SIMWRIGHT_PROGRAM"]
RIGID = ("mug", "apple")
ARTICULATED = ("microwave", "drawer_unit", "faucet")
KINDS = RIGID + ARTICULATED


def run(*arguments):
    subprocess.run([PROGRAM, *map(str, arguments), "--quiet"], check=True, stdout=subprocess.DEVNULL)


def findings(stage):
    """Returns what usd-core's validators say about a stage."""
    context = UsdValidation.ValidationContext(
        UsdValidation.ValidationRegistry().GetOrLoadAllValidators())
    return [f"{error.GetName()}: {error.GetMessage()}" for error in context.Validate(stage)]


def newton_model(layer, floor=False):
    """Returns Newton's model of a layer, with the plane z = 0 if the layer has none.

    Newton reads the positions of joints at the start by the schemas of PhysX.
    """
    builder = newton.ModelBuilder()
    newton.solvers.SolverMuJoCo.register_custom_attributes(builder)  # reads mjc:solreffriction
    builder.add_usd(str(layer), schema_resolvers=[newton.usd.SchemaResolverNewton(),
                                                  newton.usd.SchemaResolverPhysx()])
    if floor:
        builder.add_ground_plane()
    return builder.finalize(device="cpu")


def mujoco_model(layer, floor=False):
    """Returns the model that Newton makes for MuJoCo of a layer."""
    return newton.solvers.SolverMuJoCo(newton_model(layer, floor), use_mujoco_cpu=True).mj_model
