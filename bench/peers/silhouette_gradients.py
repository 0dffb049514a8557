"""Compares the gradients of silhouettes with Mitsuba 3's: the time of a step at equal error.

    .venv-bench/bin/python bench/peers/silhouette_gradients.py

A step moves the vertices of the closed bumpy ball, renders 128 x 128 pixels with four samples each,
and differentiates a weighted mean of the mask with respect to the vertices. Mitsuba draws the mask
as a light without reflections (prb_projective, one segment, no continuous and no indirect terms:
the mask has none), ours draws colour and depth beside it. The gradients of both are projected onto
the same 24 displacement fields and compared with central differences of 5120 x 5120 rays, along
which neither side's gradients are used. Both run with several numbers of edge samples, in turn; the
time at an error is interpolated between the settings, and never below that of the cheapest setting.
"""

import json
import subprocess
import sys
import time

import numpy as np

from comparison import Comparison, parser_of, report
from forward_rays import bumpy_ball, find_llvm, orbit_rays

PIXELS, FIELDS = 128, 24
EDGES = (1000, 4000, 16000, 64000, 256000)  # of ours, per image
SAMPLES = (1, 4, 16)  # of Mitsuba, per pixel
ERRORS = (0.04, 0.02)  # compared at, relative


def closed_ball(triangles):
    """Returns vertices and triangles of bench_silhouette_gradients' mesh."""
    vertices, faces = bumpy_ball(triangles)
    sectors = 2 * round((triangles / 4) ** 0.5)
    count = len(vertices)
    j = np.arange(sectors)
    after, last = (j + 1) % sectors, count - sectors
    caps = [np.stack([np.full(sectors, count), j, after], 1),
            np.stack([np.full(sectors, count + 1), last + after, last + j], 1)]
    vertices = np.concatenate([vertices, [[0, 0, 0.5], [0, 0, -0.5]]])
    return vertices.astype(np.float32), np.concatenate([faces, *caps]).astype(np.uint32)


def fields_at(vertices):
    """Returns the displacement fields at the vertices (FIELDS x N x 3)."""
    fields = np.zeros((FIELDS, *vertices.shape))
    for k in range(FIELDS):
        direction = np.array([np.sin(k), np.cos(2.0 * k), np.sin(3.0 * k + 1.0)])
        frequency = 3.0 * (k // 3) * direction / np.linalg.norm(direction)
        fields[k, :, k % 3] = np.cos(vertices @ frequency + (k if k >= 3 else 0.0))
    return fields


def pixel_weights():
    x, y = np.meshgrid((np.arange(PIXELS) + 0.5) / PIXELS, (np.arange(PIXELS) + 0.5) / PIXELS)
    return (1.0 + 0.6 * np.sin(7.0 * x + 2.0 * y)) / PIXELS**2


class Mitsuba:
    """Mitsuba's steps on the same mesh, camera and loss."""

    def __init__(self, triangles):
        import drjit
        import mitsuba
        mitsuba.set_variant("llvm_ad_mono")
        mitsuba.set_log_level(mitsuba.LogLevel.Error)
        self.drjit, self.mitsuba = drjit, mitsuba
        self.vertices, faces = closed_ball(triangles)
        self.fields = fields_at(self.vertices.astype(float))
        properties = mitsuba.Properties()
        properties["emitter"] = mitsuba.load_dict(
            {"type": "area", "radiance": {"type": "rgb", "value": 1.0}})
        mesh = mitsuba.Mesh("ball", len(self.vertices), len(faces), props=properties)
        parameters = mitsuba.traverse(mesh)
        parameters["vertex_positions"] = self.vertices.ravel()
        parameters["faces"] = faces.ravel()
        parameters.update()
        self.scene = mitsuba.load_dict({"type": "scene", "ball": mesh, "camera": self.camera()})
        self.parameters = mitsuba.traverse(self.scene)
        self.key = next(key for key in self.parameters.keys() if key.endswith("vertex_positions"))
        self.parameters.keep([self.key])
        self.weights = mitsuba.TensorXf(pixel_weights()[..., None].astype(np.float32))
        self.positions = mitsuba.Float(self.vertices.ravel())

    def camera(self):
        eye, _ = orbit_rays()
        transform = self.mitsuba.ScalarTransform4f().look_at(
            origin=eye.tolist(), target=[0, 0, 0], up=[0, 0, 1])
        return {"type": "perspective", "fov": float(np.degrees(0.61)), "fov_axis": "y",
                "to_world": transform,
                "film": {"type": "hdrfilm", "width": PIXELS, "height": PIXELS,
                         "pixel_format": "luminance", "rfilter": {"type": "box"},
                         "sample_border": False},
                "sampler": {"type": "independent", "sample_count": 4}}

    def step(self, integrator, seed):
        """Returns the loss and its gradient with respect to the vertices (flat)."""
        drjit = self.drjit
        positions = self.mitsuba.Float(self.positions)
        drjit.enable_grad(positions)
        self.parameters[self.key] = positions
        self.parameters.update()
        image = self.mitsuba.render(self.scene, self.parameters, integrator=integrator, seed=seed)
        loss = drjit.sum(image * self.weights)
        drjit.backward(loss)
        gradient = drjit.grad(self.parameters[self.key])
        drjit.eval(gradient, loss)
        drjit.sync_thread()
        return loss, gradient

    def measure(self, samples, repeats):
        """Returns the lower quartiles of ms (clock, processor), the projected gradients (repeats x
        FIELDS) and the mean loss."""
        integrator = self.mitsuba.load_dict(
            {"type": "prb_projective", "max_depth": 1, "sppc": 0, "sppp": samples, "sppi": 0})
        milliseconds, rows, losses = [], [], []
        for seed in range(-3, repeats):
            start = np.array([time.perf_counter(), time.process_time()])
            loss, gradient = self.step(integrator, seed + 100)
            took = 1e3 * (np.array([time.perf_counter(), time.process_time()]) - start)
            if seed < 0:
                continue
            milliseconds.append(took)
            rows.append(np.tensordot(self.fields, np.array(gradient).reshape(-1, 3), 2))
            losses.append(np.array(loss).item())
        return np.quantile(milliseconds, 0.25, axis=0), np.array(rows), float(np.mean(losses))


def ours(program, triangles, repeats, reference):
    printed = subprocess.run(
        [program, "--triangles", str(triangles), "--repeats", str(repeats),
         "--edges", *map(str, EDGES)] + ["--reference"] * reference,
        check=True, stdout=subprocess.PIPE, text=True).stdout
    return json.loads(printed)


def relative_error(gradients, reference):
    """Returns the root mean square over the steps of the relative error of a step's gradient."""
    squares = np.sum((np.asarray(gradients) - reference) ** 2, axis=1)
    return float(np.sqrt(np.mean(squares)) / np.linalg.norm(reference))


def time_at(error, errors, times):
    """Returns the interpolated time at an error; extrapolated as 1 / error^2 beyond the last."""
    order = np.argsort(errors)[::-1]
    errors, times = np.asarray(errors)[order], np.asarray(times)[order]
    if error < errors[-1]:
        return float(times[-1] * (errors[-1] / error) ** 2)
    return float(np.exp(np.interp(-np.log(error), -np.log(errors), np.log(times))))


def compare(options, triangles):
    """Measures both sides in turn; returns a row per compared error."""
    program, repeats = options.bin / "bench_silhouette_gradients", 40 if options.full else 12
    peer = Mitsuba(triangles)
    rounds = 5 if options.full else 3
    our_rounds, their_rounds = [], []
    for turn in range(rounds):
        our_rounds.append(ours(program, triangles, repeats, turn == 0))
        their_rounds.append([peer.measure(samples, repeats) for samples in SAMPLES])
    reference = np.mean(our_rounds[0]["reference"], axis=0)
    loss = our_rounds[0]["loss"]
    if abs(their_rounds[0][-1][2] - loss) > 0.003 * loss:
        sys.exit(f"error: the images differ: losses {loss:.5f} and {their_rounds[0][-1][2]:.5f}")
    our_errors = [relative_error(one["gradients"], reference) for one in our_rounds[0]["settings"]]
    their_errors = [relative_error(one[1], reference) for one in their_rounds[0]]
    our_times, their_times = [np.min(times, axis=0).T for times in (
        [[[one["ms"], one["processor_ms"]] for one in turn["settings"]] for turn in our_rounds],
        [[one[0] for one in turn] for turn in their_rounds])]
    for name, counts, errors, times in (("ours", EDGES, our_errors, our_times),
                                        ("Mitsuba", SAMPLES, their_errors, their_times)):
        for count, error, took, processor in zip(counts, errors, *times):
            print(f"{name}, {triangles} triangles, {count}: error {error:.4f}, {took:.2f} ms, "
                  f"{processor:.2f} of the processor", flush=True)
    rows = []
    for error in ERRORS:
        mine, own = [time_at(error, our_errors, times) for times in our_times]
        other, theirs = [time_at(error, their_errors, times) for times in their_times]
        rows.append(Comparison(
            "gradients", f"Mitsuba {peer.mitsuba.__version__}",
            f"ms per step, {triangles} triangles, 128 x 128", mine, other, other / mine,
            f"of processor time {theirs / own:.1f}; gradient within {100 * error:.0f} % of finite "
            "differences"))
    return rows


def main():
    find_llvm()
    options = parser_of(__doc__).parse_args()
    sizes = (1000, 10000, 100000) if options.full else (10000,)
    report(options, [row for size in sizes for row in compare(options, size)])


if __name__ == "__main__":
    main()
