"""What simwright writes, in PyBullet: warnings, inertials, stillness."""

import json
import os
import pathlib
import sys
import tempfile

import numpy as np
import pybullet

import inertials

MARGIN = 1e-3  # m, PyBullet's, round every mesh: a thing stands so high
SETTLING = 0.5  # s, in which the margins of a scene's things come apart


class Printed:
    """What Bullet prints, in C++."""

    def __enter__(self):
        sys.stdout.flush()
        self.saved = os.dup(1)
        self.file = tempfile.TemporaryFile()
        os.dup2(self.file.fileno(), 1)
        return self

    def __exit__(self, *_):
        os.dup2(self.saved, 1)
        self.file.seek(0)
        self.text = self.file.read().decode(errors="replace")


def warnings_of(text):
    return [line for line in text.splitlines() if "arning" in line or "rror" in line]


def begin():
    pybullet.resetSimulation()
    pybullet.setGravity(0, 0, -9.81)
    box = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=[10, 10, 0.5])
    ground = pybullet.createMultiBody(0, box, basePosition=[0, 0, -0.5])
    pybullet.changeDynamics(ground, -1, lateralFriction=1.0)


def load(path, place, turn=(0, 0, 0, 1), fixed=False):
    """The thing, its link's frame where it is told: PyBullet's base is the centre of mass."""
    body = pybullet.loadURDF(
        str(path), useFixedBase=fixed, flags=pybullet.URDF_USE_INERTIA_FROM_FILE
    )
    dynamics = pybullet.getDynamicsInfo(body, -1)
    place, turn = pybullet.multiplyTransforms(place, turn, dynamics[3], dynamics[4])
    pybullet.resetBasePositionAndOrientation(body, place, turn)
    return body


def see(still, name, body):
    place, turn = pybullet.getBasePositionAndOrientation(body)
    still.see(name, place, np.reshape(pybullet.getMatrixFromQuaternion(turn), (3, 3)))
    for joint in range(pybullet.getNumJoints(body)):
        state = pybullet.getLinkState(body, joint)
        turn = np.reshape(pybullet.getMatrixFromQuaternion(state[1]), (3, 3))
        still.see("%s %d" % (name, joint), state[0], turn)


def check_inertials(body, wanted, path):
    names = [pybullet.getBodyInfo(body)[0].decode()]
    for joint in range(pybullet.getNumJoints(body)):
        names.append(pybullet.getJointInfo(body, joint)[12].decode())
    for index, name in enumerate(names):
        dynamics = pybullet.getDynamicsInfo(body, index - 1)
        x, y, z, w = dynamics[4]
        axes = inertials.turn_of(w, x, y, z)
        inertia = axes @ np.diag(dynamics[2]) @ axes.T
        mass, centre, known = wanted[name]
        # PyBullet diagonalizes in single digits of its own; a fixed base has no mass.
        if dynamics[0] == 0.0:
            continue
        inertials.require_same((dynamics[0], dynamics[3], inertia), wanted[name], (path, name))


def steps(seconds, bodies, still=None):
    for _ in range(round(seconds * 240)):
        pybullet.stepSimulation()
        if still is not None:
            for name, body in bodies.items():
                see(still, name, body)


def check_asset(folder):
    text, wanted = inertials.of_asset(folder)
    path = pathlib.Path(folder) / (text["name"] + ".urdf")
    begin()
    with Printed() as printed:
        body = load(path, (0, 0, MARGIN), fixed=text.get("fixed", False))
    assert not warnings_of(printed.text), (path, printed.text)
    check_inertials(body, wanted, path)
    still = inertials.Stillness()
    see(still, text["name"], body)
    steps(2.0, {text["name"]: body}, still)
    still.require(str(path))
    return {"urdf": str(still)}


def check_scene(folder):
    folder = pathlib.Path(folder)
    begin()
    bodies = {}
    with Printed() as printed:
        for one in json.loads((folder / "scene.json").read_text())["objects"]:
            w, x, y, z = one["quaternion_wxyz"]
            body = load(folder / one["urdf"], one["translation"], (x, y, z, w), one["welded"])
            bodies[one["name"]] = body
    assert not warnings_of(printed.text), (folder, printed.text)
    steps(SETTLING, bodies)
    still = inertials.Stillness()
    for name, body in bodies.items():
        see(still, name, body)
    steps(2.0, bodies, still)
    still.require(str(folder))
    return {"scene.json": str(still)}


pybullet.connect(pybullet.DIRECT)
