"""Scans that treerec does not read everywhere, into LAS, piece by piece."""
from pathlib import Path

import laspy
import numpy

PIECE = 1_000_000  # points
STEP = 1e-4  # of coordinates, in the scan's unit


def needs(path):
    return Path(path).suffix.lower() in (".laz", ".e57")


def to_las(path, target):
    """Raises ValueError, a sentence."""
    try:
        if Path(path).suffix.lower() == ".e57":
            e57_to_las(path, target)
        else:
            laz_to_las(path, target)
    except ValueError:
        raise
    # Both libraries have exceptions of many kinds for damaged files.
    except Exception as error:
        why = (str(error).splitlines() or [type(error).__name__])[0]
        raise ValueError(f"'{path}' could not be unpacked; copy it again. It says: {why}") from error


def laz_to_las(path, target):
    with laspy.open(path) as source:
        with laspy.open(target, mode="w", header=source.header, do_compress=False) as sink:
            for points in source.chunk_iterator(PIECE):
                sink.write_points(points)


def e57_to_las(path, target):
    # It brings a library of its own, which only E57 files need.
    import pye57

    scans = pye57.E57(str(path))
    if scans.scan_count == 0:
        raise ValueError(f"'{path}' holds no scan with points.")
    colored = all("colorRed" in scans.get_header(i).point_fields for i in range(scans.scan_count))
    header = laspy.LasHeader(version="1.2", point_format=2 if colored else 0)
    header.scales = numpy.full(3, STEP)
    sink = None
    for i in range(scans.scan_count):
        data = scans.read_scan(i, colors=colored, ignore_missing_fields=True)
        places = numpy.stack([data[f"cartesian{axis}"] for axis in "XYZ"], axis=1)
        sound = numpy.isfinite(places).all(axis=1)
        if not sound.any():
            continue
        if sink is None:
            header.offsets = numpy.round(numpy.median(places[sound], axis=0))
            sink = laspy.open(target, mode="w", header=header)
        points = laspy.ScaleAwarePointRecord.zeros(int(sound.sum()), header=header)
        points.x, points.y, points.z = places[sound].T
        if colored:
            for channel in ("red", "green", "blue"):
                points[channel] = data[f"color{channel.capitalize()}"][sound].astype(numpy.uint16) * 257
        sink.write_points(points)
    if sink is None:
        raise ValueError(f"'{path}' holds no point with a place.")
    sink.close()
