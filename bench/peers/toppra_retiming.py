"""TOPP-RA on recorded motions: toppra_retiming.py IN.json OUT.json.

Times the motions that bench_retiming_table wrote, from rest to rest within the same limits of
velocity and acceleration, and samples them at the same rate. TOPP-RA has no limit of jerk and no
deviation: its path is its user's choice. Each motion is timed on several paths:

    points      the cubic spline through the recorded positions, which deviates from none of them
    tolerance   the smoothing spline that deviates from each joint's positions as much as ours does
    ours        the path of our own motion

OUT.json has for each motion and path the duration in s; the seconds for the path, for the time law
and for the samples (the least of REPEATS); the largest shares of the limits in the samples; and
the largest deviation relative to ours.
"""
import os

for _library in ("OPENBLAS", "OMP", "MKL"):
    os.environ[_library + "_NUM_THREADS"] = "1"

import json
import logging
import sys
import time

import numpy as np
import toppra
import toppra.algorithm
import toppra.constraint
from scipy.interpolate import UnivariateSpline
from toppra.interpolator import AbstractGeometricPath

REPEATS = 3
BISECTIONS = 25
DEGREE = 5  # of the smoothing splines, as of ours


class SmoothingPath(AbstractGeometricPath):
    """One smoothing spline per joint, over the recording's time."""

    def __init__(self, times, splines):
        self._splines = [[spline, spline.derivative(), spline.derivative(2)] for spline in splines]
        self._times = times

    def __call__(self, path_positions, order=0):
        values = [joint[order](path_positions) for joint in self._splines]
        return np.stack(values, axis=-1)

    @property
    def dof(self):
        return len(self._splines)

    @property
    def path_interval(self):
        return np.array([self._times[0], self._times[-1]])

    @property
    def waypoints(self):
        return None


def smoothing_spline(times, positions, deviation):
    """Returns the smoothest spline found that deviates from `positions` by at most `deviation`."""
    weights = np.ones(len(times))
    weights[[0, -1]] = 1e3  # the ends are met
    low, high = 0.0, len(times) * deviation**2
    best = UnivariateSpline(times, positions, w=weights, k=DEGREE, s=0.0)
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        spline = UnivariateSpline(times, positions, w=weights, k=DEGREE, s=middle)
        if np.max(np.abs(spline(times) - positions)) <= deviation:
            low, best = middle, spline
        else:
            high = middle
    return best


def tolerance_path(motion):
    times = np.array(motion["times"])
    columns = np.array(motion["positions"]).T
    return SmoothingPath(times, [
        smoothing_spline(times, column, max(deviation, 1e-9))
        for column, deviation in zip(columns, motion["deviations"])])


PATHS = {
    "points": lambda m: toppra.SplineInterpolator(np.array(m["times"]), np.array(m["positions"])),
    "tolerance": tolerance_path,
    "ours": lambda m: toppra.SplineInterpolator(
        np.arange(len(m["path"])) * m["path_step"], np.array(m["path"])),
}


def timed(path, motion):
    velocity = np.array(motion["velocity"])
    acceleration = np.array(motion["acceleration"])
    limits = [
        toppra.constraint.JointVelocityConstraint(np.stack([-velocity, velocity], axis=1)),
        toppra.constraint.JointAccelerationConstraint(np.stack([-acceleration, acceleration], axis=1)),
    ]
    start = time.process_time()
    trajectory = toppra.algorithm.TOPPRA(limits, path).compute_trajectory(0.0, 0.0)
    law = time.process_time() - start
    if trajectory is None:
        return None
    start = time.process_time()
    steps = int(np.ceil(trajectory.duration * motion["rate"]))
    moments = np.linspace(0.0, trajectory.duration, steps + 1)
    samples = [trajectory(moments, order) for order in range(3)]
    sampling = time.process_time() - start
    return {
        "duration": float(trajectory.duration),
        "law_seconds": law,
        "sample_seconds": sampling,
        "velocity_share": float(np.max(np.abs(samples[1]) / velocity)),
        "acceleration_share": float(np.max(np.abs(samples[2]) / acceleration)),
    }


def measure(motion, name):
    best = None
    for _ in range(REPEATS):
        start = time.process_time()
        path = PATHS[name](motion)
        path_seconds = time.process_time() - start
        row = timed(path, motion)
        if row is None:
            return None
        row["path_seconds"] = path_seconds
        if best is None:
            best = row
        for part in ("path_seconds", "law_seconds", "sample_seconds"):
            best[part] = min(best[part], row[part])
    if name == "tolerance":
        off = np.abs(path(np.array(motion["times"])) - np.array(motion["positions"]))
        share = np.max(off, axis=0) / np.maximum(motion["deviations"], 1e-9)
        best["deviation_share"] = float(np.max(share))
    return best


def main():
    logging.disable(logging.WARNING)
    with open(sys.argv[1]) as file:
        motions = json.load(file)["motions"]
    rows = []
    for motion in motions:
        rows.append({name: measure(motion, name) for name in PATHS})
        print(motion["name"], {n: r and round(r["duration"], 3) for n, r in rows[-1].items()},
              file=sys.stderr)
    with open(sys.argv[2], "w") as file:
        json.dump({"motions": rows}, file, indent=1)


if __name__ == "__main__":
    main()
