"""./experiment and ./figures end to end, with the real programs: one seed and a few views."""

import csv
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = pathlib.Path(os.environ.get("NEXTVIEW_PROGRAMS_FOLDER", ROOT / "build" / "release" / "bin"))


def started(script, *arguments):
    return subprocess.run([sys.executable, "-B", str(ROOT / script), *map(str, arguments),
                           "--programs", str(PROGRAMS)],
                          capture_output=True, text=True, check=False)


def last_digest(run):
    with open(run / "views.csv", newline="", encoding="utf-8") as lines:
        return list(csv.DictReader(lines))[-1]["map_digest"]


class Experiment(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = pathlib.Path(cls.folder.name)
        cls.out = cls.path / "out"
        # A planner of a user's own, which decides as ours does.
        own = cls.path / "own_planner"
        own.write_text(f'#!/bin/sh\necho "$*" > {cls.path}/started\nexec {PROGRAMS}/nextview_planner "$@"\n',
                       encoding="utf-8")
        own.chmod(0o755)
        cls.said = started("runner/experiment.py", "--scenes", "boxes", "--strategies", "paper", "surface",
                           f"own=--planner {own}", "--seeds", "1", "--views", "4", "5", "--out", cls.out)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def figures(self, *arguments):
        return started("reports/figures.py", *arguments)

    def assert_drawn(self, folder, name, words):
        """Both files are pictures, and the SVG's text has these words."""
        self.assertEqual((folder / f"{name}.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n", name)
        text = " ".join(xml.etree.ElementTree.parse(folder / f"{name}.svg").getroot().itertext())
        text = re.sub(r"\s+", " ", text.replace("\xa0", " "))
        for word in words:
            self.assertIn(word, text, name)

    def test_makes_the_table(self):
        self.assertEqual(self.said.returncode, 0, self.said.stdout + self.said.stderr)
        self.assertIn("6 runs, of which 0 are there already", self.said.stdout)
        with open(self.out / "table.csv", newline="", encoding="utf-8") as lines:
            table = {(row["quality"], row["strategy"], row["metric"]): row for row in csv.DictReader(lines)}
        for strategy in ("paper", "surface", "own"):
            self.assertEqual(table["off", strategy, "views"]["mean"], "4")
            self.assertEqual(table["on", strategy, "views"]["mean"], "5")
            self.assertGreater(float(table["off", strategy, "surface_coverage"]["mean"]), 0.1)
            self.assertGreater(float(table["off", strategy, "map_memory"]["mean"]), 0.1)
        self.assertEqual(table["on", "paper", "view_time"]["paper"], "14.7")

    def test_a_planner_of_ones_own_decides(self):
        self.assertRegex((self.path / "started").read_text(encoding="utf-8"), r"--lcm-url=udpm.* --run=\d+")
        self.assertEqual(last_digest(self.out / "boxes-own-default-off-seed1"),
                         last_digest(self.out / "boxes-surface-default-off-seed1"))
        self.assertNotEqual(last_digest(self.out / "boxes-own-default-off-seed1"),
                            last_digest(self.out / "boxes-paper-default-off-seed1"))

    def test_a_planner_that_cannot_be_started_is_named(self):
        said = started("runner/experiment.py", "--scenes", "boxes", "--strategies",
                       f"none=--planner {self.path}/out/table.csv", "--quality", "off", "--seeds", "1",
                       "--views", "2", "2", "--out", self.path / "none")
        self.assertEqual(said.returncode, 1, said.stdout + said.stderr)
        self.assertIn("--planner: cannot start", said.stdout)
        self.assertIn("1 of 1 runs failed", said.stderr)

    def test_its_figures_are_drawn(self):
        figures = self.path / "figures"
        said = self.figures(self.out, "--out", figures)
        self.assertEqual(said.returncode, 0, said.stderr)
        for strategy in ("paper", "surface", "own"):
            self.assert_drawn(figures, f"figure-6-boxes-{strategy}", ["positions tried", "best fitness"])
            self.assert_drawn(figures, f"figure-7-boxes-{strategy}",
                              ["quality off, 1 seed", "quality on, 1 seed", "mean quality"])
            self.assert_drawn(figures, f"figure-9-boxes-{strategy}", ["quality off, seed 1"])
        self.assertEqual(len(said.stdout.split()), 3 * 3 * 2, "it says what it has written")

    def test_so_are_those_of_one_run(self):
        run = self.out / "boxes-paper-default-on-seed1"
        figures = self.path / "of one"
        said = self.figures(run, "--view", "3", "--recovered-views", "2", "--out", figures)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assert_drawn(figures, "figure-6-boxes", ["the search for view 3"])
        self.assert_drawn(figures, "figure-7-boxes", ["quality on, 1 seed"])
        self.assert_drawn(figures, "figure-9-boxes", ["boxes after 2 views"])

    def test_figures_say_what_cannot_be_drawn(self):
        run = self.out / "boxes-paper-default-off-seed1"
        for arguments, status, words in (
                ([self.path / "nowhere"], 1, "neither the folder of a run"),
                ([run, "--view", "5"], 1, "the log has no committed range image of view 5"),
                ([run, "--view", "1"], 2, "view 1 is the scan at the start"),
                ([run, "--recovered-views", "0"], 2, "--recovered-views: at least 1"),
                ([], 2, "DIR")):
            said = self.figures(*arguments)
            self.assertEqual(said.returncode, status, arguments)
            self.assertIn(words, said.stderr)
            self.assertEqual(said.stdout, "")


if __name__ == "__main__":
    unittest.main()
