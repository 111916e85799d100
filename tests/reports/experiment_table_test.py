"""The table's figures from a views.csv made by hand."""

import io
import json
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "reports"))
import experiment_table as et  # noqa: E402

# Five views. The area reaches 95 of its last 100 at view 3; the quality 0.9 at view 5, and falls by
# 0.02 from view 3 to 4, and by 0.1 before the area has levelled off, which does not count.
VIEWS = """\
view,fitness,evaluations,plan_s,mean_quality,occupied_area_m2,surface_coverage,path_length_m,extra
1,,,,0.9,10,0.1,0,
2,1.0,10,0.5,0.8,50,0.5,1.5,x
3,0.8,20,0.5,0.82,95,0.92,1.0,
4,0.6,30,0.5,0.80,99,0.95,0.25,
5,0.6,60,0.5,0.95,100,0.96,2,
"""
SUMMARY = {"first_goal_to_last_commit_s": 0.5, "plan_s_median": 0.003, "map_memory_bytes": 750000,
           "peak_memory_bytes": {"planner": 9000000}}


def labels(quality="off", seed=1, strategy="paper", scene="boxes"):
    return {"scene": scene, "strategy": strategy, "sensor": "default", "quality": quality,
            "seed": seed, "views": 10, "options": []}


class WithViews(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def rows(self, text=VIEWS):
        file = self.path / "views.csv"
        file.write_text(text, encoding="utf-8")
        return et.read_views(file)

    def metrics(self, text=VIEWS, budget=10):
        return et.metrics_of(self.rows(text), SUMMARY, budget)


class OfOneRun(WithViews):
    def test_figures_worked_out_by_hand(self):
        found = self.metrics()
        expected = {
            "views": 5, "level_view": 3, "occupied_area": 100, "mean_quality": 0.95,
            "quality_90_view": 5,  # the 0.9 of view 1 is that of a corner of the room
            "largest_quality_fall": 0.02, "positions_tried": 30, "most_positions_tried": 60,
            "first_fitness": 0.75, "last_fitness": 0.75, "view_time": 0.1, "plan_time": 0.003,
            "map_memory": 0.75, "planner_memory": 9, "surface_coverage": 0.96, "path": 4.75,
            "coverage_90_view": 3, "coverage_90_path": 2.5, "coverage_95_view": 4,
            "coverage_95_path": 2.75, "coverage_99_view": None, "coverage_99_path": None,
            # (0.1 + 0.5 + 0.92 + 0.95 + 0.96 + 5 * 0.96) / 10
            "coverage_curve_area": 0.823,
        }
        self.assertEqual(found.keys(), expected.keys())
        for name, value in expected.items():
            if value is None:
                self.assertIsNone(found[name], name)
            else:
                self.assertAlmostEqual(found[name], value, 9, name)

    def test_every_metric_is_in_the_table_and_explained(self):
        names = {name for name, _, _ in et.METRICS}
        self.assertEqual(names, self.metrics().keys() | {"quality_90_ratio"})
        self.assertEqual(names, et.MEANINGS.keys())
        for facts in et.PAPER.values():
            self.assertLessEqual(facts.keys(), names)

    def test_the_budget_cuts_the_curve(self):
        # (0.1 + 0.5) / 2
        self.assertAlmostEqual(self.metrics(budget=2)["coverage_curve_area"], 0.3, 9)

    def test_the_edges_of_the_fitness_are_ten_views(self):
        lines = ["view,fitness,evaluations,plan_s,mean_quality,occupied_area_m2,surface_coverage,path_length_m",
                 "1,,,,0.5,1,0.1,0"]
        lines += [f"{view},{2 if view <= 11 else 1},4,0,0.5,1,0.1,0" for view in range(2, 32)]
        found = self.metrics("\n".join(lines) + "\n")
        self.assertEqual((found["first_fitness"], found["last_fitness"]), (2.0, 1.0))

    def test_the_start_alone_is_a_run(self):
        found = self.metrics("\n".join(VIEWS.splitlines()[:2]) + "\n")
        self.assertEqual((found["views"], found["level_view"], found["largest_quality_fall"]), (1, 1, 0))
        self.assertIsNone(found["first_fitness"])
        self.assertIsNone(found["most_positions_tried"])

    def test_without_coverage_there_is_none(self):
        text = VIEWS.replace("0.96,2", ",2")
        found = self.metrics(text)
        self.assertIsNone(found["surface_coverage"])
        self.assertIsNone(found["coverage_curve_area"])

    def test_no_views_csv_is_named(self):
        for text in ("", "view,fitness\n1,2\n", VIEWS.splitlines()[0] + "\n"):
            with self.assertRaisesRegex(et.TableError, "views.csv: is no views.csv"):
                self.rows(text)


class OfManyRuns(WithViews):
    def run_of(self, **changes):
        what = {key: changes.pop(key) for key in ("quality", "seed", "strategy", "scene") if key in changes}
        return labels(**what), self.metrics() | changes

    def table(self, runs):
        et.add_ratios(runs)
        return et.table_of(runs)

    def entry(self, table, metric, **wanted):
        found = [entry for entry in table if entry["metric"] == metric
                 and all(entry[key] == value for key, value in wanted.items())]
        self.assertEqual(len(found), 1, (metric, wanted))
        return found[0]

    def test_mean_and_spread_over_seeds(self):
        table = self.table([self.run_of(seed=1, level_view=30), self.run_of(seed=2, level_view=36),
                             self.run_of(seed=3, level_view=42)])
        entry = self.entry(table, "level_view")
        self.assertEqual((entry["mean"], entry["deviation"], entry["least"], entry["most"]),
                         (36, 6, 30, 42))
        self.assertEqual((entry["known"], entry["runs"], entry["paper"]), (3, 3, "35"))

    def test_what_some_did_not_reach_says_how_many_did(self):
        table = self.table([self.run_of(seed=1), self.run_of(seed=2, coverage_99_view=50)])
        entry = self.entry(table, "coverage_99_view")
        self.assertEqual((entry["mean"], entry["known"], entry["runs"]), (50, 1, 2))
        out = io.StringIO()
        et.write_readable(table, out)
        self.assertRegex(out.getvalue(), r"views to 99 % of surface coverage +\| +\| 50\.0 \(1 of 2\)")

    def test_the_ratio_takes_runs_of_one_seed_and_strategy(self):
        runs = [self.run_of(quality="off", seed=1, level_view=40),
                self.run_of(quality="off", seed=2, level_view=50),
                self.run_of(quality="off", seed=1, strategy="surface", level_view=10),
                self.run_of(quality="on", seed=1, quality_90_view=160),
                self.run_of(quality="on", seed=2, quality_90_view=100),
                self.run_of(quality="on", seed=3, quality_90_view=100),  # nothing to compare with
                self.run_of(quality="on", seed=1, strategy="surface", quality_90_view=None)]
        table = self.table(runs)
        entry = self.entry(table, "quality_90_ratio", quality="on", strategy="paper")
        self.assertEqual((entry["mean"], entry["known"], entry["runs"]), (3.0, 2, 3))  # 4 and 2
        self.assertEqual(entry["paper"], "4")
        self.assertIsNone(self.entry(table, "quality_90_ratio", strategy="surface", quality="on")["mean"])
        self.assertIsNone(self.entry(table, "quality_90_ratio", strategy="paper", quality="off")["mean"])

    def test_planners_stand_side_by_side(self):
        table = self.table([self.run_of(), self.run_of(strategy="surface", level_view=7)])
        out = io.StringIO()
        et.write_readable(table, out)
        self.assertRegex(out.getvalue(), r"\| the paper +\| strategy paper, 1 seed +\| strategy surface, 1 seed +\|")
        self.assertRegex(out.getvalue(), r"reaches 95% of its last value +\| 35 +\| 3\.0 +\| 7\.0 +\|")

    def test_csv_has_a_line_for_every_metric(self):
        table = self.table([self.run_of(), self.run_of(scene="hall")])
        out = io.StringIO()
        et.write_csv(table, out)
        lines = out.getvalue().splitlines()
        self.assertEqual(len(lines), 1 + 2 * len(et.METRICS))
        self.assertIn("boxes,default,off,paper,level_view,,35,3,,3,3,1,1", lines)
        self.assertIn("hall,default,off,paper,level_view,,,3,,3,3,1,1", lines, "of it the paper says nothing")

    def test_runs_are_read_from_their_folders(self):
        for name, seed in (("a", 1), ("b", 2)):
            folder = self.path / name
            folder.mkdir()
            (folder / "views.csv").write_text(VIEWS, encoding="utf-8")
            (folder / "summary.json").write_text(json.dumps(SUMMARY), encoding="utf-8")
            (folder / "experiment.json").write_text(json.dumps(labels(seed=seed)), encoding="utf-8")
        (self.path / "c.part").mkdir()
        runs = et.runs_of(self.path)
        self.assertEqual([of["seed"] for of, _ in runs], [1, 2])
        out = io.StringIO()
        et.write_runs(runs, out)
        self.assertEqual(len(out.getvalue().splitlines()), 3)
        (self.path / "b" / "summary.json").write_text("{", encoding="utf-8")
        with self.assertRaisesRegex(et.TableError, "b: not a complete run"):
            et.runs_of(self.path)


if __name__ == "__main__":
    unittest.main()
