"""CoACD on one mesh: coacd_parts.py IN.obj OUT.obj [mcts_iterations [max_parts]].

Reads and writes v/f lines; each part is an `o`. Prints the seconds that the run took.
"""
import sys
import time

import coacd
import numpy as np


def read_obj(path):
    vertices, faces = [], []
    with open(path) as lines:
        for line in lines:
            words = line.split()
            if words and words[0] == "v":
                vertices.append([float(w) for w in words[1:4]])
            elif words and words[0] == "f":
                faces.append([int(w) - 1 for w in words[1:4]])
    return np.array(vertices), np.array(faces)


def main():
    vertices, faces = read_obj(sys.argv[1])
    options = {"threshold": 0.05, "preprocess_mode": "auto", "seed": 1}
    if len(sys.argv) > 3:
        options["mcts_iterations"] = int(sys.argv[3])
    if len(sys.argv) > 4:
        options["max_convex_hull"] = int(sys.argv[4])
    coacd.set_log_level("error")
    start = time.perf_counter()
    parts = coacd.run_coacd(coacd.Mesh(vertices, faces), **options)
    seconds = time.perf_counter() - start
    with open(sys.argv[2], "w") as out:
        out.write(f"# seconds {seconds:.3f}\n")
        first = 1
        for i, (points, triangles) in enumerate(parts):
            out.write(f"o part_{i}\n")
            for p in points:
                out.write(f"v {p[0]:.9g} {p[1]:.9g} {p[2]:.9g}\n")
            for t in triangles:
                out.write(f"f {t[0] + first} {t[1] + first} {t[2] + first}\n")
            first += len(points)


if __name__ == "__main__":
    main()
