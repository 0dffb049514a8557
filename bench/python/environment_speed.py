"""Measures decisions per second of the environments, in Python beside the C++ loop.

    ninja -C build bench_task_environment simwright_python
    PYTHONPATH=build/python .venv-python/bin/python bench/python/environment_speed.py

All loops run the same tasks, seed, actions and numbers of environments, one after the other in each
repeat; the table shows the median over the repeats and its ratio to the C++ loop.
"""

import argparse
import statistics
import subprocess
import time
from pathlib import Path

import gymnasium
import numpy as np

import simwright
from simwright import envs
from simwright._cells import cell_tasks

SOURCE = Path(__file__).resolve().parents[2]


def actions_at(step, count, size):
    rows = np.arange(count, dtype=np.float32)[:, None]
    columns = np.arange(size, dtype=np.float32)[None]
    return (0.6 * np.sin(np.float32(0.7 * step) + rows + 2.0 * columns)).astype(np.float32)


def rate(env, reset, count, steps):
    """Returns decisions per second of `env`, after `reset`."""
    reset()
    size = env.action_space.shape[-1]
    start = time.perf_counter()
    for step in range(steps):
        env.step(actions_at(step, count, size))
    return count * steps / (time.perf_counter() - start)


def single_rate(env, steps):
    env.reset(seed=1)
    size = env.action_space.shape[-1]
    start = time.perf_counter()
    for step in range(steps):
        if any(env.step(actions_at(step, 1, size)[0])[2:4]):
            env.reset()
    return steps / (time.perf_counter() - start)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--num-envs", type=int, default=64)
    parser.add_argument("--steps", type=int, default=100)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--program", default=str(SOURCE / "build/bin/bench_task_environment"))
    flags = parser.parse_args()
    count, steps = flags.num_envs, flags.steps
    cell = dict(cell="open_drawer", instances=4)
    file = cell_tasks("open_drawer", "train", 4)
    native = envs.SkillVectorEnv(num_envs=count, **cell)
    loops = {
        "C++": lambda: float(subprocess.run(
            [flags.program, str(file), "--envs", str(count), "--steps", str(steps), "--repeats", "1"],
            check=True, capture_output=True, text=True).stdout),
        "Gymnasium VectorEnv": lambda: rate(native, lambda: native.reset(seed=1), count, steps),
    }
    try:
        from simwright.sb3 import VecEnv

        wrapped = VecEnv(native)
        loops["Stable-Baselines3 VecEnv"] = lambda: rate(wrapped, wrapped.reset, count, steps)
    except ImportError:
        pass
    pictures = envs.SkillVectorEnv(num_envs=count, **cell, cameras=["front"])
    loops["VectorEnv, one camera of 128 x 128"] = lambda: rate(
        pictures, lambda: pictures.reset(seed=1), count, max(1, steps // 5))
    single = envs.SkillEnv(**cell)
    loops["Env, one environment"] = lambda: single_rate(single, 5 * steps)
    asynchronous = gymnasium.make_vec("simwright/OpenDrawer-v0", num_envs=2, instances=4,
                                      vectorization_mode="async")
    loops["AsyncVectorEnv, two environments"] = lambda: rate(
        asynchronous, lambda: asynchronous.reset(seed=1), 2, 5 * steps)
    found = {name: [] for name in loops}
    for _ in range(flags.repeats):
        for name, loop in loops.items():
            found[name].append(loop())
    print(f"open_drawer, {count} environments, {simwright.threads()} threads, "
          f"{flags.repeats} repeats\n")
    print("| loop | decisions/s | of C++ |\n|---|---|---|")
    for name, rates in found.items():
        ratios = [own / other for own, other in zip(rates, found["C++"])]
        print(f"| {name} | {statistics.median(rates):.0f} | {statistics.median(ratios):.2f} |")
    asynchronous.close()


if __name__ == "__main__":
    main()
