"""Runs all comparisons with other libraries and prints one table.

    ./setup.sh --peers --python
    cmake --preset release -DSIMWRIGHT_BENCH=ON && cmake --build --preset release
    python3 bench/peers/table.py

Each row is measured on both sides in one run, in turn. A ratio above 1 means that ours is faster or
better; the last column states the equal quality. The quick run takes less than ten minutes on two
cores, --full has the sizes of docs/figures.md. A row whose peer or program is missing says so. The
exit code is 1 where a row fails, or has a ratio below 1 and no reason.
"""

import argparse
import dataclasses
import glob
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from comparison import HEADER, Comparison, parser_of

SOURCE = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent


@dataclasses.dataclass
class Row:
    """A comparison: its script runs in a virtual environment or, with "", in this Python."""

    name: str
    script: str
    environment: str
    programs: tuple[str, ...]
    needs: tuple[tuple[str, str], ...]  # virtual environment and module of each peer

    def missing(self, folder: Path) -> str:
        """Returns the reason why the row cannot run, or nothing."""
        for environment, module in self.needs:
            if not has_module(environment, module):
                option = "--python" if environment == "python" else "--peers"
                return f"not installed: ./setup.sh {option}"
            if module == "mitsuba" and not glob.glob("/usr/lib/*/libLLVM*.so*"):
                return "not installed: sudo apt-get install libllvm19 (for Mitsuba)"
        for program in self.programs:
            if not (folder / program).exists():
                return f"not built: {program} (cmake --preset release -DSIMWRIGHT_BENCH=ON)"
        return ""

    def command(self) -> list[str]:
        python = python_of(self.environment) if self.environment else sys.executable
        command = [str(python), str(HERE / self.script)]
        return command if self.environment else command + [self.name]


ROWS = (
    Row("rays", "forward_rays.py", "bench", ("bench_forward_rays",),
        (("bench", "mitsuba"), ("bench", "open3d"))),
    Row("gradients", "silhouette_gradients.py", "bench", ("bench_silhouette_gradients",),
        (("bench", "mitsuba"),)),
    Row("training", "diffusion_training.py", "python", ("bench_training_speed",),
        (("python", "torch"),)),
    Row("ppo", "panda_ppo.py", "python", ("bench_environment_speed", "simwright"),
        (("python", "stable_baselines3"), ("python", "pybullet"))),
    Row("pendulum", "printed_rows.py", "", ("bench_inverted_pendulum",),
        (("python", "stable_baselines3"), ("python", "mujoco"), ("python", "imageio"))),
    Row("physics", "printed_rows.py", "", ("bench_environment_speed",), (("peers", "mujoco"),)),
    Row("projection", "projection.py", "peers", ("bench_box_piles",), (("peers", "pydrake"),)),
    Row("import", "mesh_import.py", "bench", ("simwright",),
        (("bench", "trimesh"), ("bench", "manifold3d"), ("bench", "coacd"), ("bench", "vhacdx"))),
    Row("parts", "printed_rows.py", "", ("bench_decomposition_table",), (("bench", "coacd"),)),
    Row("retiming", "printed_rows.py", "", ("bench_retiming_table",), (("bench", "toppra"),)),
    Row("rewards", "printed_rows.py", "", ("bench_reward_speed",), (("python", "torch"),)),
)


def python_of(environment: str) -> Path:
    return SOURCE / f".venv-{environment}/bin/python"


def has_module(environment: str, module: str) -> bool:
    python = python_of(environment)
    return python.exists() and subprocess.run(
        [python, "-c", f"import importlib.util as u, sys; sys.exit(not u.find_spec({module!r}))"],
        check=False).returncode == 0


def run(row: Row, options: argparse.Namespace, folder: Path) -> tuple[list[str], bool]:
    """Returns the lines of the table of a row, and whether they are as they should be."""
    reason = row.missing(options.bin)
    if reason:
        return [f"| {row.name} | {reason} | | | | | |"], True
    rows = folder / f"{row.name}.json"
    log = folder / f"{row.name}.log"
    start = time.monotonic()
    print(f"{row.name} ...", end="", file=sys.stderr, flush=True)
    with log.open("w") as output:
        code = subprocess.run(
            [*row.command(), "--bin", str(options.bin), "--rows", str(rows)] +
            ["--full"] * options.full, stdout=output, stderr=subprocess.STDOUT,
            check=False).returncode
    print(f" {time.monotonic() - start:.0f} s", file=sys.stderr, flush=True)
    if code != 0:
        said = [line for line in log.read_text().splitlines() if line.strip()]
        return [f"| {row.name} | failed: {said[-1] if said else code} | | | | | |"], False
    found = rows.read_text()
    if options.rows:
        with options.rows.open("a") as file:
            file.write(found)
    comparisons = [Comparison(**json.loads(line)) for line in found.splitlines()]
    return [one.line() for one in comparisons], all(
        one.ratio >= 1.0 or one.explanation for one in comparisons)


def main() -> int:
    parser = parser_of(__doc__)
    parser.add_argument("--only", nargs="+", metavar="ROW", choices=[row.name for row in ROWS],
                        help="run only these rows: " + ", ".join(row.name for row in ROWS))
    parser.add_argument("-o", "--output", type=Path, metavar="FILE",
                        help="write the table to this file too")
    options = parser.parse_args()
    options.bin = options.bin.resolve()
    for file in (options.rows, options.output):
        if file and not file.parent.is_dir():
            parser.error(f"{file}: there is no folder {file.parent}")
    chosen = [row for row in ROWS if not options.only or row.name in options.only]
    if all(row.missing(options.bin) for row in chosen):
        parser.error("no row can run: " + "; ".join(
            f"{row.name}: {row.missing(options.bin)}" for row in chosen))
    lines, good = HEADER.splitlines(), True
    with tempfile.TemporaryDirectory() as folder:
        for row in chosen:
            found, fine = run(row, options, Path(folder))
            lines += found
            good = good and fine
    print("\n".join(lines))
    if options.output:
        options.output.write_text("\n".join(lines) + "\n")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
