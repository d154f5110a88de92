"""One page of all trees: pictures, figures, search, sort and a map. Needs no network and no other file."""
import base64
import json
import os
from pathlib import Path

PAGE = Path(__file__).parent / "catalogue.html"


def picture_of(tree):
    path = Path("work/pictures") / f"{tree['id']}.jpg"
    if tree["code"] != 0:
        return None
    return "data:image/jpeg;base64," + base64.b64encode(path.read_bytes()).decode()


def write(target, trees, standing, title):
    """standing: where in the scene a tree stands, for the map."""
    shown = [{**tree, "picture": picture_of(tree), "at": standing.get(tree["id"])} for tree in trees]
    # Nothing in a name or a sentence ends the script that holds it.
    data = json.dumps({"title": title, "trees": shown}, separators=(",", ":")).replace("<", "\\u003c")
    part = Path(f"{target}.part")
    part.write_text(PAGE.read_text(encoding="utf-8").replace("/*TREES*/null", data), encoding="utf-8")
    os.replace(part, target)
