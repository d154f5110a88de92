"""Finds a godot-cpp that is installed, or checked out and built, for SConscript and for ./dev.

    find_godot_cpp.py     prints the folder of the one that scons takes for the editor library; ends with 1 where there is none
"""

import glob
import os
import platform
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
TARGETS = ("editor", "template_debug", "template_release")
PLATFORMS = ("linux", "windows", "macos", "android", "ios", "web")
LEAST = (4, 6)  # the engine's version whose API the sources use
TRIPLETS = {
    ("linux", "x86_64"): "x64-linux", ("linux", "arm64"): "arm64-linux", ("windows", "x86_64"): "x64-mingw-static",
    ("macos", "x86_64"): "x64-osx", ("macos", "arm64"): "arm64-osx",
}


class NotFound(Exception):
    """Why a folder has no godot-cpp that can be taken, as a sentence."""


class GodotCpp:
    """folder: a prefix that it is installed in (include/, lib/), or its sources as they lie when they are built (include/,
    gen/include/, bin/). Raises NotFound."""

    def __init__(self, folder, system, target, arch):
        self.folder = os.path.abspath(folder)
        if not os.path.exists(self._path("include", "godot_cpp", "godot.hpp")):
            raise NotFound("there is no godot-cpp in %s: include/godot_cpp/godot.hpp is missing" % folder)
        self.includes = [self._path(name) for name in ("gdextension", "include", "gen/include") if os.path.isdir(self._path(name))]
        self.target, self.library = self._library(system, target, arch)
        version = self._version()
        if version < LEAST:
            raise NotFound("the godot-cpp in %s is for Godot %d.%d; it must be for %d.%d or newer" % (folder, *version, *LEAST))

    def _path(self, *parts):
        return os.path.join(self.folder, *parts)

    def _library(self, system, target, arch):
        """An editor library may be any; a game's must be its own, since the others carry more."""
        files = [path for where in ("lib", "bin") for ending in ("a", "lib") for path in sorted(glob.glob(self._path(where, "*godot-cpp*." + ending)))]
        wanted = TARGETS if target == "editor" else (target,)
        unnamed = []
        found = {}
        for path in files:
            words = os.path.basename(path).split(".")
            if {"double", "nothreads"} & set(words) or not {system} >= set(words) & set(PLATFORMS):
                continue
            named = [word for word in words if word in TARGETS]
            if not named:
                # An installation of a single library need not name its target; it is a release's.
                unnamed.append(path)
            elif arch in words:
                found.setdefault(named[0], path)
        for name in wanted:
            if name in found:
                return name, found[name]
        if unnamed:
            return "template_release", unnamed[0]
        raise NotFound("the godot-cpp in %s has no library for %s, %s, %s" % (self.folder, system, target, arch))

    def _version(self):
        for include in self.includes:
            path = os.path.join(include, "godot_cpp", "core", "version.hpp")
            if os.path.exists(path):
                with open(path, encoding="utf-8") as file:
                    text = file.read()
                numbers = [re.search(r"GODOT_VERSION_%s\s+(\d+)" % name, text) for name in ("MAJOR", "MINOR")]
                if all(numbers):
                    return tuple(int(number.group(1)) for number in numbers)
        return LEAST  # the compiler tells

    def definitions(self, system, threads=True):
        """What its library was compiled with."""
        words = [system.upper() + "_ENABLED"] + (["THREADS_ENABLED"] if threads else [])
        words += ["UNIX_ENABLED"] if system != "windows" else []
        words += ["DEBUG_ENABLED", "HOT_RELOAD_ENABLED"] if self.target != "template_release" else []
        words += ["TOOLS_ENABLED"] if self.target == "editor" else []
        return words


def usual_places(system, arch, environ=os.environ, root=ROOT):
    """Where one may be, the nearest first: beside our sources, in vcpkg's folders, in the system's."""
    triplet = TRIPLETS.get((system, arch), "")
    places = [os.path.join(root, "godot-cpp"), os.path.join(root, "vcpkg_installed", triplet)]
    if environ.get("VCPKG_ROOT"):
        places.append(os.path.join(environ["VCPKG_ROOT"], "installed", triplet))
    if environ.get("MINGW_PREFIX"):
        places.append(environ["MINGW_PREFIX"])
    return places + ["/usr/local", "/usr"]


def find(said, system, target, arch, environ=os.environ, root=ROOT, remark=print):
    """The godot-cpp to build against, or None for the bindings of this project. said: a folder; "" for $GODOT_CPP, or any that
    there is; "none". What is named must be right: raises NotFound. remark: gets a sentence for each that is passed over."""
    said = said or environ.get("GODOT_CPP", "")
    if said == "none":
        return None
    if said:
        return GodotCpp(said, system, target, arch)
    for place in usual_places(system, arch, environ, root):
        if not os.path.exists(os.path.join(place, "include", "godot_cpp", "godot.hpp")):
            continue
        try:
            return GodotCpp(place, system, target, arch)
        except NotFound as reason:
            remark("Passed over, since %s." % reason)
    return None


if __name__ == "__main__":
    here = {"Linux": "linux", "Windows": "windows", "Darwin": "macos"}[platform.system()]
    processor = {"amd64": "x86_64", "aarch64": "arm64"}.get(platform.machine().lower(), platform.machine().lower())
    try:
        taken = find("", here, "editor", processor, remark=lambda sentence: print(sentence, file=sys.stderr))
    except NotFound as reason:
        sys.exit("%s." % reason)
    if taken is None:
        sys.exit(1)
    print(taken.folder)
