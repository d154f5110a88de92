"""Where trees stand in the scene."""
import math
from itertools import pairwise

# By the scan's axis to the sky, which of its axes are the scene's x, y and z: as src/geometry/scan_frame.cpp.
TURNS = {
    "x": ((2, 1), (0, 1), (1, 1)),
    "y": ((0, 1), (1, 1), (2, 1)),
    "z": ((0, 1), (2, 1), (1, -1)),
    "-x": ((2, -1), (0, -1), (1, 1)),
    "-y": ((0, 1), (1, -1), (2, -1)),
    "-z": ((0, 1), (2, -1), (1, 1)),
}
SAME_PLACE = 0.6  # metres: two trees do not stand closer
SAME_SITE = 5000.0  # metres


def to_scene(frame, origin):
    """The frame's origin in the scene's axes, in metres from another origin in the scan's coordinates."""
    away = [(a - b) * frame["metres_per_unit"] for a, b in zip(frame["origin"], origin)]
    return tuple(sign * away[axis] for axis, sign in TURNS[frame["up"]])


def have_places(frames):
    """Whether the scans were cut out of one survey: all of one kind, apart from each other, and within one site."""
    if len(frames) < 2 or len({(frame["up"], frame["metres_per_unit"]) for frame in frames}) > 1:
        return False
    places = sorted(to_scene(frame, frames[0]["origin"]) for frame in frames)
    if places[-1][0] - places[0][0] > SAME_SITE or max(abs(p[2]) for p in places) > SAME_SITE:
        return False
    cells = {}
    for x, _, z in places:
        cell = (math.floor(x / SAME_PLACE), math.floor(z / SAME_PLACE))
        for i in (-1, 0, 1):
            for k in (-1, 0, 1):
                for other in cells.get((cell[0] + i, cell[1] + k), ()):
                    if math.dist((x, z), other) < SAME_PLACE:
                        return False
        cells.setdefault(cell, []).append((x, z))
    return True


def in_rows(rows):
    """Places of trees that have none: rows of as many as there are rows, as far apart as the widest crown."""
    step = max([3.0] + [2.2 * row["crown_radius_m"] for row in rows])
    across = math.ceil(math.sqrt(len(rows)))
    return [(i % across * step, 0.0, i // across * step) for i in range(len(rows))]


def place_trees(rows):
    """Of one group that has no ground of its own, and whether they stand in rows, on level ground."""
    frames = [row["frame"] for row in rows]
    if not have_places(frames):
        return in_rows(rows), True
    lowest = min(frame["origin"][2] for frame in frames) if frames[0]["up"] == "z" else frames[0]["origin"][2]
    origin = [frames[0]["origin"][0], frames[0]["origin"][1], lowest]
    return [to_scene(frame, origin) for frame in frames], False


def beside(extents, gap=20.0):
    """How far along x each group goes, so that they stand side by side. extents: (lowest, highest) x of each."""
    shifts = [0.0]
    for before, after in pairwise(extents):
        shifts.append(shifts[-1] + before[1] + gap - after[0])
    return shifts[: len(extents)]
