#!/usr/bin/env python3
"""Trains tasks of a factory that are drawn by lot, and prints how often the policies succeed.

    build/bin/simwright factory --theme kitchen --assets 200 --tasks 500 -o kitchen
    python3 bench/factory/train_drawn_tasks.py kitchen [--count 10] [--decisions 150000]
        [--seed 1] [--seconds 8] [-o FOLDER]

Each task is trained by `simwright train` for at most --decisions a subtask, so that the speed
of the machine does not matter, then `simwright rollout` measures the success of the whole task from
200 fresh starts. A failed training counts as none.
SIMWRIGHT_PROGRAM names the program (build/bin/simwright). --resume keeps what FOLDER holds.
"""

import argparse
import json
import os
import pathlib
import random
import subprocess
import time

PROGRAM = os.environ.get("SIMWRIGHT_PROGRAM", "build/bin/simwright")
EPISODES = 200
WANTED = 0.8


def train(tasks, name, folder, options):
    """Trains one task and returns the report of its rollouts, or the reason for none."""
    if not (options.resume and (folder / "report.json").exists()):
        command = [PROGRAM, "train", str(tasks), "--task", name, "-o", str(folder), "--quiet",
                   "--minutes", "0", "--steps", str(options.decisions),
                   "--seconds", str(options.seconds)]
        trained = subprocess.run(command, capture_output=True, text=True, check=False)
        if not (folder / "report.json").exists():
            lines = (trained.stderr.strip() or trained.stdout.strip()).splitlines()
            return None, lines[-1] if lines else "no report"
    rolled = subprocess.run(
        [PROGRAM, "rollout", str(folder), "--episodes", str(EPISODES), "--json", "--quiet"],
        capture_output=True, text=True, check=False)
    if rolled.returncode != 0:
        return None, rolled.stderr.strip().splitlines()[-1]
    return json.loads(rolled.stdout), ""


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("factory", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=10)
    parser.add_argument("--decisions", type=int, default=150_000)
    parser.add_argument("--seconds", type=float, default=8.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--resume", action="store_true")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("drawn_tasks"))
    options = parser.parse_args()
    tasks = options.factory / "tasks.json"
    names = sorted(task["name"] for task in json.loads(tasks.read_text())["tasks"])
    drawn = random.Random(options.seed).sample(names, min(options.count, len(names)))
    options.output.mkdir(parents=True, exist_ok=True)
    reached = 0
    for name in drawn:
        start = time.monotonic()
        report, reason = train(tasks, name, options.output / name, options)
        minutes = (time.monotonic() - start) / 60.0
        if report is None:
            print(f"{name}: not trained: {reason} ({minutes:.1f} min)", flush=True)
            continue
        rate = report["successes"] / report["episodes"]
        reached += rate >= WANTED
        print(f"{name}: {100 * rate:.0f} % ({minutes:.1f} min)", flush=True)
    print(f"{reached} of {len(drawn)} tasks reach {100 * WANTED:.0f} %")


if __name__ == "__main__":
    main()
