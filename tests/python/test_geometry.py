"""Meshes and geometry against closed forms."""

import os

import numpy as np
import pytest

import simwright as sw


def test_mesh_arrays_are_views(cube):
    assert cube.vertices.shape == (8, 3) and cube.vertices.dtype == np.float64
    assert cube.triangles.shape == (12, 3) and cube.triangles.dtype == np.int32
    assert not cube.vertices.flags.owndata and not cube.vertices.flags.writeable
    first, second = cube.vertices, cube.vertices
    assert first.ctypes.data == second.ctypes.data
    np.testing.assert_array_equal(cube.bounds, [[0, 0, 0], [1, 1, 1]])
    assert cube.area == pytest.approx(6.0)


def test_a_view_outlives_its_mesh():
    mesh = sw.mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    view = mesh.vertices
    del mesh
    np.testing.assert_array_equal(view[1], [1, 0, 0])


def test_mass_properties_of_a_cube(cube):
    found = sw.geometry.mass_properties(cube, 600.0)
    assert found.mass == pytest.approx(600.0) and found.volume == pytest.approx(1.0)
    np.testing.assert_allclose(found.center_of_mass, [0.5, 0.5, 0.5])
    np.testing.assert_allclose(found.inertia, np.eye(3) * 600.0 / 6.0, atol=1e-9)
    # A cube's wall of thickness t leaves a cube of side 1 - 2 t.
    wall = sw.geometry.mass_properties(cube, 1000.0, wall_thickness=0.1)
    assert wall.mass == pytest.approx(1000.0 * (1 - 0.8**3))
    inertia = 1000.0 / 6.0 * (1 - 0.8**5)
    np.testing.assert_allclose(wall.inertia, np.eye(3) * inertia, atol=1e-6)
    sheet = sw.geometry.mass_properties(cube, 1000.0, wall_thickness=0.001, sheet=True)
    assert sheet.mass == pytest.approx(6.0)


def test_a_solid_of_two_overlapping_boxes(cube):
    shifted = cube.vertices + [0.5, 0.0, 0.0]
    soup = sw.mesh(np.vstack([cube.vertices, shifted]),
                   np.vstack([cube.triangles, cube.triangles + 8]))
    solid, facts = sw.geometry.make_solid(soup)
    assert facts["method"] in ("as it is", "repaired", "wrapped")
    volume = sw.geometry.mass_properties(solid, 1.0).volume
    assert volume == pytest.approx(1.5, rel=0.02)


def test_convex_parts_of_an_l_shape():
    outline = np.array([[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]], dtype=float)
    bottom = np.column_stack([outline, np.zeros(6)])
    vertices = np.vstack([bottom, bottom + [0, 0, 1]])
    faces = [[0, 3, 1], [1, 3, 2], [0, 5, 3], [3, 5, 4]]
    triangles = faces + [[6 + a, 6 + c, 6 + b] for a, b, c in faces]
    for i in range(6):
        j = (i + 1) % 6
        triangles += [[i, j, 6 + j], [i, 6 + j, 6 + i]]
    solid = sw.mesh(vertices, triangles)
    assert sw.geometry.mass_properties(solid, 1.0).volume == pytest.approx(3.0)
    parts, facts = sw.geometry.decompose(solid)
    assert len(parts) == 2 and facts["concavity"] < 0.05
    volumes = [sw.geometry.mass_properties(part, 1.0).volume for part in parts]
    assert sum(volumes) == pytest.approx(3.0, rel=1e-3)


@pytest.mark.parametrize("vertices, triangles, word", [
    ([[0, 0]], [[0, 1, 2]], "shape"),
    ([[0, 0, np.nan]] * 3, [[0, 1, 2]], "finite"),
    ([[0, 0, 0]] * 3, [[0, 1, 7]], "missing vertex"),
    ([[0, 0, 0]] * 3, [[0, 1, 2**40]], "large"),
    ("mesh", [[0, 1, 2]], "real numbers"),
    ([[0, 0, 1j]] * 3, [[0, 1, 2]], "real numbers"),
    ([[0, 0, 0]] * 3, [[0, 1, 2.7]], "triangles.*ints.*fraction"),
    ([[0, 0, 0]] * 3, [[0, 1, np.nan]], "fraction"),
    ([[0, 0, 0]] * 3, [[False, True, True]], "triangles.*bool"),
])
def test_bad_meshes(vertices, triangles, word):
    with pytest.raises(sw.Error, match=word):
        sw.mesh(vertices, triangles)


@pytest.mark.parametrize("arguments, word", [
    (dict(seed=1.5), "seed: is 1.5"), (dict(seed=-1), "seed: is -1.*from 0 to"),
    (dict(seed=2**64), "seed"), (dict(seed=True), "seed"), (dict(max_parts=-1), "max_parts"),
    (dict(max_vertices=8), "max_vertices.*at least 16"), (dict(threshold="fine"), "threshold"),
    (dict(threshold=np.nan), "threshold"), (dict(solid=None), "solid.*NoneType"),
    (dict(solid="cube.obj"), "solid.*read_mesh"),
])
def test_decompose_refuses(cube, arguments, word):
    with pytest.raises(sw.Error, match=word):
        sw.geometry.decompose(**{"solid": cube, **arguments})


@pytest.mark.parametrize("density, word", [("x", "density: is 'x'"), (None, "density"),
                                           (np.inf, "density"), (True, "density")])
def test_mass_properties_refuse(cube, density, word):
    with pytest.raises(sw.Error, match=word):
        sw.geometry.mass_properties(cube, density)
    with pytest.raises(sw.Error, match="wall_thickness"):
        sw.geometry.mass_properties(cube, 1.0, wall_thickness="thin")
    with pytest.raises(sw.Error, match="mesh.*list"):
        sw.geometry.mass_properties([cube], 1.0)


@pytest.mark.parametrize("count", [-1, 1.5, "all", True])
def test_bad_counts_of_threads(count):
    with pytest.raises(sw.Error, match="count: is "):
        sw.set_threads(count)


def test_a_file_goes_straight_into_the_geometry(cube, tmp_path):
    lines = [f"v {x} {y} {z}" for x, y, z in cube.vertices]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in cube.triangles]
    (tmp_path / "cube.obj").write_text("\n".join(lines))
    textured = sw.geometry.read_mesh(tmp_path / "cube.obj")
    assert isinstance(textured, sw.TexturedMesh)
    assert sw.geometry.mass_properties(textured, 600.0).mass == pytest.approx(600.0)
    solid, _ = sw.geometry.make_solid(textured)
    assert sw.geometry.mass_properties(solid, 1.0).volume == pytest.approx(1.0)
    parts, _ = sw.geometry.decompose(textured)
    assert len(parts) == 1


@pytest.mark.parametrize("path, word", [
    ("", "empty"), (3, "path: is 3, of the type int"), ("\0x", "NUL"), (None, "NoneType"),
    (os.fsdecode(b"\xff.obj"), "UTF-8"), (b"\xff.obj", "UTF-8"),
])
def test_bad_paths(path, word):
    with pytest.raises(sw.Error, match=word):
        sw.geometry.read_mesh(path)


def test_errors_say_where(cube):
    with pytest.raises(sw.Error) as caught:
        sw.geometry.mass_properties(cube, -1.0)
    assert caught.value.where == "mass properties"
    assert "\n" not in str(caught.value)
    with pytest.raises(sw.Error):
        sw.geometry.read_mesh("/nowhere/missing.obj")


def test_open_surfaces_are_refused():
    corners = [[x, y, z] for x in (0, 1) for y in (0, 2) for z in (0, 3)]
    faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6],
             [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
    closed = sw.geometry.mass_properties(sw.mesh(corners, faces), 1000.0)
    assert abs(closed.mass - 6000.0) < 1e-9
    for mesh in (sw.mesh(corners, faces[:-1]), sw.mesh(corners, [faces[0][::-1]] + faces[1:])):
        for call in (lambda: sw.geometry.mass_properties(mesh, 1000.0),
                     lambda: sw.geometry.mass_properties(mesh, 1000.0, wall_thickness=0.01),
                     lambda: sw.geometry.decompose(mesh, progress=False)):
            with pytest.raises(sw.Error, match="not closed"):
                call()
    # A soup in which each face has vertices of its own bounds the same volume.
    soup = sw.mesh([corners[v] for face in faces for v in face],
                   [[3 * f, 3 * f + 1, 3 * f + 2] for f in range(12)])
    assert abs(sw.geometry.mass_properties(soup, 1000.0).mass - 6000.0) < 1e-9
