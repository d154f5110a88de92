"""A plot of as many points as wanted, to measure what splitting one takes: FILE.las PROGRAM MILLIONS [METRES].

A dozen grown trees stand, turned and shifted, about every 6 m on rolling ground, METRES wide (200) and as deep as the
points reach: some 500 of them on a square metre. It is written tree by tree, so that it needs little memory.
"""
import math
import sys

import laspy
import numpy
from grown import ORIGIN, append_las, grow, las_header

STEP = 6.0  # metres between trees
OF_TREE = 14_000  # points
OF_GROUND = 4_000  # points around each tree
HABITS = [("broadleaf", 9), ("birch", 11), ("conifer", 12), ("forked", 8)]


def ground(x, y):
    return 1.5 * numpy.sin(x / 31.0) + numpy.cos(y / 23.0)


def main(path, program, millions, width=200.0):
    trees = [
        grow(program, 20 + i, *HABITS[i % len(HABITS)], OF_TREE)[0]["place"] for i in range(3 * len(HABITS))
    ]
    trees = [places[places[:, 2] > -0.2] for places in trees]
    chance = numpy.random.Generator(numpy.random.PCG64(5))
    across = max(1, round(float(width) / STEP))
    count = math.ceil(float(millions) * 1e6 / (OF_TREE + OF_GROUND))
    written = 0
    with laspy.open(path, mode="w", header=las_header()) as file:
        for i in range(count):
            corner = STEP * numpy.array([i % across, i // across])
            x, y = corner + STEP / 2 + chance.uniform(-1.0, 1.0, 2)
            turn = chance.uniform(0.0, 2.0 * math.pi)
            places = trees[int(chance.integers(len(trees)))].copy()
            rotation = numpy.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
            places[:, :2] = places[:, :2] @ rotation.T + (x, y)
            places[:, 2] += ground(x, y)
            soil = numpy.empty((OF_GROUND, 3))
            soil[:, :2] = corner + chance.uniform(0.0, STEP, (OF_GROUND, 2))
            soil[:, 2] = ground(soil[:, 0], soil[:, 1]) + chance.normal(0.0, 0.01, OF_GROUND)
            append_las(file, numpy.concatenate([places, soil]) + ORIGIN)
            written += len(places) + len(soil)
    print(f"{count} trees, {written} points, {across * STEP:.0f} x {math.ceil(count / across) * STEP:.0f} m")


main(*sys.argv[1:])
