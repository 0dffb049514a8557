"""Runs comparisons that the benchmarks in C++ print themselves, and turns them into rows.

    python3 bench/peers/printed_rows.py physics

One of: retiming (TOPP-RA), parts (CoACD), rewards (PyTorch), physics (MuJoCo) and pendulum
(Stable-Baselines3). The peers run in .venv-bench, .venv-python and .venv-peers.
"""

import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from comparison import Comparison, parser_of, report

SOURCE = Path(__file__).resolve().parents[2]
NUMBER = r"\s+([\d.]+)"
# Seeds that the settings of bench_inverted_pendulum were not chosen on.
FIRST_SEED, SAMPLES_OF_QUICK_RUN = 201, 40_000


def python_of(name):
    return SOURCE / f".venv-{name}/bin/python"


def printed(*command):
    return subprocess.run([str(word) for word in command], check=True, stdout=subprocess.PIPE,
                          text=True).stdout


def version_of(name, package):
    return printed(python_of(name), "-c", "import importlib.metadata as m, sys; "
                   "print(m.version(sys.argv[1]))", package).strip()


def retiming(options):
    with tempfile.TemporaryDirectory() as folder:
        text = printed(options.bin / "bench_retiming_table", "--motions",
                       4 if options.full else 1, "--python", python_of("bench"), "--folder", folder)
    durations, seconds = text.split("At the limits")[1].split("Seconds of the processor")
    best = [float(one) for one in re.findall(NUMBER + r"\s+\d+$", durations, re.MULTILINE)]
    excess = max(float(one) for one in re.findall(r"\(([\d.]+)\)", durations))
    passed = re.findall(r" (\d+)/(\d+) ", durations)
    if any(one != of for one, of in passed):
        sys.exit("error: some of our motions do not pass the check of their limits")
    rows = [[float(number) for number in one] for one in re.findall(
        rf"panda\S*{NUMBER}{NUMBER} \+{NUMBER} \+{NUMBER}", seconds)]
    theirs = [sum(row[1:]) for row in rows]
    return Comparison(
        "retiming", f"TOPP-RA {version_of('bench', 'toppra')}", "s of a core per motion of 10 s",
        statistics.mean(row[0] for row in rows), statistics.mean(theirs),
        statistics.median(other / row[0] for row, other in zip(rows, theirs)),
        f"ours with a limit of jerk, within all limits, {min(best):.2f} to {max(best):.2f} times "
        f"as long as its shortest; its samples exceed limits by up to {100 * (excess - 1):.0f} %")


def parts(options):
    text = ""
    with tempfile.TemporaryDirectory() as folder:
        command = [options.bin / "bench_decomposition_table", "--coacd", python_of("bench"),
                   "--hacd", "no", "--folder", folder]
        for only in [[]] if options.full else [["--only", name] for name in ("chair", "cup", "gear",
                                                                            "hook")]:
            text += printed(*command, *only)
    columns = rf"\s+(\d+){7 * NUMBER}"
    sides = [[[float(number) for number in one] for one in
              re.findall(rf" {name}{columns}", text)] for name in ("ours", "CoACD")]
    concavity, volume = [[statistics.median(one[column] for one in side) for side in sides]
                         for column in (1, 4)]
    seconds = [sum(one[-1] for one in side) for side in sides]
    return Comparison(
        "parts", f"CoACD {version_of('bench', 'coacd')}", f"s for {len(sides[0])} solids",
        *seconds, seconds[1] / seconds[0],
        f"at most as many parts; median concavity {concavity[0]:.4f} and {concavity[1]:.4f}, "
        f"volume error {volume[0]:.4f} and {volume[1]:.4f}")


def rewards(options):
    text = printed(options.bin / "bench_reward_speed", "--python", python_of("python"))
    ours, theirs = re.search(r"\| 4096 \| ([\d.]+) \| ([\d.]+)", text).groups()
    return Comparison(
        "rewards", f"PyTorch {version_of('python', 'torch')}", "us of a core, 4096 environments",
        float(ours), float(theirs), float(theirs) / float(ours),
        "the same program; a test compares the results")


def physics(options):
    program = options.bin / "bench_environment_speed"
    mine, sleeping, theirs = [], [], []
    with tempfile.TemporaryDirectory() as folder:
        world = Path(folder) / "world.xml"
        subprocess.run([program, "--mjcf", world], check=True)
        for _ in range(5 if options.full else 3):
            text = printed(program, "--part", "physics", "--repeats", 1)
            for name, rates in (("Bullet, 20 iterations", mine),
                                ("20, bodies at rest asleep as in training", sleeping)):
                rates.append(float(re.search(rf"\| {name} \| (\d+)", text)[1]))
            text = printed(python_of("peers"), SOURCE / "bench/peers/training_world.py", world,
                           "--repeats", 1)
            theirs.append(float(re.search(r"\| MuJoCo \S+ \| (\d+)", text)[1]))
    ratio, asleep = [statistics.median(one / two for one, two in zip(side, theirs))
                     for side in (mine, sleeping)]
    return Comparison(
        "physics", f"MuJoCo {version_of('peers', 'mujoco')}",
        "steps of 240 Hz per s of a core", statistics.median(mine), statistics.median(theirs),
        ratio, f"the same Panda, microwave, cup and motors; with bodies asleep, as in training, "
        f"{asleep:.2f}")


def pendulum(options):
    seeds = ["--seeds", 5 if options.full else 2, "--first-seed", FIRST_SEED]
    samples = 100_000 if options.full else SAMPLES_OF_QUICK_RUN
    text = printed(options.bin / "bench_inverted_pendulum", *seeds, "--samples", samples,
                   "--play-every", 2048)
    mine = [int(one) for one in re.findall(r"^\| \d+ \| (\d+)", text, re.MULTILINE)]
    text = printed(python_of("python"), SOURCE / "bench/peers/inverted_pendulum.py", *seeds)
    theirs = [[int(one) for one in re.findall(rf"^\| {count} \| \d+ \| (\d+)", text, re.MULTILINE)]
              for count in (1, 16)]
    if 0 in mine:
        sys.exit("error: ours did not balance the pendulum")
    least = min(statistics.median(side) for side in theirs)
    return Comparison(
        "pendulum", f"Stable-Baselines3 {version_of('python', 'stable-baselines3')}",
        "samples of PPO to a return of 950", statistics.median(mine), least,
        least / statistics.median(mine), f"median of {len(mine)} seeds; theirs in MuJoCo with its "
        "default settings, the better of 1 and 16 environments; ours chosen on other seeds")


ROWS = {row.__name__: row for row in (retiming, parts, rewards, physics, pendulum)}


def main():
    parser = parser_of(__doc__)
    parser.add_argument("row", choices=ROWS)
    options = parser.parse_args()
    report(options, [ROWS[options.row](options)])


if __name__ == "__main__":
    main()
