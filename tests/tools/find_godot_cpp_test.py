"""Tests of extension/find_godot_cpp.py: which godot-cpp the build takes."""

import os
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "extension"))
sys.dont_write_bytecode = True
import find_godot_cpp  # noqa: E402


class Find(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = folder.name
        self.remarks = []

    def put(self, *parts, text=""):
        path = os.path.join(self.root, *parts)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w") as file:
            file.write(text)
        return os.path.dirname(path)

    def installed(self, folder, *libraries, where="lib", minor=6):
        self.put(folder, "include", "godot_cpp", "godot.hpp")
        self.put(folder, "gen/include", "godot_cpp", "core", "version.hpp",
                 text="#define GODOT_VERSION_MAJOR 4\n#define GODOT_VERSION_MINOR %d\n" % minor)
        for name in libraries:
            self.put(folder, where, name)
        return os.path.join(self.root, folder)

    def find(self, said="", system="linux", target="editor", arch="x86_64", **environ):
        self.remarks = []
        # Of the system's own folders, tests know nothing.
        usual = find_godot_cpp.usual_places(system, arch, environ, self.root)
        places = [place for place in usual if place not in ("/usr/local", "/usr")]
        original = find_godot_cpp.usual_places
        find_godot_cpp.usual_places = lambda *_: places
        try:
            return find_godot_cpp.find(said, system, target, arch, environ, self.root, self.remarks.append)
        finally:
            find_godot_cpp.usual_places = original

    def test_nothing_is_no_error_unless_it_was_named(self):
        self.assertIsNone(self.find())
        self.assertEqual(self.remarks, [])
        self.assertIn("/usr", find_godot_cpp.usual_places("linux", "x86_64", {}, self.root))
        for named in ({"said": self.root}, {"GODOT_CPP": self.root}):
            with self.assertRaisesRegex(find_godot_cpp.NotFound, "godot.hpp is missing"):
                self.find(**named)

    def test_a_submodule_that_is_built(self):
        folder = self.installed("godot-cpp", "libgodot-cpp.linux.editor.x86_64.a", where="bin")
        found = self.find()
        self.assertEqual(found.library, os.path.join(folder, "bin", "libgodot-cpp.linux.editor.x86_64.a"))
        self.assertEqual(found.includes, [os.path.join(folder, "include"), os.path.join(folder, "gen/include")])
        self.assertIn("TOOLS_ENABLED", found.definitions("linux"))
        self.assertIsNone(self.find("none"))

    def test_a_submodule_that_is_not_built_is_passed_over_with_a_remark(self):
        self.installed("godot-cpp")
        self.assertIsNone(self.find())
        self.assertIn("no library for linux, editor, x86_64", self.remarks[0])

    def test_each_target_takes_what_suits_it(self):
        names = ["libgodot-cpp.linux.template_%s.x86_64.a" % kind for kind in ("debug", "release")]
        self.installed("godot-cpp", *names, where="bin")
        self.assertEqual(self.find().target, "template_debug")
        self.assertNotIn("TOOLS_ENABLED", self.find().definitions("linux"))
        release = self.find(target="template_release")
        self.assertTrue(release.library.endswith(names[1]))
        self.assertNotIn("DEBUG_ENABLED", release.definitions("linux"))
        self.assertIsNone(self.find(arch="arm64"))
        self.assertIsNone(self.find(system="windows"))

    def test_a_game_never_gets_the_editors(self):
        self.installed("godot-cpp", "libgodot-cpp.linux.editor.x86_64.a", where="bin")
        self.assertIsNone(self.find(target="template_release"))

    def test_other_numbers_and_threads_do_not_fit(self):
        self.installed(
            "godot-cpp", "libgodot-cpp.linux.editor.double.x86_64.a", "libgodot-cpp.linux.editor.x86_64.nothreads.a", where="bin")
        self.assertIsNone(self.find())

    def test_older_ones_are_passed_over(self):
        self.installed("godot-cpp", "libgodot-cpp.linux.editor.x86_64.a", where="bin", minor=5)
        self.assertIsNone(self.find())
        self.assertIn("is for Godot 4.5; it must be for 4.6 or newer", self.remarks[0])

    def test_vcpkg(self):
        folder = self.installed("tools/vcpkg/installed/x64-linux", "libgodot-cpp.a")
        found = self.find(VCPKG_ROOT=os.path.join(self.root, "tools/vcpkg"))
        self.assertEqual((found.folder, found.target), (folder, "template_release"))
        own = self.installed("vcpkg_installed/x64-linux", "libgodot-cpp.a")
        self.assertEqual(self.find(VCPKG_ROOT=os.path.join(self.root, "tools/vcpkg")).folder, own)
        beside = self.installed("godot-cpp", "libgodot-cpp.linux.editor.x86_64.a", where="bin")
        self.assertEqual(self.find().folder, beside)
        self.assertEqual(self.find(GODOT_CPP=folder).folder, folder)
        self.assertEqual(self.find(own, GODOT_CPP=folder).folder, own)


if __name__ == "__main__":
    unittest.main()
