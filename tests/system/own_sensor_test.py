"""Drivers from files, in C++ and in Python, in the place of the simulators, and a program that follows the map:
the examples as docs/own-sensor.md and docs/map-blocks.md have them, against a recorded run."""

import csv
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PROGRAMS = pathlib.Path(os.environ["NEXTVIEW_PROGRAMS_FOLDER"])
EXAMPLES = ROOT / "examples" / "python"
VIEWS = 8
# A run that a follower starts beside has to take longer than Python does to start.
SLOWLY = "--real-time=30"


def column(folder, heading):
    with open(folder / "views.csv", newline="", encoding="utf-8") as stream:
        return [line[heading] for line in csv.DictReader(stream)]


class Examples(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.kept = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.kept.name)
        subprocess.run(["lcm-gen", "-p", "--ppath", cls.folder / "types", *(ROOT / "lcmtypes").glob("*.lcm")],
                       check=True, stdout=subprocess.DEVNULL)
        cls.python = {**os.environ, "PYTHONPATH": str(cls.folder / "types"), "PYTHONDONTWRITEBYTECODE": "1"}
        cls.run_whole(cls, "recorded", ["boxes", "--views", str(VIEWS)])
        # Whose images travel in parts.
        cls.run_whole(cls, "panorama", ["boxes", "--sensor", "panorama", "--views", "2"])

    @classmethod
    def tearDownClass(cls):
        cls.kept.cleanup()

    def example(self, name):
        return [sys.executable, str(EXAMPLES / name)]

    def start(self, out, words):
        """A run, and what it says its bus is."""
        run = subprocess.Popen([PROGRAMS / "nextview_run", *words, "--out", self.folder / out],
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        lines = []
        for line in run.stdout:
            lines.append(line)
            bus = re.match(r"bus: (\S+), run (\d+)", line)
            if bus:
                return run, [bus[1], bus[2]]
        self.fail("".join(lines))

    @staticmethod
    def run_whole(cls, out, words):
        subprocess.run([PROGRAMS / "nextview_run", *words, "--no-coverage", "--out",
                        cls.folder / out], check=True, stdout=subprocess.DEVNULL)

    def end(self, run):
        said = run.stdout.read()
        run.stdout.close()
        self.assertEqual(run.wait(), 0, said)

    def test_drivers_from_files_give_the_recorded_run(self):
        self.drive_from_files_of("recorded", VIEWS)

    def test_images_in_parts_are_put_together_again(self):
        self.drive_from_files_of("panorama", 2)

    def drive_from_files_of(self, recorded, views):
        files = self.folder / (recorded + "-files")
        command = subprocess.run([*self.example("log_to_files.py"), self.folder / recorded / "run.lcmlog", files],
                                 env=self.python, check=True, capture_output=True, text=True).stdout
        self.assertTrue(command.startswith("./run --without sensor_sim,base_sim "), command)
        words = shlex.split(command)[1:]
        self.assertIn(f"--views {views}", command)
        digests = column(self.folder / recorded, "map_digest")
        self.assertEqual(len(digests), views)
        drivers = {"cpp": [PROGRAMS / "file_driver"], "python": self.example("file_driver.py")}
        for name, driver in drivers.items():
            with self.subTest(driver=name):
                run, bus = self.start(f"{recorded}-{name}", words)
                driven = subprocess.run([*driver, *bus, files], env=self.python, capture_output=True, text=True)
                self.end(run)
                self.assertEqual(driven.returncode, 0, driven.stderr)
                goals = re.findall(r"^goal of view (\d+): \(", driven.stdout, re.M)
                self.assertEqual(goals, [str(view) for view in range(1, views + 1)])
                self.assertIn("the run has ended: view_limit", driven.stdout)
                self.assertEqual(column(self.folder / f"{recorded}-{name}", "map_digest"), digests)
                subprocess.run([PROGRAMS / "nextview_replay", self.folder / f"{recorded}-{name}", "--planner"], check=True,
                               stdout=subprocess.DEVNULL)

    def test_a_driver_without_the_files_it_needs_says_so(self):
        files = self.folder / "nothing"
        for driver in ([PROGRAMS / "file_driver"], self.example("file_driver.py")):
            said = subprocess.run([*driver, "unused", "1", files], env=self.python,
                                  capture_output=True, text=True)
            self.assertEqual(said.returncode, 1, said)
            self.assertIn("arrivals.csv" if driver[0] == sys.executable else "sensor.csv", said.stderr)

    def test_a_follower_without_our_library_has_the_mappers_map(self):
        for name, more in (("steps", []), ("whole", ["--all"])):
            with self.subTest(asks=name):
                run, bus = self.start("followed-" + name, ["boxes", "--views", str(VIEWS), "--no-coverage", "--verbose",
                                                           "--no-private", SLOWLY])
                followed = subprocess.run([*self.example("follow_map.py"), *bus, *more], env=self.python,
                                          capture_output=True, text=True)
                self.end(run)
                self.assertEqual(followed.returncode, 0, followed.stdout + followed.stderr)
                views = re.findall(r"^view (\d+): .* as the mapper says$", followed.stdout, re.M)
                self.assertGreaterEqual(len(views), 3, followed.stdout)
                self.assertEqual(column(self.folder / ("followed-" + name), "map_digest"),
                                 column(self.folder / "recorded", "map_digest"))


if __name__ == "__main__":
    unittest.main()
