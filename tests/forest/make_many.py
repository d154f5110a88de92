"""Many small scans of grown trees, to measure what a forest costs: FOLDER PROGRAM COUNT [POINTS].

Each has a seed of its own: habits in turn, 2 to 9 m high, 4,000 points. The first hundred of a thousand are the hundred.
"""
import concurrent.futures
import os
import sys
from pathlib import Path

from grown import grow

HABITS = ("broadleaf", "birch", "conifer", "forked", "leaning")


def make(folder, program, number, points):
    path = folder / f"tree_{number:05d}.ply"
    if not path.exists():
        height = 2.0 + (number * 37 % 71) / 10.0
        path.write_bytes(grow(program, 1000 + number, HABITS[number % len(HABITS)], height, points)[1])


def main(folder, program, count, points="4000"):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for done in [pool.submit(make, folder, program, i, int(points)) for i in range(int(count))]:
            done.result()


main(*sys.argv[1:])
