"""What the figures are drawn from: curves over seeds, the edges of a room, which runs belong together."""

import json
import os
import pathlib
import shutil
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "reports"))
import figures  # noqa: E402


class Curves(unittest.TestCase):
    def test_mean_least_and_most_of_the_runs_that_got_so_far(self):
        def run(*values):
            return [{"view": view, "fitness": value} for view, value in enumerate(values, 1)]

        self.assertEqual(figures.curve([run(None, 2.0, 6.0), run(None, 4.0)], "fitness"),
                         [(2, 3.0, 2.0, 4.0), (3, 6.0, 6.0, 6.0)])
        self.assertEqual(figures.curve([], "fitness"), [])


class Edges(unittest.TestCase):
    def test_a_box_has_twelve(self):
        lines = [tuple(tuple(map(float, point.split())) for point in line.strip().split("\n"))
                 for line in figures.edges([0, 0, 0], [5, 3, 2]).split("\n\n")]
        self.assertEqual(len(set(lines)), 12)
        lengths = sorted(sum(abs(a - b) for a, b in zip(*line)) for line in lines)
        self.assertEqual(lengths, [2.0] * 4 + [3.0] * 4 + [5.0] * 4)


class Runs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)
        self.program = self.path / "nextview_search"
        self.said({"scene": "boxes", "strategy": "surface", "quality": True, "seed": 3})

    def said(self, search):
        self.program.write_text(f"#!/bin/sh\necho '{json.dumps(search)}'\n", encoding="utf-8")
        self.program.chmod(0o755)

    def run_folder(self, name, labels=None):
        folder = self.path / name
        folder.mkdir(parents=True)
        (folder / "run.lcmlog").touch()
        if labels:
            (folder / "experiment.json").write_text(json.dumps(labels), encoding="utf-8")
        return folder

    def test_are_found_in_an_experiment_and_by_themselves(self):
        a, b, c = (self.run_folder(name) for name in ("e/a", "e/b", "c"))
        self.run_folder("e/b.part")
        self.assertEqual(figures.run_folders([self.path / "e", c]), [a, b, c])
        with self.assertRaisesRegex(figures.FigureError, "empty: neither the folder of a run"):
            figures.run_folders([self.path / "empty"])

    def test_bear_the_names_of_the_log_or_of_the_experiment(self):
        of_log = figures.read_run(self.run_folder("a"), self.path, None)
        self.assertEqual((of_log.scene, of_log.strategy, of_log.quality, of_log.seed),
                         ("boxes", "surface", True, 3))
        named = self.run_folder("b", {"scene": "other", "strategy": "mine", "sensor": "default"})
        self.assertEqual(figures.read_run(named, self.path, None)[1:3], ("other", "mine"))
        wide = self.run_folder("c", {"scene": "other", "strategy": "mine", "sensor": "wide"})
        self.assertEqual(figures.read_run(wide, self.path, None)[1:3], ("other", "mine-wide"))

    @unittest.skipUnless(shutil.which("gnuplot"), "gnuplot is not installed")
    def test_may_lie_in_folders_whose_names_are_no_utf_8(self):
        folder = self.path / os.fsdecode(b"o\xff")
        folder.mkdir()
        script = self.path / "script.gp"
        script.write_text("eval(terminal_options)\nset output out\nplot x\n", encoding="utf-8")
        figures.gnuplot(script, {"size": (200, 100)}, folder / "figure")
        self.assertEqual(sorted(os.listdir(folder)), ["figure.png", "figure.svg"])

    def test_what_a_program_complains_of_is_passed_on(self):
        self.program.write_text("#!/bin/sh\necho 'x/run.lcmlog: no search' >&2\nexit 1\n", encoding="utf-8")
        with self.assertRaisesRegex(figures.FigureError, "x/run.lcmlog: no search"):
            figures.read_run(self.run_folder("a"), self.path, 4)
        with self.assertRaisesRegex(figures.FigureError, "build nextview again"):
            figures.program(self.path / "nowhere", "nextview_search")


if __name__ == "__main__":
    unittest.main()
