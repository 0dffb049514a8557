"""TOPP-RA on recorded motions: toppra_retiming.py IN.json OUT.json.

Times the motions that bench_retiming_table wrote, from rest to rest within the same limits of
velocity and acceleration, and samples them at the same rate. TOPP-RA has no limit of jerk and no
deviation: its path is its user's choice. Each motion is timed on several paths and grids:

    points          the cubic spline through the recorded positions, which deviates from none of
                    them, on the grid that toppra selects
    points_fine     the same on 16 grid points per recorded position
    tolerance_fine  on as many, the smoothing spline that deviates from the positions of each joint
                    as far as ours does
    ours_fine       on as many, the path of our own motion

OUT.json has for each motion and variant the duration in s; the processor's seconds for the path,
for the time law and for the samples (the least of REPEATS for `points`, which alone is compared by
them); and the largest shares of the limits of velocity and acceleration in the samples.
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
BISECTIONS = 14
DEGREE = 5  # of the smoothing splines, as of ours
FINE = 16  # grid points per recorded position


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


def points_path(motion):
    return toppra.SplineInterpolator(np.array(motion["times"]), np.array(motion["positions"]))


def our_path(motion):
    places = np.arange(len(motion["path"])) * motion["path_step"]
    return toppra.SplineInterpolator(places, np.array(motion["path"]))


VARIANTS = {  # path, whether the grid is fine
    "points": (points_path, False),
    "points_fine": (points_path, True),
    "tolerance_fine": (tolerance_path, True),
    "ours_fine": (our_path, True),
}


def timed(path, motion, fine):
    velocity = np.array(motion["velocity"])
    acceleration = np.array(motion["acceleration"])
    constraints = [
        kind(np.stack([-limit, limit], axis=1))
        for kind, limit in ((toppra.constraint.JointVelocityConstraint, velocity),
                            (toppra.constraint.JointAccelerationConstraint, acceleration))]
    grid = np.linspace(*path.path_interval, FINE * (len(motion["times"]) - 1) + 1) if fine else None
    start = time.process_time()
    law_of = toppra.algorithm.TOPPRA(constraints, path, gridpoints=grid)
    trajectory = law_of.compute_trajectory(0.0, 0.0)
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


def measure(motion, variant):
    make_path, fine = VARIANTS[variant]
    best = None
    for _ in range(1 if fine else REPEATS):
        start = time.process_time()
        path = make_path(motion)
        path_seconds = time.process_time() - start
        row = timed(path, motion, fine)
        if row is None:
            return None
        row["path_seconds"] = path_seconds
        best = best or row
        for part in ("path_seconds", "law_seconds", "sample_seconds"):
            best[part] = min(best[part], row[part])
    return best


def main():
    logging.disable(logging.WARNING)
    with open(sys.argv[1]) as file:
        motions = json.load(file)["motions"]
    rows = [{variant: measure(motion, variant) for variant in VARIANTS} for motion in motions]
    with open(sys.argv[2], "w") as file:
        json.dump({"motions": rows}, file, indent=1)


if __name__ == "__main__":
    main()
