#!/usr/bin/env python3
"""Compares a tree that was made of photos with the tree that was photographed.

    score.py TRUTH.txt GARDEN OUT     TRUTH.txt: the tree file; GARDEN: what garden.gd made; OUT: of 'treerec photos'

Photos are known by their names, frames of a film by the time that their names tell.
The cameras' true places lay the two over each other (Horn 1987: the similarity of least squares), so that scale, place and
direction are the chain's own, and errors are told in metres. Prints a line per figure, and is 0 whatever they are: what
they should be is another's business.
"""
import json
import math
import pathlib
import re
import struct
import sys

STEP = 0.02  # metres along the wood
OFF = 0.02  # metres from its surface: what is as near as that is found, and right


def read_tree(path):
    """[(parent's index or -1, (x, y, z), radius)] of the first tree in a tree file."""
    lines = pathlib.Path(path).read_text().splitlines()
    columns = [name.strip() for name in lines[1].split(",")]
    if columns[:5] != ["x", "y", "z", "radius", "parent_id"]:
        sys.exit("%s has other columns: %s" % (path, lines[1]))
    words = [word for word in lines[2].split(",") if word.strip()]
    rows = [[float(word) for word in words[i : i + len(columns)]] for i in range(0, len(words), len(columns))]
    return [(int(row[4]), tuple(row[:3]), row[3]) for row in rows]


def read_centres(path):
    """{photo's name: camera's place} of COLMAP's images.bin."""
    data, at, centres = pathlib.Path(path).read_bytes(), 8, {}
    for _ in range(struct.unpack_from("<Q", data)[0]):
        w, x, y, z, *t = struct.unpack_from("<7d", data, at + 4)
        at += 64
        end = data.index(b"\0", at)
        name = data[at:end].decode()
        at = end + 1
        at += 8 + 24 * struct.unpack_from("<Q", data, at)[0]
        turn = ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
                (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
                (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))
        centres[name] = tuple(-sum(turn[k][i] * t[k] for k in range(3)) for i in range(3))
    return centres


def true_places(scene, names):
    """{photo's name: the true place of its camera}"""
    if "frames_per_second" not in scene:
        return {c["name"]: tuple(c["centre"]) for c in scene["cameras"]}
    places = {}
    for name in names:
        told = re.search(r"(\d+\.\d+)s\.jpg$", name)
        if not told:
            sys.exit("%s tells no time" % name)
        # What was shown then began at that time or before.
        at = math.floor(float(told.group(1)) * scene["frames_per_second"] + 0.05)
        places[name] = tuple(scene["cameras"][min(at, len(scene["cameras"]) - 1)]["centre"])
    return places


def similarity(given, wanted):
    """The function that takes the places `given` nearest to `wanted`, and its scale."""
    count = len(given)
    a = [sum(p[i] for p in given) / count for i in range(3)]
    b = [sum(p[i] for p in wanted) / count for i in range(3)]
    s = [[sum((p[i] - a[i]) * (q[j] - b[j]) for p, q in zip(given, wanted)) for j in range(3)] for i in range(3)]
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = s
    n = [[xx + yy + zz, yz - zy, zx - xz, xy - yx],
         [yz - zy, xx - yy - zz, xy + yx, zx + xz],
         [zx - xz, xy + yx, yy - xx - zz, yz + zy],
         [xy - yx, zx + xz, yz + zy, zz - xx - yy]]
    shift = max(sum(abs(v) for v in row) for row in n)
    q = [1.0, 0.1, 0.2, 0.3]
    for _ in range(3000):
        q = [sum(n[i][j] * q[j] for j in range(4)) + shift * q[i] for i in range(4)]
        length = math.sqrt(sum(v * v for v in q))
        q = [v / length for v in q]
    w, x, y, z = q
    turn = ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))
    spread = [math.sqrt(sum(sum((p[i] - m[i]) ** 2 for i in range(3)) for p in places))
              for places, m in ((given, a), (wanted, b))]
    scale = spread[1] / spread[0]

    def move(p):
        return tuple(b[i] + scale * sum(turn[i][j] * (p[j] - a[j]) for j in range(3)) for i in range(3))

    return move, scale


def samples(nodes, least_radius=0.0):
    """[(place, radius)] every STEP along the wood."""
    found = []
    for parent, place, radius in nodes:
        if parent < 0 or radius < least_radius:
            continue
        start, first = nodes[parent][1], nodes[parent][2]
        pieces = max(1, round(math.dist(start, place) / STEP))
        for k in range(pieces):
            t = (k + 0.5) / pieces
            found.append((tuple(start[i] + t * (place[i] - start[i]) for i in range(3)), first + t * (radius - first)))
    return found


def share_near(points, others, extra):
    """The share of `points` that have one of `others` within its radius and `extra` metres."""
    edge = 0.3
    grid = {}
    for place, radius in others:
        grid.setdefault(tuple(math.floor(v / edge) for v in place), []).append((place, radius))
    near = 0
    for place, radius in points:
        cell = [math.floor(v / edge) for v in place]
        around = (grid.get((cell[0] + i, cell[1] + j, cell[2] + k), ()) for i in (-1, 0, 1) for j in (-1, 0, 1)
                  for k in (-1, 0, 1))
        near += any(math.dist(place, other) <= extra + max(radius, r) for group in around for other, r in group)
    return near / max(len(points), 1)


def diameter_at(nodes, height):
    """Of the thickest wood that crosses this height above the base."""
    base = min(place[2] for _, place, _ in nodes)
    best = 0.0
    for parent, place, radius in nodes:
        if parent < 0:
            continue
        low, high = nodes[parent][1][2] - base, place[2] - base
        if min(low, high) <= height <= max(low, high):
            t = 0.5 if high == low else (height - low) / (high - low)
            best = max(best, 2 * (nodes[parent][2] + t * (radius - nodes[parent][2])))
    return best


def main(truth_path, garden, out):
    truth = read_tree(truth_path)
    scene = json.loads((pathlib.Path(garden) / "cameras.json").read_text())
    centres = read_centres(pathlib.Path(out) / "sparse/0/images.bin")
    filmed = sorted(path.name for path in (pathlib.Path(out) / "frames").glob("*.jpg"))
    places = true_places(scene, filmed)
    pairs = [(centres[name], place) for name, place in places.items() if name in centres]
    print("photos placed: %d of %d" % (len(pairs), len(places)))
    move, scale = similarity([p for p, _ in pairs], [q for _, q in pairs])
    orbit = sum(math.hypot(q[0], q[1]) for _, q in pairs) / len(pairs)
    errors = sorted(math.dist(move(p), q) for p, q in pairs)
    print("camera centres: median %.2f %%, worst %.2f %% of the orbit of %.1f m" %
          (100 * errors[len(errors) // 2] / orbit, 100 * errors[-1] / orbit, orbit))
    made = [(parent, move(place), radius * scale) for parent, place, radius in read_tree(pathlib.Path(out) / "tree.txt")]
    pixel = orbit / scene["focal_pixels"]
    for name, value in (("height", lambda t: max(p[2] for _, p, _ in t) - min(p[2] for _, p, _ in t)),
                        ("DBH", lambda t: diameter_at(t, 1.3))):
        is_, should = value(made), value(truth)
        print("%s: %.3f m, true %.3f (%+.1f %%, %.2f px)" %
              (name, is_, should, 100 * (is_ / should - 1), abs(is_ - should) / pixel))
    for pixels in (2, 4, 8):
        thick = samples(truth, pixels * pixel / 2)
        recall = share_near(thick, samples(made), OFF)
        precision = share_near(samples(made), samples(truth), OFF)
        print("wood of %d px and more (%.0f mm): recall %.3f, precision %.3f, F %.3f" %
              (pixels, 1000 * pixels * pixel, recall, precision, 2 * recall * precision / max(recall + precision, 1e-9)))


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
