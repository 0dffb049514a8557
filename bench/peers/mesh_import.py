"""Compares the import of a mesh with trimesh and CoACD, and with trimesh and V-HACD.

    .venv-bench/bin/python bench/peers/mesh_import.py

A mug of about 10 000 faces, closed and damaged (1 % of the faces missing, 5 % turned over), becomes
a URDF with a visual mesh, convex parts, mass and inertia. Theirs is what one chains in Python:
trimesh reads, merges vertices, repairs normals and holes, and computes mass and inertia; CoACD or
V-HACD, with their own settings, make the parts; their time leaves out the imports of Python's
modules. Ours is `simwright import --no-check`, whole, which also makes a solid, SDF, MJCF and a
picture, with parts that deviate by 2 mm, which gives about CoACD's volume error; the time does not
depend on it. Both results are judged by the clean mug: the error of the mass at 1000 kg/m3, and the
volume in which the union of the parts and the mug differ, over the mug's, by Manifold's booleans;
and the largest distance between the surfaces of both.
"""

import importlib.metadata
import resource
import statistics
import subprocess
import tempfile
import time
import xml.etree.ElementTree as xml
from pathlib import Path

import open3d  # first: it cannot be imported after coacd
import coacd
import manifold3d
import numpy as np
import trimesh

from comparison import Comparison, parser_of, report

DENSITY = 1000.0  # kg/m3


def clean_mug():
    """Returns a mug 9.5 cm high, with a handle, as a closed mesh of about 10 000 faces."""
    rounds = 64
    wall = manifold3d.Manifold.cylinder(0.095, 0.036, 0.041, rounds)
    inside = manifold3d.Manifold.cylinder(0.095, 0.032, 0.038, rounds).translate([0, 0, 0.005])
    ring = manifold3d.CrossSection.circle(0.005, 32).translate([0.026, 0.0])
    handle = manifold3d.Manifold.revolve(ring, rounds).rotate([90, 0, 0])
    mug = wall + handle.translate([0.045, 0, 0.048]) - inside
    mesh = mug.refine_to_length(0.008).to_mesh()
    return trimesh.Trimesh(mesh.vert_properties[:, :3], mesh.tri_verts)


def damaged(mesh):
    """Returns the triangles with 1 % of them missing and 5 % turned over."""
    random = np.random.default_rng(1)
    faces = mesh.faces[random.random(len(mesh.faces)) > 0.01].copy()
    turned = random.random(len(faces)) < 0.05
    faces[turned] = faces[turned][:, ::-1]
    return trimesh.Trimesh(mesh.vertices, faces, process=False)


def solid_of(mesh):
    return manifold3d.Manifold(manifold3d.Mesh64(
        np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces, np.uint64)))


def hulls_of(parts):
    return [trimesh.convex.convex_hull(part.vertices) for part in parts]


def errors(parts, mug):
    """Returns the volume in which parts and mug differ, over the mug's, and the distance (m)."""
    solid = solid_of(mug)
    union = manifold3d.Manifold.batch_boolean(
        [solid_of(part) for part in hulls_of(parts)], manifold3d.OpType.Add)
    volume = ((union - solid).volume() + (solid - union).volume()) / solid.volume()
    mesh = union.to_mesh64()
    surface = trimesh.Trimesh(mesh.vert_properties[:, :3], mesh.tri_verts)
    return volume, max(farthest(surface, mug), farthest(mug, surface))


def farthest(mesh, other):
    """Returns the largest distance (m) of 50 000 points on a surface from another."""
    points, _ = trimesh.sample.sample_surface(mesh, 50_000, seed=1)
    scene = open3d.t.geometry.RaycastingScene()
    scene.add_triangles(open3d.core.Tensor(np.asarray(other.vertices, np.float32)),
                        open3d.core.Tensor(np.asarray(other.faces, np.uint32)))
    distances = scene.compute_distance(open3d.core.Tensor(points.astype(np.float32)))
    return float(distances.numpy().max())


def coacd_parts(mesh):
    coacd.set_log_level("error")
    return [trimesh.Trimesh(*part) for part in
            coacd.run_coacd(coacd.Mesh(mesh.vertices, mesh.faces), seed=1)]


def vhacd_parts(mesh):
    return [trimesh.Trimesh(part["vertices"], part["faces"])
            for part in trimesh.decomposition.convex_decomposition(mesh)]


def clocks():
    """Returns the time, and the processor time of this process and of those that it ended."""
    return np.array([time.perf_counter(), sum(
        usage.ru_utime + usage.ru_stime for usage in map(
            resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)))])


def their_import(path, folder, make_parts):
    """Returns the seconds (clock, processor), the mass and the parts of an import with trimesh."""
    start = clocks()
    mesh = trimesh.load_mesh(path)
    mesh.merge_vertices()
    trimesh.repair.fix_normals(mesh)
    trimesh.repair.fill_holes(mesh)
    mesh.density = DENSITY
    parts = make_parts(mesh)
    folder.mkdir()
    mesh.export(folder / "visual.obj")
    for number, part in enumerate(parts):
        part.export(folder / f"collision_{number:03}.obj")
    write_urdf(mesh, len(parts), folder / "object.urdf")
    return clocks() - start, float(mesh.mass), parts


def write_urdf(mesh, parts, path):
    robot = xml.Element("robot", name="object")
    link = xml.SubElement(robot, "link", name="object")
    inertial = xml.SubElement(link, "inertial")
    place = " ".join(f"{x:.9g}" for x in mesh.center_mass)
    xml.SubElement(inertial, "origin", xyz=place)
    xml.SubElement(inertial, "mass", value=f"{mesh.mass:.9g}")
    moments = mesh.moment_inertia
    xml.SubElement(inertial, "inertia", {
        f"i{'xyz'[i]}{'xyz'[j]}": f"{moments[i, j]:.9g}" for i in range(3) for j in range(i, 3)})
    for kind, name in [("visual", "visual.obj")] + [
            ("collision", f"collision_{number:03}.obj") for number in range(parts)]:
        geometry = xml.SubElement(xml.SubElement(link, kind), "geometry")
        xml.SubElement(geometry, "mesh", filename=name)
    xml.ElementTree(robot).write(path)


def our_import(program, path, folder, mug):
    """Returns the seconds (clock, processor), the mass and the parts of `simwright import`, at the
    mug's place."""
    start = clocks()
    subprocess.run(
        [program, "import", path, "-o", folder, "--no-check", "--quiet", "--up", "z", "--unit", "m",
         "--density", str(DENSITY), "--category", "mug", "--part-tolerance", "0.002"], check=True,
        stdout=subprocess.DEVNULL)
    seconds = clocks() - start
    urdf = next(folder.rglob("*.urdf"))
    tree = xml.parse(urdf)
    mass = sum(float(one.get("value")) for one in tree.iter("mass"))
    visual = trimesh.load_mesh(urdf.parent / "visual.obj")
    shift = mug.bounds[0] - visual.bounds[0]
    parts = [trimesh.load_mesh(one) for one in sorted(urdf.parent.glob("collision_*.obj"))]
    for part in parts:
        part.apply_translation(shift)
    return seconds, mass, parts


def described(name, mass, parts, mug):
    error = mass / (DENSITY * mug.volume) - 1.0
    volume, distance = errors(parts, mug)
    return (f"{name}: {len(parts)} parts, volume error {100.0 * volume:.0f} %, at most "
            f"{1e3 * distance:.1f} mm off, mass error {100.0 * abs(error):.1f} %")


def compare(options, folder, mug, path, rounds):
    """Returns a row per peer for one file."""
    program = options.bin / "simwright"
    peers = {f"trimesh and CoACD {coacd_version()}": coacd_parts,
             f"trimesh and V-HACD {importlib.metadata.version('vhacdx')}": vhacd_parts}
    mine, theirs = [], {name: [] for name in peers}
    for turn in range(rounds):
        mine.append(our_import(program, path, folder / f"ours_{path.stem}_{turn}", mug))
        for name, make_parts in peers.items():
            theirs[name].append(their_import(
                path, folder / f"{make_parts.__name__}_{path.stem}_{turn}", make_parts))
    rows = []
    for name, found in theirs.items():
        own, other = [statistics.median(one[0][0] for one in side) for side in (mine, found)]
        ratio, of_processor = [statistics.median(two[0][kind] / one[0][kind] for one, two in
                                                 zip(mine, found)) for kind in (0, 1)]
        share = errors(found[0][2], mug)[1] / errors(mine[0][2], mug)[1]
        rows.append(Comparison(
            "import", name, f"s, {path.stem.replace('_', ' ')} of {len(mug.faces)} faces", own,
            other, ratio, f"of processor time {of_processor:.1f}; "
            f"{described('ours', *mine[0][1:], mug)}; {described('theirs', *found[0][1:], mug)}",
            f"their parts are {share:.1f} times as far off" if share > 1.0 else ""))
    return rows


def coacd_version():
    return importlib.metadata.version("coacd")


def main():
    options = parser_of(__doc__).parse_args()
    mug = clean_mug()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        mug.export(folder / "mug.obj")
        damaged(mug).export(folder / "damaged_mug.obj")
        rounds = 5 if options.full else 2
        report(options, [row for file in ("mug.obj", "damaged_mug.obj")
                         for row in compare(options, folder, mug, folder / file, rounds)])


if __name__ == "__main__":
    main()
