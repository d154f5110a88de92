"""Which scans a folder holds, and which jobs they are done in."""
import fnmatch
import re

ENDINGS = (".ply", ".las", ".laz", ".e57", ".pcd", ".xyz", ".txt", ".asc", ".pts")


def name_of(inside):
    """The folder of plots is no part of their names."""
    shown = inside.relative_to("plots") if inside.parts[0] == "plots" else inside
    return re.sub(r"[^A-Za-z0-9]+", "_", str(shown.with_suffix(""))).strip("_") or "scan"


def scans_of(folder, out, plot_patterns):
    """({name: path} of trees, the same of plots). Names are fit for files, and each is there once."""
    trees, plots, taken = {}, {}, set()
    for path in sorted(folder.rglob("*")):
        if path.suffix.lower() not in ENDINGS or not path.is_file() or out in path.parents:
            continue
        inside = path.relative_to(folder)
        if any(part.startswith(".") for part in inside.parts):
            continue
        name = base = name_of(inside)
        count = 1
        while name.lower() in taken:
            count += 1
            name = f"{base}_{count}"
        taken.add(name.lower())
        is_plot = any(fnmatch.fnmatch(str(inside).lower(), pattern.lower()) for pattern in plot_patterns)
        (plots if is_plot else trees)[name] = path
    return trees, plots


def batches(name, trees, most):
    """{name of a batch: its trees}: as many to a batch as fit evenly, no more than `most`.

    A few trees are dealt out too, so that several cores have something to do, and in a way that does not depend on
    how many there are.
    """
    size = min(most, max(1, -(-len(trees) // 8)))
    return {f"{name}-{i // size:05d}": trees[i : i + size] for i in range(0, len(trees), size)}
