"""A tree's small picture, out of the sheet that treerec draws of it."""
from PIL import Image

SIZE = (240, 300)
# The fourth of the sheet's upper row of four panels: the tree in leaf.
PANEL = (0.749, 0.086, 0.979, 0.499)


def take(sheet, target):
    with Image.open(sheet) as image:
        width, height = image.size
        left, top, right, bottom = PANEL
        box = (int(left * width), int(top * height), int(right * width), int(bottom * height))
        small = image.convert("RGB").crop(box)
        small.thumbnail(SIZE, Image.Resampling.LANCZOS)
        small.save(target, quality=80)
