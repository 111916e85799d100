#!/usr/bin/env python3
"""A driver of one's own in the place of nextview's simulators: it answers every goal by the arrival and the range
image that a robot has left in files. docs/own-sensor.md is about it.

    file_driver.py LCM_URL RUN FOLDER
"""

import argparse
import csv
import pathlib
import struct
import sys

from nextview_bus import Bus, nextview, program_version

PART_BYTES = 48 * 1024  # of rays and ranges in a message
ENTRY_BYTES, PIXEL_BYTES = 16, 4
QUIET_S = 2.0


def lines_of(file):
    with open(file, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def key_of(line):
    return int(line["view"]), int(line["attempt"])


def arrival_message(view, attempt, line):
    arrival = nextview.arrival_t()
    arrival.utime = int(line["utime"])
    arrival.view, arrival.attempt = view, attempt
    arrival.arrived = line["arrived"] == "1"
    arrival.true_position_m = arrival.believed_position_m = [float(line[axis]) for axis in ("x_m", "y_m", "z_m")]
    arrival.true_pan_rad = arrival.believed_pan_rad = float(line["pan_rad"])
    arrival.true_tilt_rad = arrival.believed_tilt_rad = float(line["tilt_rad"])
    arrival.path_length_m = float(line["path_length_m"])
    # A sentence may have commas.
    arrival.refusal = ",".join([line["refusal"] or "", *line.get(None, [])])
    return arrival


class RecordedFiles:
    def __init__(self, folder):
        self.arrivals = {key_of(line): line for line in lines_of(folder / "arrivals.csv")}
        self.folder = folder
        self.sensor = lines_of(folder / "sensor.csv")[0]
        self.rays = [(float(line["sin"]), float(line["cos"])) for line in lines_of(folder / "rays.csv")]
        self.scans = {key_of(line): line for line in lines_of(folder / "scans.csv")}

    def messages(self, view, attempt):
        """The parts of a range image: a sequence of rays and then ranges, cut where a message is full."""
        line = self.scans[view, attempt]
        data = (self.folder / line["file"]).read_bytes()
        ranges = struct.unpack(f"<{len(data) // PIXEL_BYTES}f", data)
        slices, ray, pixel = [], 0, 0
        while ray < len(self.rays) or pixel < len(ranges):
            entries = min(len(self.rays) - ray, PART_BYTES // ENTRY_BYTES)
            pixels = min(len(ranges) - pixel, (PART_BYTES - entries * ENTRY_BYTES) // PIXEL_BYTES)
            if ray + entries < len(self.rays):
                pixels = 0
            slices.append((ray, entries, pixel, pixels))
            ray += entries
            pixel += pixels
        return [self.part(line, ranges, number, len(slices), *each) for number, each in enumerate(slices)]

    def part(self, line, ranges, number, parts, ray, entries, pixel, pixels):
        image = nextview.range_image_t()
        image.utime = int(line["utime"])
        image.view, image.attempt = key_of(line)
        image.part, image.parts = number, parts
        image.geometry = int(self.sensor["geometry"])
        image.columns, image.rows = int(self.sensor["columns"]), int(self.sensor["rows"])
        image.range_min_m, image.range_max_m = float(self.sensor["range_min_m"]), float(self.sensor["range_max_m"])
        image.position_m = [float(line[axis]) for axis in ("x_m", "y_m", "z_m")]
        image.pan_rad, image.tilt_rad = float(line["pan_rad"]), float(line["tilt_rad"])
        image.world_from_sensor = [[float(line[f"r{i}{j}"]) for j in range(3)] for i in range(3)]
        image.first_entry, image.entries = ray, entries
        image.entry_sin = [ray[0] for ray in self.rays[ray:ray + entries]]
        image.entry_cos = [ray[1] for ray in self.rays[ray:ray + entries]]
        image.first_pixel, image.pixels = (pixel if pixels else 0), pixels
        image.range_m = ranges[pixel:pixel + pixels]
        return image


class FileDriver:
    def __init__(self, bus, files):
        self.bus = bus
        self.files = files
        self.stop_reason = ""
        bus.on(nextview.goal_t, self.answer)
        bus.on(nextview.stop_t, lambda stop: setattr(self, "stop_reason", stop.stop_reason))
        bus.on_missing(self.find_goal)
        bus.request(nextview.goal_t, 1)  # it may have been published before this program started

    def find_goal(self, request):
        """Whoever asks for what has not been published yet knows of a goal that was lost on its way here."""
        if request.wanted_channel in ("NEXTVIEW_ARRIVAL", "NEXTVIEW_RANGE_IMAGE"):
            self.bus.request(nextview.goal_t, request.view, request.attempt)

    def answer(self, goal):
        """A robot would drive along goal.waypoint_m, and scan."""
        x, y, z = goal.position_m
        print(f"goal of view {goal.view}: ({x:.2f}, {y:.2f}, {z:.2f}) m, pan {goal.pan_rad:.2f}, "
              f"tilt {goal.tilt_rad:.2f} rad: {goal.reason}", flush=True)
        key = goal.view, goal.attempt
        if key not in self.files.arrivals:
            sys.exit(f"the files hold no arrival for view {goal.view}, attempt {goal.attempt}: end the run before, "
                     f"by ./run --views N")
        arrival = arrival_message(*key, self.files.arrivals[key])
        self.bus.publish(arrival)
        if arrival.arrived:
            for part in self.files.messages(*key):
                self.bus.publish(part)

    def run(self):
        """Until the run has ended and nobody asks for anything any more: the recorder may have missed some."""
        while self.bus.handle(QUIET_S) or not self.stop_reason:
            pass
        print("the run has ended:", self.stop_reason)


def main():
    parser = argparse.ArgumentParser(prog="file_driver.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lcm_url", metavar="LCM_URL")
    parser.add_argument("run", metavar="RUN", type=int)
    parser.add_argument("folder", metavar="FOLDER", type=pathlib.Path)
    parser.add_argument("--version", action="version", version="%(prog)s " + program_version())
    options = parser.parse_args()
    try:
        files = RecordedFiles(options.folder)
    except OSError as error:
        sys.exit(f"file_driver.py: {error}")
    FileDriver(Bus(options.lcm_url, options.run, "file_driver"), files).run()


if __name__ == "__main__":
    main()
