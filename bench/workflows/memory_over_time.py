"""Records the resident memory of a command while it runs, and plots several recordings.

    python3 bench/workflows/memory_over_time.py record out/library.csv -- build/bin/simwright \
        library --kind rigid --count 12 -o out/library
    .venv-peers/bin/python bench/workflows/memory_over_time.py plot memory.svg out/*.csv

A recording has a line every two seconds: seconds, resident MiB, seconds of processor time. The plot
shows the share of the duration on its horizontal axis; a legend names each recording, its duration
and its largest memory. The exit code of `record` is that of the command.
"""

import argparse
import os
import subprocess
import sys
import time
from pathlib import Path

INTERVAL = 2.0  # s


def sample(process):
    """Returns the resident memory (MiB) and the processor time (s) of a process, if it runs."""
    try:
        pages = int(Path(f"/proc/{process}/statm").read_text().split()[1])
        ticks = Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[11:13]
    except (OSError, IndexError):
        return None
    return (pages * os.sysconf("SC_PAGESIZE") / 2**20,
            sum(map(int, ticks)) / os.sysconf("SC_CLK_TCK"))


def record(output, command):
    begin = time.monotonic()
    running = subprocess.Popen(command)
    with open(output, "w", encoding="utf-8") as file:
        while running.poll() is None:
            seen = sample(running.pid)
            if seen and seen[0] > 0.0:
                print(f"{time.monotonic() - begin:.1f},{seen[0]:.1f},{seen[1]:.1f}", file=file,
                      flush=True)
            time.sleep(INTERVAL)
    return running.returncode


def plot(output, recordings):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(7.5, 3.6), layout="constrained")
    for recording in recordings:
        rows = [tuple(map(float, line.split(",")))
                for line in Path(recording).read_text(encoding="utf-8").splitlines()]
        seconds, memory = [row[0] for row in rows], [row[1] for row in rows]
        label = f"{Path(recording).stem}: {seconds[-1] / 60:.0f} min, at most {max(memory):.0f} MiB"
        axes.plot([100.0 * second / seconds[-1] for second in seconds], memory, label=label, lw=1.2)
    axes.set(xlabel="% of the duration", ylabel="resident memory, MiB", ylim=(0, None), xlim=(0, 100))
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
    figure.savefig(output)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parts = parser.add_subparsers(dest="part", required=True)
    recording = parts.add_parser("record")
    recording.add_argument("output")
    recording.add_argument("command", nargs=argparse.REMAINDER)
    plotting = parts.add_parser("plot")
    plotting.add_argument("output")
    plotting.add_argument("recordings", nargs="+")
    options = parser.parse_args()
    if options.part == "plot":
        return plot(options.output, options.recordings)
    command = options.command[1:] if options.command[:1] == ["--"] else options.command
    if not command:
        parser.error("no command is given (record FILE -- COMMAND...)")
    return record(options.output, command)


if __name__ == "__main__":
    sys.exit(main())
