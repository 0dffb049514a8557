"""Tests the table of bench/peers with scripts that stand in for comparisons."""

import argparse
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "bench/peers"))
sys.dont_write_bytecode = True

import table
from comparison import Comparison, short

SCRIPT = """
import sys
sys.path.insert(0, {folder!r})
from comparison import Comparison, parser_of, report
parser = parser_of("")
parser.add_argument("row")
options = parser.parse_args()
report(options, [Comparison(options.row, "peer", "s", 2.0, 1.0, {ratio}, "same", {reason!r})])
"""


class TableTest(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)

    def run_row(self, script, programs=(), needs=()):
        path = self.folder / "script.py"
        path.write_text(script)
        options = argparse.Namespace(bin=self.folder, full=False, rows=None)
        row = table.Row("speed", str(path), "", programs, needs)
        return table.run(row, options, self.folder)

    def run_ratio(self, ratio, reason=""):
        folder = str(Path(table.__file__).parent)
        return self.run_row(SCRIPT.format(folder=folder, ratio=ratio, reason=reason))

    def test_row_of_a_faster_program(self):
        lines, good = self.run_ratio(2.5)
        self.assertEqual(lines, ["| speed | peer | s | 2.00 | 1.00 | 2.50 | same |"])
        self.assertTrue(good)

    def test_slower_program_needs_a_reason(self):
        self.assertFalse(self.run_ratio(0.5)[1])
        (self.folder / "speed.json").unlink()
        lines, good = self.run_ratio(0.5, "theirs is less exact")
        self.assertIn("same; theirs is less exact", lines[0])
        self.assertTrue(good)

    def test_missing_peer_is_a_line(self):
        lines, good = self.run_row("", needs=(("bench", "no_such_module"),))
        self.assertIn("not installed: ./setup.sh --peers", lines[0])
        self.assertTrue(good)
        self.assertIn("--python", self.run_row("", needs=(("python", "no_such_module"),))[0][0])

    def test_missing_program_is_a_line(self):
        lines, good = self.run_row("", programs=("bench_nothing",))
        self.assertIn("not built: bench_nothing", lines[0])
        self.assertTrue(good)

    def test_failure_is_a_line_with_its_reason(self):
        lines, good = self.run_row("import sys; sys.exit('error: the pictures differ')")
        self.assertIn("failed: error: the pictures differ", lines[0])
        self.assertFalse(good)

    def test_scripts_exist_and_lines_have_seven_columns(self):
        for row in table.ROWS:
            self.assertTrue((table.HERE / row.script).exists(), row.script)
        line = Comparison("a", "b", "c", 1.0, 1.0, 1.0, "d").line()
        self.assertEqual(line.count("|"), table.HEADER.splitlines()[0].count("|"))

    def test_short_has_three_digits(self):
        numbers = (0.012345, 1.2345, 12.345, 123.45, 16536.0)
        self.assertEqual([short(x) for x in numbers], ["0.0123", "1.23", "12.3", "123", "16536"])


if __name__ == "__main__":
    unittest.main()
