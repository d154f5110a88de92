"""A tree's small picture, out of the sheet that treerec draws of it."""
import numpy
from PIL import Image

SIZE = (240, 300)
TREE = 3  # among the sheet's upper panels: cloud, two skeletons, the tree in leaf
EDGE = 3  # pixels: within a panel's frame


def runs_of(flags):
    """[(first, one behind the last)] of what is true."""
    steps = numpy.flatnonzero(numpy.diff(numpy.concatenate([[0], flags.astype(int), [0]])))
    return list(zip(steps[::2].tolist(), steps[1::2].tolist()))


def panel_of(pixels):
    """Panels are as wide as the tree; they are white, and what is around them is not."""
    white = (pixels == 255).all(axis=2)
    top = int(numpy.flatnonzero(white.mean(axis=1) > 0.5)[0]) + EDGE
    panels = [run for run in runs_of(white[top]) if run[1] - run[0] > 50]
    left, right = panels[min(TREE, len(panels) - 1)]
    _, bottom = runs_of(white[top:, left + EDGE])[0]
    return left + EDGE, top, right - EDGE, top + bottom - EDGE


def take(sheet, target):
    with Image.open(sheet) as image:
        small = image.convert("RGB")
        small = small.crop(panel_of(numpy.asarray(small)))
        small.thumbnail(SIZE, Image.Resampling.LANCZOS)
        small.save(target, quality=80)
