"""What simwright writes, as yourdfpy reads it: warnings, inertials, meshes."""

import logging
import pathlib

import numpy as np
import yourdfpy

import inertials


class Heard(logging.Handler):
    def __init__(self):
        super().__init__(logging.WARNING)
        self.messages = []

    def emit(self, record):
        self.messages.append(record.getMessage())


def check_asset(folder):
    text, wanted = inertials.of_asset(folder)
    path = pathlib.Path(folder) / (text["name"] + ".urdf")
    heard = Heard()
    logging.getLogger().addHandler(heard)
    # Without force_collision_mesh=False the parts of a link become one mesh.
    urdf = yourdfpy.URDF.load(
        str(path),
        build_collision_scene_graph=True,
        load_collision_meshes=True,
        force_collision_mesh=False,
    )
    logging.getLogger().removeHandler(heard)
    assert not heard.messages, (path, heard.messages)
    assert urdf.validate(), (path, urdf.errors)
    assert len(urdf.robot.links) == len(wanted), path
    parts = 0
    for link in urdf.robot.links:
        inertial = link.inertial
        origin = inertial.origin if inertial.origin is not None else np.eye(4)
        assert np.allclose(origin[:3, :3], np.eye(3)), path
        numbers = (inertial.mass, origin[:3, 3], inertial.inertia)
        inertials.require_same(numbers, wanted[link.name], (path, link.name))
        parts += len(link.collisions)
    read = len(urdf.collision_scene.geometry)
    assert read == parts, (path, read, parts)
    return {"collision meshes": str(parts)}
