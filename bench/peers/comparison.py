"""The row that every comparison of bench/peers hands to bench/peers/table.py."""

import argparse
import dataclasses
import json
import math
from pathlib import Path


@dataclasses.dataclass
class Comparison:
    """One row of the table. A ratio above 1 means that ours is faster or better."""

    row: str  # its name for --only
    against: str  # the peer and its version
    measured: str  # the quantity and its unit
    ours: float
    theirs: float
    ratio: float
    quality: str  # the equal quality at which the two were measured
    explanation: str = ""  # the reason of a ratio below 1

    def line(self) -> str:
        """Returns the row of the Markdown table."""
        quality = "; ".join(part for part in (self.quality, self.explanation) if part)
        return (f"| {self.row} | {self.against} | {self.measured} | {short(self.ours)} | "
                f"{short(self.theirs)} | {short(self.ratio)} | {quality} |")


HEADER = ("| row | peer | measured | ours | theirs | ratio | quality |\n"
          "|---|---|---|---|---|---|---|")


def short(number: float) -> str:
    """Returns three digits, and all digits before the point."""
    if not math.isfinite(number) or number == 0:
        return str(number)
    return f"{number:.{max(0, 2 - math.floor(math.log10(abs(number))))}f}"


def parser_of(text: str | None) -> argparse.ArgumentParser:
    """Returns a parser with the options that all comparisons share."""
    parser = argparse.ArgumentParser(
        description=text, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=Path, default=Path(__file__).resolve().parents[2] / "build/bin", metavar="DIR",
                        help="folder of the benchmarks")
    parser.add_argument("--full", action="store_true", help="the sizes of docs/figures.md")
    parser.add_argument("--rows", type=Path, metavar="FILE",
                        help="file to which the rows are appended as lines of JSON")
    return parser


def report(options: argparse.Namespace, comparisons: list[Comparison]) -> None:
    """Prints the rows as a table, and appends them to the file of --rows."""
    print(HEADER)
    for comparison in comparisons:
        print(comparison.line(), flush=True)
    if options.rows:
        with options.rows.open("a") as file:
            for comparison in comparisons:
                file.write(json.dumps(dataclasses.asdict(comparison)) + "\n")
