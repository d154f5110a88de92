"""One page of all trees: pictures, figures, search, sort and a map. Needs no network and no other file."""
import base64
import json
import os
from pathlib import Path

PAGE = Path(__file__).parent / "catalogue.html"


def picture_of(row):
    path = Path("work/pictures") / f"{row['id']}.jpg"
    if row["code"] != 0 or not path.exists():
        return None
    return "data:image/jpeg;base64," + base64.b64encode(path.read_bytes()).decode()


def write(target, rows, names, values_of, title):
    trees = [{**dict(zip(names, values_of(row))), "picture": picture_of(row)} for row in rows]
    # Nothing in a name or a sentence ends the script that holds it.
    data = json.dumps({"title": title, "trees": trees}, separators=(",", ":")).replace("<", "\\u003c")
    part = Path(f"{target}.part")
    part.write_text(PAGE.read_text(encoding="utf-8").replace("/*TREES*/null", data), encoding="utf-8")
    os.replace(part, target)
