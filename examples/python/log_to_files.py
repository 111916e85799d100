#!/usr/bin/env python3
"""Writes what robot and sensor have said in a run's log as plain files, for file_driver and for whoever wants to
see what such files hold (docs/own-sensor.md).

    log_to_files.py RUN/run.lcmlog FOLDER
"""

import argparse
import json
import math
import pathlib
import shlex
import struct
import sys

from nextview_bus import channel_of, key_of, nextview, program_version

EVENT = struct.Struct(">IqqII")  # of LCM's logs: a mark, number, time, lengths of channel and message
MARK = 0xEDA1DA01


def events(log):
    """(channel, bytes) of every message of an LCM log."""
    data = pathlib.Path(log).read_bytes()
    at = 0
    while at + EVENT.size <= len(data):
        mark, _, _, channel_bytes, message_bytes = EVENT.unpack_from(data, at)
        if mark != MARK:
            raise ValueError(f"{log}: is no LCM log, or broken at byte {at}")
        at += EVENT.size
        yield data[at:at + channel_bytes].decode(), data[at + channel_bytes:at + channel_bytes + message_bytes]
        at += channel_bytes + message_bytes


def messages(log, message_type):
    """By key, as a message may be there twice."""
    found = {}
    for channel, data in events(log):
        if channel == channel_of(message_type):
            message = message_type.decode(data)
            found[key_of(message)] = message
    return [found[key] for key in sorted(found)]


def write_lines(file, headings, lines):
    with open(file, "w", encoding="utf-8") as stream:
        for line in [headings, *lines]:
            # repr is the shortest text that gives the same number when it is read.
            print(*(each if isinstance(each, str) else repr(each) for each in line), sep=",", file=stream)


def write_arrivals(folder, arrivals):
    write_lines(folder / "arrivals.csv",
                ["view", "attempt", "utime", "arrived", "x_m", "y_m", "z_m", "pan_rad", "tilt_rad", "path_length_m",
                 "refusal"],
                ([each.view, each.attempt, each.utime, int(each.arrived), *each.believed_position_m,
                  each.believed_pan_rad, each.believed_tilt_rad, each.path_length_m, each.refusal.replace("\n", " ")]
                 for each in arrivals))


def write_scans(folder, parts):
    lines, ranges, rays = [], {}, {}
    for part in parts:
        file = f"range-{part.view}-{part.attempt}.f32"
        if part.part == 0:
            rotation = [number for row in part.world_from_sensor for number in row]
            lines.append([part.view, part.attempt, part.utime, *part.position_m, part.pan_rad, part.tilt_rad,
                          *rotation, file])
        ranges.setdefault(file, []).extend(part.range_m)
        rays.setdefault(file, []).extend(zip(part.entry_sin, part.entry_cos))
    for file, values in ranges.items():
        (folder / file).write_bytes(struct.pack(f"<{len(values)}f", *values))
    write_lines(folder / "scans.csv",
                ["view", "attempt", "utime", "x_m", "y_m", "z_m", "pan_rad", "tilt_rad",
                 *(f"r{i}{j}" for i in range(3) for j in range(3)), "file"], lines)
    first = parts[0]
    write_lines(folder / "sensor.csv", ["geometry", "columns", "rows", "range_min_m", "range_max_m"],
                [[first.geometry, first.columns, first.rows, first.range_min_m, first.range_max_m]])
    write_lines(folder / "rays.csv", ["sin", "cos"], next(iter(rays.values())))


def write_sensor(file, sensor):
    """As `./run --sensor` reads it."""
    name, angles = (("tilted_line_scan", ["horizontal_aperture_deg", "vertical_aperture_deg"]),
                    ("spherical", ["horizontal_aperture_deg", "vertical_aperture_deg"]),
                    ("line_striper", ["sweep_deg", "vertical_aperture_deg"]))[sensor.geometry]
    values = {"geometry": name, "columns": sensor.columns, "rows": sensor.rows,
              **{key: math.degrees(angle) for key, angle in zip(angles, sensor.geometry_parameter)}}
    if name == "line_striper":
        values["baseline_m"] = sensor.geometry_parameter[2]
    values.update((key, getattr(sensor, key))
                  for key in ("range_min_m", "range_max_m", "range_noise_m", "scan_duration_s"))
    file.write_text(json.dumps(values, indent=2) + "\n", encoding="utf-8")


def command(config, views, sensor_file):
    """What starts such a run without simulators; angles in degrees, as typed."""
    base = config.base
    words = ["./run", "--without", "sensor_sim,base_sim", "--sensor", sensor_file, "--start", *base.start_m,
             "--workspace", *base.workspace_min_m, *base.workspace_max_m,
             "--start-pan", math.degrees(base.start_pan_rad), "--start-tilt", math.degrees(base.start_tilt_rad),
             "--voxel-size", config.map.voxel_size_m, "--strategy", config.strategy, "--seed", config.seed,
             "--views", views]
    return shlex.join(map(str, words))


def main():
    parser = argparse.ArgumentParser(prog="log_to_files.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log", metavar="LOG", type=pathlib.Path)
    parser.add_argument("folder", metavar="FOLDER", type=pathlib.Path)
    parser.add_argument("--version", action="version", version="%(prog)s " + program_version())
    options = parser.parse_args()
    parts = messages(options.log, nextview.range_image_t)
    if not parts:
        sys.exit(f"{options.log}: holds no range image")
    options.folder.mkdir(parents=True, exist_ok=True)
    write_arrivals(options.folder, messages(options.log, nextview.arrival_t))
    write_scans(options.folder, parts)
    config = messages(options.log, nextview.run_config_t)[0]
    sensor_file = options.folder / "sensor.json"
    write_sensor(sensor_file, config.sensor)
    print(command(config, parts[-1].view, sensor_file))


if __name__ == "__main__":
    main()
