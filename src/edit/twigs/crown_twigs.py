"""How the twigs grow that fill the crown of a sketched tree (src/sketch/species.h): few nodes, leaves all over.

Lengths are those of Ma and Liu 2020, table 1, and one more so that each scaled by .7 to 1.3 follows on the one before. Its
radii are kept but for four: wood of maple 199 cm long and 5 cm thick, ginkgo 240/4, poplar 113/2 and magnolia 89/2
would be stouter than the next longer twig, so these, and the third of each, are as slender as the fourth column says:
length over radius of the other row.
"""

# Centimetres: the lengths, the shortest first, and the length over the radius.
SIZES = {
    "maple": ((110, 199, 355), 355 / 3),
    "ginkgo": ((133, 240, 323), 323 / 3),
    "poplar": ((78, 113, 203), 78 / 1),
    "magnolia": ((89, 120, 215), 120 / 1),
}
NAMES = ("short", "medium", "long")


def tapering(base, tip):
    return lambda s: base + (tip - base) * s


def bulging(base, middle, tip):
    """Of three reaches, at the base, where s = .4, and at the tip."""
    return lambda s: base + (middle - base) * s / 0.4 if s < 0.4 else middle + (tip - middle) * (s - 0.4) / 0.6


def maple(size):
    """Pairs, each square to the last; the two beside a tip go on as long as it does."""
    steps = ((0.185, 0.21, 0.2), (0.28, 0.3, 0.3), (0.36, 0.38, 0.4))[size]
    inner = {"step": steps[1], "straight": True, "wander": 3.5, "lift": 16, "buds": 2, "divergence": 90, "spread": 5, "angle": 46,
             "reach": tapering(1.0, 0.8), "ratio": 0.55, "bare": 0.45, "least": 0.85, "shortest": 0.12}
    trunk = dict(inner, step=steps[0], wander=2.5, lift=5, angle=54, tip_angle=42, reach=bulging(0.9, 1.0, 0.42),
                 ratio=(0.52, 0.46, 0.42)[size], bare=0.1)
    return [trunk, inner, {"step": steps[2], "straight": True, "wander": 3.0, "lift": 30}] if size else [
        trunk, {"step": steps[1], "straight": True, "wander": 3.5, "lift": 20}]


def ginkgo(size):
    """Long shoots far apart, rising, and short shoots along all of them."""
    steps = ((0.15, 0.2), (0.17, 0.23), (0.18, 0.22))[size]
    inner = {"step": steps[1], "wander": 3.5, "zigzag": 4, "lift": 18, "divergence": 137.5, "angle": 52,
             "reach": tapering(1.0, 0.6), "ratio": 0.55, "bare": 0.15, "least": 0.8, "shortest": 0.16,
             "spur": (1.0, 0.7, 0.62)[size], "spur_radius": 0.0032}
    trunk = dict(inner, step=steps[0], wander=2.2, zigzag=2, lift=6, angle=60, tip_angle=44,
                 reach=bulging(0.85, 1.0, 0.45), ratio=(0.5, 0.46, 0.45)[size], bare=0.1, spur=0.25)
    return [trunk, inner, {"step": 0.3, "wander": 3, "lift": 20}]


def poplar(size):
    """One bud after another, shoots that rise steeply beside the one that bears them."""
    steps = ((0.095, 0.11), (0.105, 0.13), (0.135, 0.18))[size]
    inner = {"step": steps[1], "wander": 3.0, "lift": 45, "divergence": 144, "angle": 42, "reach": tapering(1.0, 0.6),
             "ratio": 0.55, "bare": 0.2, "least": 0.8, "shortest": 0.08}
    trunk = dict(inner, step=steps[0], wander=1.8, lift=14, angle=55, tip_angle=34, reach=bulging(0.9, 1.0, 0.42),
                 ratio=(0.5, 0.5, 0.5)[size], bare=0.1)
    return [trunk, inner, {"step": 0.2, "wander": 3, "lift": 50}] if size else [
        trunk, {"step": steps[1], "wander": 2.5, "lift": 45}]


def magnolia(size):
    """Where a year's growth ended three or four shoots leave from one place, and from its tip as many."""
    steps = ((0.13, 0.18), (0.15, 0.2), (0.18, 0.3))[size]
    inner = {"step": steps[1], "wander": 5.0, "lift": (30, 25, 14)[size], "buds": 3, "divergence": 60, "spread": 14, "angle": 48,
             "reach": tapering(1.0, 1.0), "ratio": 0.5, "bare": 0.9, "crown": 3, "least": 0.85, "shortest": 0.1}
    trunk = dict(inner, step=steps[0], wander=3.5, lift=10, buds=3, divergence=45, angle=62, tip_angle=46,
                 reach=bulging((0.85, 0.8, 0.7)[size], 1.0, 0.5), ratio=(0.5, 0.5, 0.46)[size], bare=0.12, every=2, crown=(3, 3, 4)[size])
    return [trunk, inner, {"step": 0.3, "wander": 4, "lift": 40}] if size else [
        trunk, {"step": steps[1], "wander": 4, "lift": 30}]


# How it grows, the seeds by size (of 400 those whose wood fills its room best), the radius of its tips, the exponent of
# the pipe model, degrees above the level that it grew at, the colours of its stout and of its thin wood, its first line.
KINDS = {
    "maple": (maple, (315, 387, 249), 0.0022, 2.4, 35, (158, 132, 110), (172, 110, 92), "Maple, to fill a crown: shoots in pairs"),
    "ginkgo": (ginkgo, (163, 320, 294), 0.0028, 2.5, 30, (150, 136, 116), (178, 160, 132),
               "Ginkgo, to fill a crown: long shoots, short ones along them"),
    "poplar": (poplar, (264, 358, 148), 0.0022, 2.4, 45, (160, 156, 136), (176, 158, 112),
               "Poplar, to fill a crown: shoots one by one, rising steeply"),
    "magnolia": (magnolia, (181, 162, 329), 0.003, 2.6, 35, (146, 140, 132), (140, 116, 84),
                 "Magnolia, to fill a crown: shoots several from one place"),
}


def grow(twig, kind, size):
    """Radii of its nodes, which lie in `twig` afterwards."""
    rules, _, tip, exponent = KINDS[kind][:4]
    lengths, slenderness = SIZES[kind]
    length = lengths[size] / 100
    twig.shoot(0, (0.0, 1.0, 0.0), length, 0, rules(size))
    twig.stretch(length)
    radius = twig.radii(tip, exponent, 0.0005)
    # To the root's own, no tip thinner than it was.
    share = (length / slenderness - tip) / (radius[0] - tip)
    return [max(tip + (r - tip) * share, tip) for r in radius]
