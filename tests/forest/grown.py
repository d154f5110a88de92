"""Grown trees as scans, and LAS files of them, for tests and measurements of the forest's workflow."""
import subprocess
import tempfile
from pathlib import Path

import laspy
import numpy

ORIGIN = numpy.array([470600.0, 3810200.0, 2280.0])


def grow(program, seed, habit, height, points):
    """A scan's points, and its file."""
    with tempfile.TemporaryDirectory() as folder:
        words = ["--seed", seed, "--habit", habit, "--height", height, "--points", points]
        subprocess.run([program, "synth", "-o", folder, "--quiet", *map(str, words)], check=True)
        data = (Path(folder) / "scan.ply").read_bytes()
    body = data[data.index(b"end_header\n") + 11 :]
    record = numpy.dtype([("place", "<f8", 3), ("color", "u1", 3)])
    return numpy.frombuffer(body, dtype=record), data


def las_header():
    header = laspy.LasHeader(version="1.2", point_format=0)
    header.offsets, header.scales = ORIGIN, numpy.full(3, 1e-3)
    return header


def append_las(file, places):
    points = laspy.ScaleAwarePointRecord.zeros(len(places), header=file.header)
    points.x, points.y, points.z = places.T
    file.write_points(points)


def write_las(path, places, compress=False):
    with laspy.open(path, mode="w", header=las_header(), do_compress=compress) as file:
        append_las(file, places)
