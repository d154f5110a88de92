"""One page of all trees: pictures, figures, search, sort and a map. Needs no network."""
import base64
import json
import os
import shutil
from pathlib import Path

PAGE = Path(__file__).parent / "catalogue.html"
# Trees whose pictures the page itself holds; those of more lie beside it, and are read as they come into view.
MOST_INSIDE = 200
BESIDE = Path("catalogue_pictures")


def picture_of(tree, inside):
    if tree["code"] != 0:
        return None
    name = f"{tree['id']}.jpg"
    path = Path("work/pictures") / name
    if inside:
        return "data:image/jpeg;base64," + base64.b64encode(path.read_bytes()).decode()
    kept = BESIDE / name
    if not kept.exists() or kept.stat().st_mtime_ns < path.stat().st_mtime_ns:
        part = kept.with_suffix(".part")
        shutil.copyfile(path, part)
        os.replace(part, kept)
    return f"{BESIDE.name}/{name}"


def write(target, trees, standing, title):
    """standing: where in the scene a tree stands, for the map."""
    inside = len(trees) <= MOST_INSIDE
    if inside:
        shutil.rmtree(BESIDE, ignore_errors=True)
    else:
        BESIDE.mkdir(exist_ok=True)
        (BESIDE / ".gdignore").touch()
    shown = [{**tree, "picture": picture_of(tree, inside), "at": standing.get(tree["id"])} for tree in trees]
    # Nothing in a name or a sentence ends the script that holds it.
    data = json.dumps({"title": title, "trees": shown}, separators=(",", ":")).replace("<", "\\u003c")
    part = Path(f"{target}.part")
    part.write_text(PAGE.read_text(encoding="utf-8").replace("/*TREES*/null", data), encoding="utf-8")
    os.replace(part, target)
