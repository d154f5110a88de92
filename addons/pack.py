#!/usr/bin/env python3
"""Packs the built addon as the Asset Store and users want it: addons/tree_reconstruction/… in a zip.

    addons/pack.py --addon project/addons/tree_reconstruction --out FOLDER [--libraries FOLDER…]
        [--demo project --demo-tree FOLDER]

With --demo it packs a second zip: that project with the addon in it, and what is in FOLDER as the tree that its scenes
show (addons/demo_tree.gd makes it). It opens in an engine that knows nothing of it: a build or an import by hand is not needed.
The libraries are those in the addon's bin/ and in the given folders; the manifest names them alone, since the editor
crashes on a missing one (godot#115897). Same files, same bytes. Prints the zips' paths and what they weigh.
"""
import argparse
import configparser
import os
import sys
import zipfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
INSIDE = "addons/tree_reconstruction/"
DEMO = "tree_reconstruction-demo/"
# What the engine finds out about a project when it opens it first: with it the library is loaded from the start.
EXTENSIONS = {".godot/extension_list.cfg": b"res://%stree_reconstruction.gdextension\n" % INSIDE.encode()}
PLATFORMS = ("linux", "windows", "macos", "android", "web")
TARGETS = ("editor", "template_debug", "template_release")
GAMES_ALONE = ("android", "web")  # no editor of ours runs there


def fail(sentence):
    sys.exit("pack.py: " + sentence)


def read(path):
    with open(path, "rb") as file:
        return file.read()


def import_settings(text):
    """What we chose of an .import file; the engine writes where it put the result on this machine, too."""
    kept, section = [], ""
    for line in text.decode().splitlines():
        if line.startswith("["):
            section = line
            if section in ("[remap]", "[params]"):
                kept += [""] * bool(kept) + [line, ""]
        elif line and (section == "[params]" or (section == "[remap]" and line.startswith(("importer=", "type=")))):
            kept.append(line)
    return ("\n".join(kept) + "\n").encode()


def manifest(libraries):
    lines, section, named = [], "", set()
    for line in read(ROOT + "/extension/tree_reconstruction.gdextension").decode().splitlines(True):
        if line.startswith("["):
            section = line.strip()
        if section == "[libraries]" and "=" in line:
            name = line.split("=", 1)[1].strip().strip('"').removeprefix("bin/")
            if name not in libraries:
                continue
            named.add(name)
        lines.append(line)
    if named != set(libraries):
        fail("the manifest doesn't know %s." % ", ".join(sorted(set(libraries) - named)))
    return "".join(lines).encode()


def collect(addon, folders):
    """What goes into the zip, by its path in the addon."""
    files, libraries = {}, {}
    for folder, _, names in os.walk(addon):
        for name in names:
            path = os.path.join(folder, name)
            inside = os.path.relpath(path, addon).replace(os.sep, "/")
            if inside.startswith("bin/") or name.startswith(("~", ".")) or name.endswith((".tmp", "~")):
                continue
            if name.endswith(".import"):
                if inside.startswith("textures/"):
                    files[inside] = import_settings(read(path))
            else:
                files[inside] = read(path)
    for folder in [addon + "/bin", *folders]:
        for name in sorted(os.listdir(folder)) if os.path.isdir(folder) else []:
            if name.startswith("libtree_reconstruction.") and name.endswith((".so", ".dll", ".dylib", ".wasm")):
                libraries[name] = read(os.path.join(folder, name))
    for platform in PLATFORMS:
        for target in TARGETS[1:] if platform in GAMES_ALONE else TARGETS:
            there = [name for name in libraries if name.startswith("libtree_reconstruction.%s.%s." % (platform, target))]
            if not there and any(".%s." % platform in name for name in libraries):
                fail("the library %s for %s is missing: build it first." % (target, platform))
    if not libraries:
        fail("there is no library in %s/bin: build it first." % addon)
    for name, content in libraries.items():
        files["bin/" + name] = content
    files["tree_reconstruction.gdextension"] = manifest(libraries)
    for name in ("README.md", "LICENSE", "CHANGELOG.md"):
        files[name] = read("%s/%s" % (ROOT, name))
    return files


def collect_demo(project, tree, addon):
    """What goes into the demo's zip: the project's own files, the tree that it shows, and the addon as it is packed."""
    files = {INSIDE + name: content for name, content in addon.items()} | EXTENSIONS
    for root, where in ((project, ""), (tree, "demo/result/")):
        for folder, _, names in os.walk(root):
            for name in names:
                path = os.path.join(folder, name)
                inside = where + os.path.relpath(path, root).replace(os.sep, "/")
                made = inside.startswith(("addons/", ".godot/")) or (root == project and inside.startswith("demo/result/"))
                if not made and not name.startswith(("~", ".")) and not name.endswith((".tmp", "~", ".import")):
                    files[inside] = read(path)
    if "project.godot" not in files or "demo/result/tree.tscn" not in files:
        fail("there is no project in %s, or no tree in %s." % (project, tree))
    files["LICENSE"] = addon["LICENSE"]
    return files


def write(path, files):
    """The same files give the same bytes."""
    with zipfile.ZipFile(path + ".part", "w", zipfile.ZIP_DEFLATED, compresslevel=9) as zipped:
        for name in sorted(files):
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            zipped.writestr(entry, files[name])
    os.replace(path + ".part", path)
    print(path)


def main():
    parser = argparse.ArgumentParser(description="Packs the built addon into a zip.")
    parser.add_argument("--addon", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--libraries", nargs="*", default=[])
    parser.add_argument("--demo")
    parser.add_argument("--demo-tree")
    arguments = parser.parse_args()
    if (arguments.demo is None) != (arguments.demo_tree is None):
        fail("--demo and --demo-tree go together.")
    files = collect(arguments.addon, arguments.libraries)
    plugin = configparser.ConfigParser()
    plugin.read_string(files["plugin.cfg"].decode())
    version = plugin["plugin"]["version"].strip('"')
    os.makedirs(arguments.out, exist_ok=True)
    path = "%s/tree_reconstruction-%s.zip" % (arguments.out, version)
    write(path, {INSIDE + name: content for name, content in files.items()})
    demo = "%s/tree_reconstruction-demo-%s.zip" % (arguments.out, version)
    if arguments.demo:
        whole = collect_demo(arguments.demo, arguments.demo_tree, files)
        write(demo, {DEMO + name: content for name, content in whole.items()})
    sizes = {}
    for name, content in files.items():
        kind = name.removeprefix("bin/libtree_reconstruction.") if name.startswith("bin/") else name.split("/")[0] + "/" * ("/" in name)
        sizes[kind] = sizes.get(kind, 0) + len(content)
    for kind, size in sorted(sizes.items(), key=lambda item: -item[1]):
        print("%10d  %s" % (size, kind))
    print("%10d  all, %d in the zip" % (sum(sizes.values()), os.path.getsize(path)))
    if arguments.demo:
        print("%10d  all of the demo, %d in its zip" % (sum(len(content) for content in whole.values()), os.path.getsize(demo)))


main()
