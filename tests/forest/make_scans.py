"""A folder of scans for tests/forest/run.sh: FOLDER PROGRAM.

Grown trees, one of them as LAZ and one as E57, a broken scan, and a plot of trees on a slope.
"""
import sys
from pathlib import Path

import numpy
import pye57
from grown import ORIGIN, grow, write_las

PLACES = [(0.0, 0.0), (7.0, 2.0), (2.0, 8.0)]


def slope(x, y):
    return 0.1 * x - 0.05 * y


def write_e57(path, points):
    """From two stations, each with a place of its own."""
    file = pye57.E57(str(path), mode="w")
    for half, station in ((points[::2], numpy.zeros(3)), (points[1::2], numpy.array([4.0, -2.0, 1.0]))):
        data = {f"cartesian{name}": half["place"][:, axis] - station[axis] for axis, name in enumerate("XYZ")}
        data |= {f"color{name}": half["color"][:, axis] for axis, name in enumerate(("Red", "Green", "Blue"))}
        file.write_scan_raw(data, translation=station)
    file.close()


def main(folder, program):
    folder = Path(folder)
    (folder / "plots").mkdir(parents=True, exist_ok=True)
    for seed, (habit, height) in enumerate([("broadleaf", 5), ("birch", 6), ("conifer", 5)], start=1):
        (folder / f"{habit}.ply").write_bytes(grow(program, seed, habit, height, 5000)[1])
    whole = (folder / "broadleaf.ply").read_bytes()
    (folder / "broken.ply").write_bytes(whole[: len(whole) // 2])
    points, _ = grow(program, 7, "forked", 5, 5000)
    write_las(folder / "forked.laz", points["place"] + ORIGIN, compress=True)
    write_e57(folder / "leaning.e57", grow(program, 8, "leaning", 5, 5000)[0])
    trees = []
    for seed, (x, y) in enumerate(PLACES, start=11):
        places = grow(program, seed, "broadleaf", 6, 6000)[0]["place"]
        places = places[places[:, 2] > -0.2]
        trees.append(places + (x, y, slope(x, y)))
    chance = numpy.random.Generator(numpy.random.PCG64(1))
    ground = chance.uniform(-5.0, 14.0, (15000, 3))
    ground[:, 2] = slope(ground[:, 0], ground[:, 1]) + chance.normal(0.0, 0.01, len(ground))
    write_las(folder / "plots" / "slope.las", numpy.concatenate([*trees, ground]) + ORIGIN)


main(*sys.argv[1:])
