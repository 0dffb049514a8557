"""Solids, convex decomposition and mass properties of triangle meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from . import _arguments as checked
from . import _core
from ._arguments import mesh
from ._core import MassProperties, Mesh, TexturedMesh
from ._progress import reporter

if TYPE_CHECKING:
    from ._types import DecompositionFacts, Path, ProgressArgument, SolidFacts

__all__ = ["MassProperties", "Mesh", "decompose", "make_solid", "mass_properties", "mesh",
           "read_mesh"]


def read_mesh(path: Path) -> TexturedMesh:
    """Reads OBJ, STL, PLY, glTF, GLB, DAE and their archives.

    Args:
        path (path): the file.

    Returns:
        TexturedMesh: its ``mesh`` is the geometry; the functions of this module take both.

    Raises:
        Error: if the file is missing, damaged or of another kind.
    """
    return _core.read_mesh(checked.path("path", path))


def make_solid(mesh: Mesh | TexturedMesh, face_budget: int = 20000,
               progress: ProgressArgument = None) -> tuple[Mesh, SolidFacts]:
    """Makes one closed solid from any triangles: soups, open, inverted, doubled, intersecting.

    Args:
        mesh (Mesh or TexturedMesh): metres.
        face_budget (int): most faces of a solid that has to be wrapped.
        progress: see ``simwright``.

    Returns:
        (Mesh, dict): the solid, closed, outward and free of self-intersections, within 0.5 % of the
        diagonal of the outer surface; and ``method``, ``sheet_thickness`` (m) and ``findings``.

    Raises:
        Error: for a mesh without faces or extent.
    """
    return cast("tuple[Mesh, SolidFacts]",
                _core.make_solid(checked.surface("mesh", mesh),
                                 checked.integer("face_budget", face_budget, 1),
                                 reporter(progress)))


def decompose(solid: Mesh | TexturedMesh, threshold: float = 0.05, max_parts: int = 0,
              max_vertices: int = 64, max_faces: int = 0, tolerance: float = 0.0, seed: int = 1,
              progress: ProgressArgument = None,
              ) -> tuple[list[Mesh], DecompositionFacts]:
    """Decomposes a closed solid into convex parts that leave its hollows open.

    Args:
        solid (Mesh or TexturedMesh): closed and oriented outward.
        threshold (float): largest concavity of a part; the solid's longest side counts 2.
        max_parts (int): most parts; 0: as many as the threshold needs, at most 256.
        max_vertices (int): most vertices of a part, at least 16.
        max_faces (int): most triangles of a part, at least 28; 0: as the vertices allow.
        tolerance (float): m, the largest distance by which a part may deviate from the solid;
            above 0 it takes the threshold's place.
        seed (int): of the points at which concavity is measured.
        progress: see ``simwright``.

    Returns:
        (list of Mesh, dict): the parts by descending volume; and ``concavity``, ``deviation`` (the
        largest distance between parts and solid, m) and ``coverage``.

    Raises:
        Error: for a mesh without volume, or an option out of its range.
    """
    return cast("tuple[list[Mesh], DecompositionFacts]", _core.decompose(
        checked.surface("solid", solid), checked.number("threshold", threshold),
        checked.integer("max_parts", max_parts, 0), checked.integer("max_vertices", max_vertices, 16),
        checked.integer("max_faces", max_faces, 0), checked.number("tolerance", tolerance),
        checked.seeded(seed), reporter(progress)))


def mass_properties(mesh: Mesh | TexturedMesh, density: float,
                    wall_thickness: float | None = None, sheet: bool = False) -> MassProperties:
    """Computes volume, mass, centre of mass and inertia, exact for a polyhedron.

    Args:
        mesh (Mesh or TexturedMesh): closed and outward (any surface if ``sheet``), m.
        density (float): of the material, kg/m^3.
        wall_thickness (float): m; None: the body is full.
        sheet (bool): the material is a sheet of that thickness on the surface.

    Returns:
        MassProperties: in the mesh's frame; the inertia is about the centre of mass.

    Raises:
        Error: for an open or inside-out surface, or a number that is not positive.
    """
    surface, density = checked.surface("mesh", mesh), checked.number("density", density)
    if wall_thickness is None:
        if sheet:
            raise _core.Error("mass_properties: a sheet needs a wall_thickness")
        return _core.solid_mass_properties(surface, density)
    wall_thickness = checked.number("wall_thickness", wall_thickness)
    if sheet:
        return _core.shell_mass_properties(surface, wall_thickness, density)
    return _core.hollow_mass_properties(surface, wall_thickness, density)
