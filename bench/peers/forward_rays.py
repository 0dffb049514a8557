"""Compares the rays per second of the forward renderer with Mitsuba 3 and Open3D.

    .venv-bench/bin/python bench/peers/forward_rays.py [--full]

The same bumpy ball, camera and 512 x 512 rays; depth, facing normal, mask, instance and triangle of
each pixel. Ours go into buffers that are used again, the peers' into new arrays, as their interfaces
have it; Open3D's normals are those of the faces. Rounds of the three alternate; a row has medians.
The program is built with -DSIMWRIGHT_BENCH=ON. Mitsuba needs Debian's libllvm19 on processors that
are newer than LLVM 15.
"""

import glob
import importlib.metadata
import json
import os
import re
import statistics
import subprocess
import sys
import time

import numpy as np

from comparison import Comparison, parser_of, report

SIDE = 512
TRIANGLES = (1000, 10000, 100000)


def bumpy_ball(triangles):
    """Returns vertices (N x 3) and triangles (M x 3) of bench_forward_rays' mesh."""
    rings = round((triangles / 4) ** 0.5)
    sectors = 2 * rings
    polar = (np.pi * (np.arange(rings + 1) + 0.5) / (rings + 1.0))[:, None]
    turn = (2.0 * np.pi * np.arange(sectors) / sectors)[None, :]
    radius = 0.5 + 0.03 * np.sin(9.0 * polar) * np.cos(7.0 * turn)
    vertices = np.stack([radius * np.sin(polar) * np.cos(turn),
                         radius * np.sin(polar) * np.sin(turn),
                         radius * np.cos(polar)], axis=-1)
    i, j = np.meshgrid(np.arange(rings), np.arange(sectors), indexing="ij")
    a, b = i * sectors + j, i * sectors + (j + 1) % sectors
    faces = np.stack([np.stack([a, a + sectors, b + sectors], -1),
                      np.stack([a, b + sectors, b], -1)], axis=2)
    return vertices.reshape(-1, 3).astype(np.float32), faces.reshape(-1, 3).astype(np.uint32)


def orbit_rays(distance=1.8, elevation=0.4, azimuth=0.7, field=0.61):
    """Returns the camera's position (3) and the directions (SIDE^2 x 3) through the pixels."""
    eye = distance * np.array([np.cos(elevation) * np.cos(azimuth),
                               np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    forward = -eye / np.linalg.norm(eye)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    focal = 0.5 * SIDE / np.tan(0.5 * field)
    x, y = np.meshgrid(np.arange(SIDE) + 0.5, np.arange(SIDE) + 0.5)
    seen = np.stack([(x - SIDE / 2) / focal, (y - SIDE / 2) / focal, np.ones_like(x)], -1)
    directions = seen @ np.stack([right, np.cross(forward, right), forward])
    return eye.astype(np.float32), directions.reshape(-1, 3).astype(np.float32)


def seconds(work, repeats):
    """Returns the medians of wall-clock and of processor time per call."""
    wall, processor = [], []
    for _ in range(repeats):
        start = time.perf_counter(), time.process_time()
        work()
        wall.append(time.perf_counter() - start[0])
        processor.append(time.process_time() - start[1])
    return statistics.median(wall), statistics.median(processor)


class Open3dRays:
    name, package = "Open3D", "open3d"

    def __init__(self, triangles, threads):
        import open3d
        vertices, faces = bumpy_ball(triangles)
        eye, directions = orbit_rays()
        self.threads = threads
        self.scene = open3d.t.geometry.RaycastingScene(nthreads=threads)
        self.scene.add_triangles(open3d.core.Tensor(vertices), open3d.core.Tensor(faces))
        rays = np.concatenate([np.broadcast_to(eye, directions.shape), directions], axis=1)
        self.rays = open3d.core.Tensor(rays)

    def trace(self):
        # Face normals, which do not face the camera: less than the others compute.
        self.hits = self.scene.cast_rays(self.rays, nthreads=self.threads)

    def covered(self):
        return float(np.isfinite(self.hits["t_hit"].numpy()).mean())


class MitsubaRays:
    name, package = "Mitsuba", "mitsuba"

    def __init__(self, triangles, threads):
        import drjit
        import mitsuba
        mitsuba.set_variant("llvm_ad_mono")
        self.drjit = drjit
        self.mitsuba = mitsuba
        drjit.set_thread_count(threads)
        vertices, faces = bumpy_ball(triangles)
        mesh = mitsuba.Mesh("ball", len(vertices), len(faces), has_vertex_normals=True)
        parameters = mitsuba.traverse(mesh)
        parameters["vertex_positions"] = vertices.ravel()
        parameters["faces"] = faces.ravel()
        parameters.update()
        mesh.recompute_vertex_normals()
        self.scene = mitsuba.load_dict({"type": "scene", "ball": mesh})
        eye, directions = orbit_rays()
        self.eye = mitsuba.Point3f(*[float(number) for number in eye])
        self.directions = mitsuba.Vector3f(directions.T)
        drjit.eval(self.directions)
        drjit.sync_thread()

    def trace(self):
        drjit, mitsuba = self.drjit, self.mitsuba
        hit = self.scene.ray_intersect(mitsuba.Ray3f(self.eye, self.directions))
        valid = hit.is_valid()
        normal = hit.sh_frame.n
        self.buffers = (
            drjit.select(valid, hit.t, 0.0),
            drjit.select(drjit.dot(normal, self.directions) > 0.0, -normal, normal),
            drjit.select(valid, mitsuba.Float(1.0), 0.0),
            drjit.select(valid, mitsuba.UInt32(0), 0xFFFFFFFF),
            drjit.select(valid, hit.prim_index, 0xFFFFFFFF))
        drjit.eval(*self.buffers)
        drjit.sync_thread()

    def covered(self):
        return float(self.drjit.mean(self.buffers[2])[0])


def our_seconds(program, triangles, threads):
    """Returns wall-clock and processor seconds per image, and the covered share."""
    printed = subprocess.run(
        [program, "--benchmark_format=json", "--benchmark_min_time=0.3",
         f"--benchmark_filter=triangles:{triangles}/threads:{threads}/"],
        check=True, capture_output=True, text=True).stdout
    row = json.loads(printed[printed.index("{"):])["benchmarks"][0]
    return 1e-3 * row["real_time"], 1e-3 * row["cpu_time"], row["covered"]


def find_llvm():
    """Points Mitsuba to the newest libLLVM of this system, unless the user has."""
    version = lambda path: [int(n) for n in re.findall(r"\d+", os.path.basename(path))]
    found = sorted(glob.glob("/usr/lib/*/libLLVM*.so*"), key=lambda path: version(path) or [0])
    if found:
        os.environ.setdefault("DRJIT_LIBLLVM_PATH", found[-1])


def measure_peer(peer, triangles, threads, repeats):
    """Measures a peer in a process of its own; its number of threads is fixed at the start."""
    printed = subprocess.run(
        [sys.executable, __file__, peer.__name__, str(triangles), str(threads), str(repeats)],
        capture_output=True, text=True)
    if printed.returncode != 0:
        lines = printed.stderr.strip().splitlines() or [f"exit status {printed.returncode}"]
        sys.exit(f"error: {peer.name}: {lines[-1]}")
    return [float(number) for number in printed.stdout.split()]


def run_peer(name, triangles, threads, repeats):
    rays = {"Open3dRays": Open3dRays, "MitsubaRays": MitsubaRays}[name](triangles, threads)
    for _ in range(3):
        rays.trace()
    print(*seconds(rays.trace, repeats), rays.covered())


def compare(options, triangles, threads):
    """Measures a size in rounds, prints its line, and returns a row for each peer."""
    rounds = [[our_seconds(options.bin / "bench_forward_rays", triangles, threads)] +
              [measure_peer(peer, triangles, threads, options.repeats) for peer in PEERS]
              for _ in range(options.rounds)]
    covered = [side[2] for side in rounds[0]]
    if max(covered) - min(covered) > 0.02:
        sys.exit(f"error: the pictures differ: {covered} of the pixels are covered")
    wall, processor = [[statistics.median(one[side][kind] for one in rounds) for side in range(3)]
                       for kind in (0, 1)]
    rates = [1e-6 * SIDE * SIDE / time for time in wall]
    ratios = [[times[side] / times[0] for side in (1, 2)] for times in (wall, processor)]
    print(f"| {triangles} | {threads} | " + " | ".join(f"{rate:.1f}" for rate in rates) + " | " +
          " | ".join(", ".join(f"{ratio:.2f}" for ratio in one) for one in ratios) + " |",
          flush=True)
    return [Comparison(
        "rays", f"{peer.name} {importlib.metadata.version(peer.package)}",
        f"Mrays/s with buffers, {triangles} triangles, threads: {threads}", rates[0], rates[side],
        ratios[0][side - 1], f"of processor time {ratios[1][side - 1]:.2f}; the same pixels "
        f"({100.0 * covered[0]:.1f} and {100.0 * covered[side]:.1f} % covered)")
        for side, peer in enumerate(PEERS, 1)]


def main():
    find_llvm()
    if len(sys.argv) == 5 and sys.argv[1] in ("Open3dRays", "MitsubaRays"):
        return run_peer(sys.argv[1], *[int(number) for number in sys.argv[2:]])
    parser = parser_of(__doc__)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--repeats", type=int, default=30, help="images of a peer per round")
    options = parser.parse_args()
    print("| triangles | threads | ours, Mrays/s | Mitsuba 3 | Open3D | ratios | ratios of "
          "processor time |")
    print("|---|---|---|---|---|---|---|")
    sizes = [(triangles, threads) for triangles in TRIANGLES for threads in (1, 2)]
    report(options, [row for size in (sizes if options.full else [(10000, 2)])
                     for row in compare(options, *size)])


PEERS = (MitsubaRays, Open3dRays)

if __name__ == "__main__":
    main()
