#!/usr/bin/env python3
"""Grows the twigs of the library anew: python3 src/edit/twigs/grow_twigs.py [NAME...] writes NAME.lstring here and
its thumbnail into the addon.

Each is a scion (edit/graft/scion.h) as the wood looks without leaves: how its buds are arranged, how its shoots bend,
which of them grow on. They are grown as if they rose from a branch at `rise` degrees; the strings are what ships, so
that a change here is a change to look at.
"""
import math
import os
import random
import struct
import sys
import zlib

import crown_twigs

SIDE = 128  # pixels of a thumbnail


def add(a, b, s=1.0):
    return (a[0] + b[0] * s, a[1] + b[1] * s, a[2] + b[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    n = math.sqrt(dot(a, a))
    return (a[0] / n, a[1] / n, a[2] / n)


def turn(v, axis, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return add(add(tuple(x * c for x in v), cross(axis, v), s), axis, dot(axis, v) * (1 - c))


class Twig:
    def __init__(self, seed, rise):
        self.random = random.Random(seed)
        self.nodes = [((0.0, 0.0, 0.0), -1, 0.0)]  # position, parent, least radius
        e = math.radians(rise)
        self.up = (0.0, math.sin(e), math.cos(e))

    def uniform(self, low, high):
        return low + (high - low) * self.random.random()

    def normal(self):
        return math.sqrt(-2 * math.log(1 - self.random.random())) * math.cos(2 * math.pi * self.random.random())

    def lean(self, direction, amount):
        """Bends a direction towards the sky (or, with a negative amount, the ground) by so many degrees at most."""
        axis = cross(direction, self.up)
        if dot(axis, axis) < 1e-9:
            return direction
        sine = math.sqrt(dot(axis, axis))
        return unit(turn(direction, unit(axis), amount * sine))

    def wander(self, direction, degrees):
        return unit(turn(direction, self.across(direction, self.uniform(0, 360)), degrees))

    def across(self, direction, azimuth):
        """Square to the direction: 0 at the side nearest to the sky, 90 level."""
        side = add(self.up, direction, -dot(self.up, direction))
        if dot(side, side) < 1e-4:
            side = cross(direction, (1.0, 0.0, 0.0))
        return unit(turn(unit(side), direction, azimuth))

    def grow(self, parent, direction, step):
        self.nodes.append((add(self.nodes[parent][0], direction, step), parent, 0.0))
        return len(self.nodes) - 1

    def thicken(self, node, radius):
        position, parent, least = self.nodes[node]
        self.nodes[node] = (position, parent, max(least, radius))

    def shoot(self, start, direction, length, order, rules):
        """One shoot and, by the rules, what grows from it."""
        rule = rules[min(order, len(rules) - 1)]
        count = max(1, round(length / rule["step"]))
        step = length / count
        at, azimuth = start, self.uniform(0, 360) if rule.get("any_start", True) else 0.0
        flip = 1 if self.random.random() < 0.5 else -1
        for i in range(count):
            s = (i + 0.5) / count
            lift = rule.get("lift", 0.0) * (1 - s) + rule.get("tip_lift", rule.get("lift", 0.0)) * s
            if i or not rule.get("straight"):
                direction = self.lean(direction, lift * step)
                direction = self.wander(direction, rule.get("wander", 3.0) * self.normal())
            if rule.get("zigzag"):
                flip = -flip
                direction = unit(turn(direction, self.across(direction, azimuth), flip * rule["zigzag"]))
            at = self.grow(at, direction, step * self.uniform(0.85, 1.15))
            s = (i + 1) / count
            last = i == count - 1
            if order + 1 >= len(rules) or (last and not rule.get("crown")):
                continue
            if s < rule.get("bare", 0.15):
                continue
            if i % rule.get("every", 1) != rule.get("every", 1) - 1 and not last:
                continue
            buds = rule.get("crown") if last else rule.get("buds", 1)
            azimuth += rule.get("divergence", 137.5)
            for b in range(buds):
                if self.random.random() > rule.get("grows", 1.0) and not last:
                    continue
                turned = azimuth + 360.0 * b / buds + self.uniform(-1, 1) * rule.get("spread", 10)
                if rule.get("flat") is not None:
                    turned = (90 if (b + i) % 2 else -90) + self.uniform(-1, 1) * rule["flat"]
                side = self.across(direction, turned)
                angle = rule["angle"] + (rule.get("tip_angle", rule["angle"]) - rule["angle"]) * s
                away = unit(turn(direction, unit(cross(direction, side)), angle + self.uniform(-6, 6)))
                reach = rule["reach"](s) * self.uniform(rule.get("least", 0.65), 1.1) * rule.get("ratio", 0.5)
                own = reach * rule.get("whole", length)
                if rule.get("spur") and self.random.random() < rule["spur"]:
                    own = self.uniform(0.015, 0.05)
                    tip = self.shoot(at, away, own, 9, rules)
                    self.thicken(tip, rule.get("spur_radius", 0.003))
                elif own > rule.get("shortest", 0.05):
                    self.shoot(at, away, own, order + 1, rules)
        return at

    def stretch(self, length):
        """Scales it so that the farthest tip is so far along the wood."""
        along = [0.0] * len(self.nodes)
        for i, (position, parent, _) in enumerate(self.nodes):
            if parent >= 0:
                along[i] = along[parent] + math.dist(position, self.nodes[parent][0])
        scale = length / max(along)
        self.nodes = [(tuple(scale * x for x in position), parent, least) for position, parent, least in self.nodes]

    def radii(self, tip, exponent, taper=0.0):
        """The pipe model, and a little thinner towards each tip."""
        area = [0.0] * len(self.nodes)
        radius = [0.0] * len(self.nodes)
        for i in range(len(self.nodes) - 1, -1, -1):
            position, parent, least = self.nodes[i]
            area[i] = max(area[i], tip**exponent, least**exponent)
            radius[i] = area[i] ** (1 / exponent)
            if parent >= 0:
                step = math.sqrt(sum((a - b) ** 2 for a, b in zip(position, self.nodes[parent][0])))
                area[parent] += (radius[i] + taper * step) ** exponent
        return radius

    def string(self, radius):
        """Of the turtle: F(length), +(left), ^(up), !(radius), metres and degrees."""
        children = [[] for _ in self.nodes]
        for i, (_, parent, _) in enumerate(self.nodes):
            if parent >= 0:
                children[parent].append(i)
        length = [0.0] * len(self.nodes)
        for i in range(len(self.nodes) - 1, 0, -1):
            length[self.nodes[i][1]] += length[i] + 1.0
        out = ["!(%s)" % number(radius[0], 5)]

        def move(node, place, frame, said):
            parts = []
            while True:
                heading, left, up = frame
                position = self.nodes[node][0]
                way = add(position, place, -1)
                size = math.sqrt(dot(way, way))
                way = unit(way)
                pitch = math.degrees(math.asin(max(-1.0, min(1.0, dot(way, up)))))
                yaw = math.degrees(math.atan2(dot(way, left), dot(way, heading)))
                yaw, pitch, size = round(yaw, 1), round(pitch, 1), round(size, 4)
                if yaw:
                    parts.append("%s(%s)" % ("+" if yaw > 0 else "-", number(abs(yaw), 1)))
                    heading, left = turn(heading, up, yaw), turn(left, up, yaw)
                if pitch:
                    parts.append("%s(%s)" % ("^" if pitch > 0 else "&", number(abs(pitch), 1)))
                    axis = cross(heading, up)
                    heading, up = turn(heading, axis, pitch), turn(up, axis, pitch)
                if abs(radius[node] - said) > 0.02 * said:
                    said = radius[node]
                    parts.append("!(%s)" % number(said, 5))
                parts.append("F(%s)" % number(size, 4))
                place = add(place, heading, size)
                frame = (heading, left, up)
                ahead = sorted(children[node], key=lambda c: (-radius[c], -length[c]))
                for side in ahead[1:]:
                    parts.append("[" + "".join(move(side, place, frame, said)) + "]")
                if not ahead:
                    return parts
                node = ahead[0]

        first = children[0]
        frame = ((0.0, 1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
        return "".join(out + move(first[0], (0.0, 0.0, 0.0), frame, radius[0]))


def number(value, digits):
    text = ("%.*f" % (digits, value)).rstrip("0").rstrip(".")
    return text[1:] if text.startswith("0.") else text


AHEAD = (0.0, 1.0, 0.0)


def late(s):  # the shoots behind the tip are the longest of last year's
    return 0.35 + 0.65 * math.sin(math.pi * min(1.0, 0.15 + 0.8 * s))


def early(s):  # the oldest are the longest
    return 1.05 - 0.8 * s


def maple(t):
    rules = [
        {"step": 0.055, "wander": 2.0, "lift": 14, "buds": 2, "divergence": 90, "spread": 6, "angle": 48, "tip_angle": 42,
         "reach": early, "ratio": 0.58, "bare": 0.2, "every": 2, "crown": 2, "shortest": 0.04},
        {"step": 0.045, "wander": 2.0, "lift": 30, "buds": 2, "divergence": 90, "spread": 6, "angle": 45, "reach": early,
         "ratio": 0.42, "bare": 0.3, "every": 2, "crown": 2, "shortest": 0.03},
        {"step": 0.035, "wander": 2.5, "lift": 40},
    ]
    t.shoot(0, AHEAD, 0.95, 0, rules)
    return t.radii(0.0019, 2.5, 0.0006)


def cherry(t):
    rules = [
        {"step": 0.035, "wander": 2.2, "lift": 8, "divergence": 144, "angle": 50, "tip_angle": 40, "reach": late,
         "ratio": 0.5, "bare": 0.12, "spur": 0.68, "spur_radius": 0.0032, "least": 0.7, "shortest": 0.06},
        {"step": 0.04, "wander": 2.5, "lift": 40, "divergence": 144, "angle": 48, "reach": late, "ratio": 0.3, "bare": 0.2,
         "spur": 0.85, "spur_radius": 0.003, "every": 2, "shortest": 0.05},
        {"step": 0.025, "wander": 3, "lift": 60},
    ]
    t.shoot(0, AHEAD, 1.05, 0, rules)
    return t.radii(0.0017, 2.8, 0.0005)


def oak(t):
    rules = [
        {"step": 0.045, "wander": 8, "zigzag": 13, "lift": 6, "tip_lift": 25, "divergence": 144, "angle": 66, "tip_angle": 52,
         "reach": late, "ratio": 0.6, "bare": 0.15, "every": 2, "crown": 3, "grows": 0.85, "shortest": 0.05},
        {"step": 0.035, "wander": 9, "zigzag": 14, "lift": 35, "divergence": 144, "angle": 62, "reach": late, "ratio": 0.5,
         "bare": 0.25, "every": 2, "crown": 3, "grows": 0.75, "shortest": 0.035},
        {"step": 0.025, "wander": 9, "zigzag": 12, "lift": 50, "divergence": 144, "angle": 55, "reach": late, "ratio": 0.5,
         "bare": 0.5, "every": 2, "crown": 2, "grows": 0.4, "shortest": 0.03},
        {"step": 0.025, "wander": 6, "zigzag": 5, "lift": 30},
    ]
    t.shoot(0, AHEAD, 0.85, 0, rules)
    return t.radii(0.0019, 2.4, 0.0009)


def birch(t):
    rules = [
        {"step": 0.05, "wander": 2.5, "zigzag": 4, "lift": -8, "tip_lift": -75, "divergence": 180, "spread": 35, "angle": 42,
         "reach": lambda s: 1.0 - 0.55 * s, "ratio": 0.62, "bare": 0.1, "least": 0.45, "shortest": 0.08},
        {"step": 0.045, "wander": 3, "zigzag": 4, "lift": -60, "tip_lift": -210, "divergence": 180, "spread": 35, "angle": 36,
         "reach": lambda s: 1.0 - 0.5 * s, "ratio": 0.6, "bare": 0.15, "every": 2, "grows": 0.85, "shortest": 0.06},
        {"step": 0.05, "wander": 3, "zigzag": 4, "lift": -170, "tip_lift": -240},
    ]
    t.shoot(0, AHEAD, 1.15, 0, rules)
    return t.radii(0.001, 2.35, 0.0006)


def willow(t):
    rules = [
        {"step": 0.045, "wander": 2, "lift": -25, "tip_lift": -110, "divergence": 137.5, "angle": 34, "tip_angle": 24,
         "reach": lambda s: 1.1 - 0.55 * s, "ratio": 0.95, "bare": 0.08, "grows": 0.85, "whole": 0.95,
         "least": 0.5, "shortest": 0.2},
        {"step": 0.055, "wander": 2, "lift": -190, "tip_lift": -230},
    ]
    t.shoot(0, AHEAD, 1.2, 0, rules)
    return t.radii(0.0012, 2.35, 0.0007)


def pine(t):
    rules = [
        {"step": 0.065, "wander": 1.5, "lift": 14, "tip_lift": 30, "buds": 4, "divergence": 45, "spread": 8, "angle": 62,
         "tip_angle": 45, "reach": early, "ratio": 0.52, "bare": 0.2, "every": 4, "crown": 4, "least": 0.8,
         "shortest": 0.05},
        {"step": 0.05, "wander": 2, "lift": 45, "tip_lift": 110, "buds": 3, "divergence": 60, "spread": 8, "angle": 50,
         "reach": early, "ratio": 0.45, "bare": 0.35, "every": 3, "crown": 3, "shortest": 0.05},
        {"step": 0.035, "wander": 2, "lift": 90, "tip_lift": 140},
    ]
    t.shoot(0, AHEAD, 1.05, 0, rules)
    return t.radii(0.0034, 2.9, 0.0005)


def spruce(t):
    rules = [
        {"step": 0.045, "wander": 1.2, "lift": -14, "tip_lift": 22, "buds": 2, "flat": 10, "angle": 58, "tip_angle": 48,
         "reach": lambda s: 1.0 - 0.85 * s, "ratio": 0.5, "bare": 0.1, "every": 2, "least": 0.8, "crown": 2,
         "shortest": 0.03},
        {"step": 0.045, "wander": 1.5, "lift": -45, "tip_lift": -10, "buds": 2, "flat": 22, "angle": 48, "reach": early,
         "ratio": 0.4, "bare": 0.2, "every": 2, "grows": 0.85, "shortest": 0.03},
        {"step": 0.035, "wander": 2, "lift": -110},
    ]
    t.shoot(0, AHEAD, 1.1, 0, rules)
    return t.radii(0.0015, 2.6, 0.0006)


def apple(t):
    rules = [
        {"step": 0.04, "wander": 6, "zigzag": 5, "lift": -6, "tip_lift": 40, "divergence": 144, "angle": 68, "tip_angle": 45,
         "reach": lambda s: 0.6 + 0.5 * math.sin(math.pi * s), "ratio": 0.52, "bare": 0.1, "spur": 0.6,
         "spur_radius": 0.004, "least": 0.6, "shortest": 0.06},
        {"step": 0.035, "wander": 5, "zigzag": 4, "lift": 110, "tip_lift": 60, "divergence": 144, "angle": 55,
         "reach": late, "ratio": 0.4, "bare": 0.15, "spur": 0.75, "spur_radius": 0.0038, "every": 2,
         "shortest": 0.04},
        {"step": 0.018, "wander": 9, "lift": 90},
    ]
    t.shoot(0, AHEAD, 0.9, 0, rules)
    return t.radii(0.0019, 2.9, 0.0006)


def generic(t):
    rules = [
        {"step": 0.05, "wander": 3.5, "lift": 10, "divergence": 137.5, "angle": 50, "tip_angle": 40, "reach": early,
         "ratio": 0.6, "bare": 0.15, "every": 2, "shortest": 0.05},
        {"step": 0.045, "wander": 4, "lift": 30, "divergence": 137.5, "angle": 46, "reach": early, "ratio": 0.45, "bare": 0.25,
         "every": 2, "shortest": 0.04},
        {"step": 0.04, "wander": 4, "lift": 30},
    ]
    t.shoot(0, AHEAD, 1.0, 0, rules)
    return t.radii(0.0018, 2.4, 0.0008)


def dead(t):
    rules = [
        {"step": 0.05, "wander": 8, "zigzag": 7, "lift": -6, "divergence": 137.5, "angle": 64, "reach": early, "ratio": 0.6,
         "bare": 0.1, "grows": 0.7, "least": 0.15, "shortest": 0.03},
        {"step": 0.035, "wander": 9, "zigzag": 8, "lift": -20, "divergence": 137.5, "angle": 58, "reach": early, "ratio": 0.5,
         "bare": 0.25, "grows": 0.6, "least": 0.2, "shortest": 0.025},
        {"step": 0.025, "wander": 8, "zigzag": 8, "lift": -20},
    ]
    tip = t.shoot(0, AHEAD, 0.8, 0, rules)
    # Snapped where it was still thick, and many a side twig with it.
    t.thicken(tip, 0.0065)
    bearing = {parent for _, parent, _ in t.nodes}
    for i in range(1, len(t.nodes)):
        if i not in bearing and i != tip and t.random.random() < 0.6:
            t.thicken(i, t.uniform(0.0025, 0.005))
    return t.radii(0.0016, 2.7, 0.0008)


# Name: how it grows, its seed, degrees above the level that it grew at, the colours of its stout and of its thin wood,
# its first line.
TWIGS = {
    "maple": (maple, 4, 35, (158, 132, 110), (172, 110, 92), "Maple: buds in pairs, each pair square to the last"),
    "cherry": (cherry, 5, 35, (140, 106, 92), (176, 112, 88), "Cherry: few long shoots, short spurs between them"),
    "oak": (oak, 3, 25, (146, 132, 114), (160, 140, 108), "Oak: crooked, tufts of twigs where a year's growth ended"),
    "birch": (birch, 5, 35, (226, 220, 208), (150, 104, 88), "Birch: fine twigs that hang at their ends"),
    "willow": (willow, 2, 40, (150, 138, 104), (196, 178, 92), "Weeping willow: long whips"),
    "pine": (pine, 2, 20, (172, 122, 86), (190, 146, 96), "Pine: whorls of stout shoots, turned up at their ends"),
    "spruce": (spruce, 6, 5, (142, 112, 92), (184, 136, 92), "Spruce: a flat spray, its twigs hanging a little"),
    "apple": (apple, 4, 20, (144, 130, 116), (160, 124, 106), "Apple: wide angles, thick spurs, shoots that rise"),
    "generic": (generic, 1, 35, (152, 126, 100), (168, 136, 104), "A twig of no kind: one bud after another, all around"),
    "dead": (dead, 4, 15, (168, 164, 156), (186, 180, 168), "Dead wood: crooked, few twigs, snapped ends"),
}
for kind, (_, seeds, _, _, rise, stout, thin, title) in crown_twigs.KINDS.items():
    for size, named in enumerate(crown_twigs.NAMES):
        TWIGS[kind + "_" + named] = (
            lambda t, kind=kind, size=size: crown_twigs.grow(t, kind, size), seeds[size], rise, stout, thin, title)


def draw(twig, radius, rise, stout, thin):
    """Rows of a thumbnail's pixels, red green blue alpha: as the twig grew, seen from a little above."""
    over = 3  # samples per pixel and axis
    size = SIDE * over
    e, a, b = math.radians(rise), math.radians(30), math.radians(22)

    def seen(p):
        ahead, up = p[1] * math.cos(e) - p[2] * math.sin(e), p[1] * math.sin(e) + p[2] * math.cos(e)
        x, deep = ahead * math.cos(a) + p[0] * math.sin(a), -ahead * math.sin(a) + p[0] * math.cos(a)
        return (x, up * math.cos(b) + deep * math.sin(b), -up * math.sin(b) + deep * math.cos(b))

    places = [seen(n[0]) for n in twig.nodes]
    low = [min(p[i] for p in places) for i in (0, 1)]
    high = [max(p[i] for p in places) for i in (0, 1)]
    scale = 0.92 * size / max(high[0] - low[0], high[1] - low[1])
    middle = [(low[i] + high[i]) / 2 for i in (0, 1)]
    dots = [(size / 2 + (p[0] - middle[0]) * scale, size / 2 - (p[1] - middle[1]) * scale, p[2] * scale) for p in places]
    depth = [[1e9] * size for _ in range(size)]
    color = [[None] * size for _ in range(size)]
    for i, (_, parent, _) in enumerate(twig.nodes):
        if parent < 0:
            continue
        p, q = dots[parent], dots[i]
        most = max(radius[i] * scale, 0.5 * over)  # no wood is thinner than a pixel
        first = max(min(radius[parent], 1.3 * radius[i]) * scale, most)
        dx, dy = q[0] - p[0], q[1] - p[1]
        square = dx * dx + dy * dy
        share = min(1.0, max(0.0, (radius[i] - 0.0025) / 0.005))
        base = [t + (s - t) * share for s, t in zip(stout, thin)]
        for y in range(max(0, int(min(p[1], q[1]) - first)), min(size, int(max(p[1], q[1]) + first) + 2)):
            for x in range(max(0, int(min(p[0], q[0]) - first)), min(size, int(max(p[0], q[0]) + first) + 2)):
                t = min(1.0, max(0.0, ((x - p[0]) * dx + (y - p[1]) * dy) / square)) if square > 0 else 0.0
                ox, oy = x - p[0] - t * dx, y - p[1] - t * dy
                wide = first + (most - first) * t
                off = (ox * ox + oy * oy) / (wide * wide)
                if off > 1.0:
                    continue
                near = p[2] + (q[2] - p[2]) * t - wide * math.sqrt(1 - off)
                if near < depth[y][x]:
                    depth[y][x] = near
                    light = 0.62 + 0.4 * max(0.0, (-0.5 * ox - 0.7 * oy) / wide + 0.5 * math.sqrt(1 - off))
                    color[y][x] = [min(255.0, c * light) for c in base]
    rows = []
    for y in range(SIDE):
        row = bytearray()
        for x in range(SIDE):
            samples = [color[y * over + j][x * over + i] for j in range(over) for i in range(over)]
            there = [c for c in samples if c]
            row += bytes(round(sum(c[k] for c in there) / len(there)) if there else 0 for k in range(3))
            row.append(round(255 * len(there) / len(samples)))
        rows.append(bytes(row))
    return rows


def write_png(path, rows):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", SIDE, len(rows), 8, 6, 0, 0, 0)
    pixels = zlib.compress(b"".join(b"\0" + row for row in rows), 9)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", pixels) + chunk(b"IEND", b""))


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    thumbnails = os.path.join(here, "../../../addons/tree_reconstruction/presets/twigs")
    os.makedirs(thumbnails, exist_ok=True)
    for name in sys.argv[1:] or TWIGS:
        grow, seed, rise, stout, thin, title = TWIGS[name]
        twig = Twig(seed, rise)
        radius = grow(twig)
        text = twig.string(radius)
        lines, line = ["# " + title], ""
        for piece in text.replace("[", "\n[").split("\n"):  # broken before brackets alone
            if line and len(line) + len(piece) > 110:
                lines.append(line)
                line = ""
            line += piece
        with open("%s/%s.lstring" % (here, name), "w", encoding="utf-8") as file:
            file.write("\n".join(lines + [line, ""]))
        write_png("%s/%s.png" % (thumbnails, name), draw(twig, radius, rise, stout, thin))
        print("%s: %d nodes, %d bytes" % (name, len(twig.nodes), len(text)))


if __name__ == "__main__":
    main()
