"""Measures MuJoCo 4 on the training world of bench_environment_speed: steps per second of a core.

    build/bin/bench_environment_speed --mjcf world.xml
    .venv-peers/bin/python bench/peers/training_world.py world.xml [--repeats 6]

The bodies, motors and commands are those of `bench_environment_speed --part physics`, whose table
is the counterpart. MuJoCo's own defaults; a command lasts four steps of 240 Hz, as in training. The
time is that of the thread: numpy's threads spin beside it on an idle machine.
"""

import argparse
import time

import mujoco
import numpy as np

STEPS, SETTLE, SUBSTEPS = 1200, 120, 4
ARM_JOINTS = 7


def run(model, data, home, steps, begin):
    joints = np.arange(ARM_JOINTS)
    for step in range(begin, begin + steps, SUBSTEPS):
        now = (step + SUBSTEPS) * model.opt.timestep
        data.ctrl[:] = home
        data.ctrl[:ARM_JOINTS] += 0.2 * np.sin((2.0 + 0.3 * joints) * now)
        mujoco.mj_step(model, data, SUBSTEPS)
    return begin + steps


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("mjcf")
    parser.add_argument("--repeats", type=int, default=6)
    arguments = parser.parse_args()
    model = mujoco.MjModel.from_xml_path(arguments.mjcf)
    data = mujoco.MjData(model)
    home = model.numeric_data[: model.nu].copy()
    for motor in range(model.nu):
        data.qpos[model.jnt_qposadr[model.actuator_trnid[motor, 0]]] = home[motor]
    mujoco.mj_forward(model, data)
    step = run(model, data, home, SETTLE, 0)
    best = 0.0
    for _ in range(arguments.repeats):
        start = time.thread_time()
        step = run(model, data, home, STEPS, step)
        best = max(best, STEPS / (time.thread_time() - start))
    print(f"| MuJoCo {mujoco.__version__} | {best:.0f} |  ({data.ncon} contacts at the end)")


if __name__ == "__main__":
    main()
