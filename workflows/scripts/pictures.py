"""A tree's thumbnail for the catalogue, of the picture that treerec draws of it."""
from PIL import Image

SIZE = (240, 300)


def take(picture, target):
    with Image.open(picture) as image:
        small = image.convert("RGB")
        small.thumbnail(SIZE, Image.Resampling.LANCZOS)
        small.save(target, quality=80)
