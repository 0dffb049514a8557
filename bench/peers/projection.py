"""Compares the projection of heaps of boxes onto scenes without penetration with Drake and SNOPT.

    .venv-peers/bin/python bench/peers/projection.py

Both minimise the sum of squared displacements from the same start, rotations kept, so that no two
boxes and no box and the table penetrate. Drake's program has three prismatic joints per box, a
MinimumDistanceLowerBoundConstraint of 0 with an influence of 3 cm (as our contact margin) and
SNOPT with its own tolerances. The deepest penetration of both results is measured by Drake.
"""

import importlib.metadata
import json
import statistics
import subprocess
import time

import numpy as np
from pydrake.geometry import Box
from pydrake.math import RigidTransform
from pydrake.common.eigen_geometry import Quaternion
from pydrake.multibody.inverse_kinematics import InverseKinematics
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, CoulombFriction
from pydrake.multibody.tree import PrismaticJoint, SpatialInertia
from pydrake.solvers import SnoptSolver
from pydrake.systems.framework import DiagramBuilder

from comparison import Comparison, parser_of, report

INFLUENCE = 0.03  # m


class Heap:
    """A heap in Drake: boxes that translate, on a table."""

    def __init__(self, boxes):
        builder = DiagramBuilder()
        self.plant, self.scene = AddMultibodyPlantSceneGraph(builder, 0.0)
        inertia = SpatialInertia.SolidBoxWithMass(1.0, 0.1, 0.1, 0.1)
        for i, box in enumerate(boxes):
            body = self.plant.AddRigidBody(f"box_{i}", inertia) if i else self.plant.world_body()
            turn = RigidTransform(Quaternion(np.roll(box["rotation_xyzw"], 1)), np.zeros(3))
            if i == 0:
                turn.set_translation(box["translation"])
            self.plant.RegisterCollisionGeometry(
                body, turn, Box(*box["size"]), f"shape_{i}", CoulombFriction(0.5, 0.5))
            if i:
                self.add_joints(body, i)
        self.plant.Finalize()
        self.diagram = builder.Build()
        self.context = self.diagram.CreateDefaultContext()
        self.start = np.concatenate([box["translation"] for box in boxes[1:]])

    def add_joints(self, body, number):
        parent = self.plant.world_body()
        for axis in range(3):
            child = body
            if axis < 2:
                child = self.plant.AddRigidBody(
                    f"slide_{number}_{axis}", SpatialInertia.SolidBoxWithMass(1.0, 0.1, 0.1, 0.1))
            self.plant.AddJoint(PrismaticJoint(
                f"joint_{number}_{axis}", parent.body_frame(), child.body_frame(),
                np.eye(3)[axis]))
            parent = child

    def deepest(self, positions):
        """Returns the deepest penetration (m)."""
        self.plant.SetPositions(self.plant.GetMyMutableContextFromRoot(self.context), positions)
        query = self.scene.get_query_output_port().Eval(
            self.scene.GetMyContextFromRoot(self.context))
        return max((pair.depth for pair in query.ComputePointPairPenetration()), default=0.0)

    def project(self):
        """Returns Drake's positions and the seconds of building and solving the program."""
        start = time.perf_counter()
        context = self.plant.GetMyMutableContextFromRoot(self.context)
        kinematics = InverseKinematics(self.plant, context, with_joint_limits=False)
        kinematics.AddMinimumDistanceLowerBoundConstraint(0.0, INFLUENCE)
        program, q = kinematics.prog(), kinematics.q()
        program.AddQuadraticErrorCost(np.eye(len(q)), self.start, q)
        result = SnoptSolver().Solve(program, self.start)
        return result.GetSolution(q), time.perf_counter() - start


def compare(program, boxes, count):
    """Projects heaps on both sides; returns their row."""
    printed = subprocess.run([program, "--boxes", str(boxes), "--count", str(count)],
                             check=True, stdout=subprocess.PIPE, text=True).stdout
    mine, theirs, depths, costs = [], [], [], []
    for scene in json.loads(printed):
        heap = Heap(scene["boxes"])
        shifts = np.concatenate([box["shift"] for box in scene["boxes"][1:]])
        found, seconds = heap.project()
        mine.append(scene["ms"])
        theirs.append(1e3 * seconds)
        depths.append([heap.deepest(q) for q in (heap.start, heap.start + shifts, found)])
        costs.append([np.sum(shifts**2), np.sum((found - heap.start) ** 2)])
        before, own, other = [1e3 * depth for depth in depths[-1]]
        print(f"{boxes} boxes: {mine[-1]:.2f} and {theirs[-1]:.0f} ms; deepest penetration "
              f"{before:.1f} mm before, {own:.4f} and {other:.4f} after; squared displacements "
              f"{costs[-1][0]:.4f} and {costs[-1][1]:.4f} m2", flush=True)
    own, other = [1e3 * max(depth[side] for depth in depths) for side in (1, 2)]
    cost = statistics.median(one / two for one, two in costs)
    return Comparison(
        "projection", f"Drake {importlib.metadata.version('drake')}, SNOPT",
        f"ms, {boxes} boxes and a table", statistics.median(mine), statistics.median(theirs),
        statistics.median(two / one for one, two in zip(mine, theirs)),
        f"deepest penetration {own:.4f} and {other:.4f} mm of {1e3 * depths[0][0]:.0f}, squared "
        f"displacement {cost:.2f} of theirs")


def main():
    options = parser_of(__doc__).parse_args()
    program = options.bin / "bench_box_piles"
    sizes = ((34, 5), (100, 3)) if options.full else ((34, 5),)
    report(options, [compare(program, *size) for size in sizes])


if __name__ == "__main__":
    main()
