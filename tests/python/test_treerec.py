"""Tests of the Python package: `./dev test python`.

TREEREC_CLI: the program, whose bytes are to be the same. TREEREC_SAMPLE: a grown and scanned tree.
"""

import ast
import contextlib
import gc
import inspect
import io
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy as np
import treerec

PROGRAM = os.environ["TREEREC_CLI"]
SAMPLE = os.environ["TREEREC_SAMPLE"]


def program(*words):
    return subprocess.run([PROGRAM, *map(str, words)], check=True, capture_output=True, text=True).stdout


class Case(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.cloud = treerec.read_cloud(SAMPLE)
        cls.tree = treerec.reconstruct(cls.cloud)

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def refused(self, words, call, *arguments, **options):
        """The call raises treerec.Error, whose sentence has these words."""
        with self.assertRaises(treerec.Error) as raised:
            call(*arguments, **options)
        self.assertIsInstance(raised.exception, ValueError)
        self.assertIn(words, str(raised.exception))


class SameBytes(Case):
    def both(self, tree, leaves, *options):
        """Files of the tree, and those of the program."""
        for ending in ("txt", "csv", "ply", "glb"):
            tree.write(self.folder / ("ours." + ending), leaves=leaves)
        outs = [word for ending in ("txt", "csv", "ply", "glb") for word in ("-o", self.folder / ("its." + ending))]
        program("reconstruct", SAMPLE, *outs, "--leaves", leaves, "--quiet", *options)
        for ending in ("txt", "csv", "ply", "glb"):
            ours, its = ((self.folder / (name + ending)).read_bytes() for name in ("ours.", "its."))
            self.assertTrue(ours == its, "%s: %d and %d bytes" % (ending, len(ours), len(its)))

    def test_of_a_cloud(self):
        self.both(self.tree, "oak")

    def test_of_arrays(self):
        tree = treerec.reconstruct(self.cloud.points, self.cloud.colors, prune="leader", complete=True, seed=3)
        self.both(tree, "birch", "--prune", "leader", "--complete", "--seed", "3")

    def test_of_points_in_any_order_and_layout(self):
        order = np.random.default_rng(1).permutation(len(self.cloud))
        points = np.asfortranarray(self.cloud.points[order])
        tree = treerec.reconstruct(points, self.cloud.colors[order])
        self.assertTrue(np.array_equal(tree.positions, self.tree.positions))

    def test_whatever_the_threads(self):
        treerec.set_threads(1)
        self.addCleanup(treerec.set_threads, None)
        self.assertTrue(np.array_equal(treerec.reconstruct(self.cloud).radii, self.tree.radii))

    def test_far_from_zero(self):
        shift = np.array([443210.0, 5431234.0, 312.0])
        tree = treerec.reconstruct(self.cloud.points + shift, self.cloud.colors)
        np.testing.assert_allclose(tree.scan_positions - shift, self.tree.scan_positions, atol=0.02)
        self.assertAlmostEqual(tree.origin[0] - shift[0], self.tree.origin[0], delta=0.02)

    def test_scores_and_measures_are_the_programs(self):
        self.tree.write(self.folder / "tree.txt")
        told = json.loads(program("info", self.folder / "tree.txt", "--json"))
        measured = treerec.read_tree(self.folder / "tree.txt").measure()
        self.assertEqual({key: told[key] for key in measured}, measured)
        score = json.loads(program("score", self.folder / "tree.txt", SAMPLE, "--json"))
        self.assertEqual(score, treerec.read_tree(self.folder / "tree.txt").score(self.cloud))
        self.assertGreater(score["explained_2cm"], 0.9)


class Arrays(Case):
    def test_describe_one_tree(self):
        tree = self.tree
        count = len(tree)
        self.assertEqual(tree.positions.shape, (count, 3))
        self.assertEqual((tree.positions.dtype, tree.radii.dtype), (np.float64, np.float64))
        self.assertEqual(tree.parents[0], -1)
        self.assertTrue((tree.parents[1:] >= 0).all() and (tree.parents[1:] < np.arange(1, count)).all())
        self.assertTrue((tree.radii > 0).all() and np.isfinite(tree.positions).all())
        steps = tree.positions[1:] - tree.positions[tree.parents[1:]]
        self.assertAlmostEqual(np.linalg.norm(steps, axis=1).sum(), tree.measure()["length_m"], places=6)
        self.assertTrue((tree.flags & treerec.TRUNK)[0] and (tree.flags & treerec.MEASURED).any())
        self.assertAlmostEqual(np.ptp(tree.positions[:, 1]), tree.measure()["height_m"], places=9)

    def test_live_longer_than_what_they_are_of(self):
        tree = treerec.reconstruct(self.cloud)
        arrays = [tree.positions, tree.radii, tree.parents, tree.flags, tree.cleaned_points, tree.cleaned_leaf]
        arrays += [*tree.mesh(), *tree.leaves("oak")]
        cloud = treerec.cloud(self.cloud.points, self.cloud.colors)
        arrays += [cloud.points, cloud.colors]
        before = [array.copy() for array in arrays]
        del tree, cloud
        gc.collect()
        others = [np.full(array.shape, 7, array.dtype) for array in arrays]  # takes freed memory, were there any
        for array, copy in zip(arrays, before):
            self.assertTrue(np.array_equal(array, copy))
        self.assertEqual(len(others), len(arrays))

    def test_of_the_tree_are_read_only(self):
        for array in (self.tree.positions, self.tree.radii, self.tree.parents, self.tree.flags):
            with self.assertRaises(ValueError):
                array[0] = 1

    def test_mesh_and_leaves(self):
        mesh, leaves = self.tree.mesh(), self.tree.leaves("oak")
        self.assertLess(mesh.triangles.max(), len(mesh.vertices))
        np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, atol=1e-3)
        corners = mesh.vertices[mesh.triangles].astype(float)
        faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        outward = np.einsum("ij,ij->i", faces, mesh.normals[mesh.triangles[:, 0]])
        self.assertGreater((outward > 0).mean(), 0.95)
        self.assertGreater(len(leaves.positions), 1000)
        np.testing.assert_allclose(np.linalg.det(leaves.axes), 1.0, atol=1e-3)
        self.assertTrue((leaves.sizes > 0).all() and (leaves.kinds == 0).all())
        self.assertEqual(len(self.tree.leaves("none").positions), 0)
        self.assertFalse(np.array_equal(leaves.positions, self.tree.leaves("oak", seed=9).positions))

    def test_the_cloud_that_was_cleaned_lies_on_the_tree(self):
        points, leaf = self.tree.cleaned_points, self.tree.cleaned_leaf
        self.assertEqual(points.shape, (len(leaf), 3))
        self.assertLess(len(points), len(self.cloud) + 1)
        trunk = self.tree.positions[(self.tree.flags & treerec.TRUNK) > 0]
        nearest = np.linalg.norm(points[::50, None] - trunk[None], axis=2).min(axis=1)
        self.assertLess(np.quantile(nearest, 0.02), 0.3)


class Clouds(Case):
    def test_text_round_trip(self):
        path = self.folder / "some.xyz"
        np.savetxt(path, self.cloud.points[:500], fmt="%.17g")
        some = treerec.read_cloud(path)
        self.assertEqual(len(some), 500)
        self.assertIsNone(some.colors)
        np.testing.assert_allclose(some.points, self.cloud.points[:500], atol=1e-5)
        some.write(self.folder / "some.ply")
        np.testing.assert_allclose(treerec.read_cloud(self.folder / "some.ply").points, some.points, atol=1e-6)

    def test_colours_of_any_range(self):
        points, colors = self.cloud.points[:100], self.cloud.colors[:100]
        self.assertGreater(colors.max(), 1)
        for given in (colors.astype(np.uint16) * 257, colors / 255.0, colors.astype(np.int64)):
            same = treerec.cloud(points, given).colors
            self.assertLessEqual(np.abs(same.astype(int) - colors.astype(int)).max(), 1)
        dark = treerec.cloud(points, np.ones((100, 3), np.uint8)).colors
        self.assertEqual(dark.max(), 1)

    def test_what_is_no_number_is_left_out_and_said(self):
        points = self.cloud.points.copy()
        points[5] = np.nan
        points[6, 1] = np.inf
        cloud = treerec.cloud(points)
        self.assertEqual(len(cloud), len(points) - 2)
        self.assertIn("2 of 40000 points had no finite position", cloud.warnings[0])

    def test_what_is_no_cloud_gets_a_sentence(self):
        for points, words in (
            ([[1, 2]], "points has the shape (1, 2); it must be (N, 3)"),
            (np.zeros(3), "the shape (3,)"),
            ([[1, 2, 3], [4, 5]], "not of one length"),
            (np.zeros((4, 3), complex), "array of complex128"),
            (np.array([["a", "b", "c"]]), "must be of numbers"),
            (np.zeros((0, 3)), "holds no points"),
            (np.full((50, 3), np.nan), "no point with finite coordinates"),
            (np.full((50, 3), 1e300), "no point with"),
            (np.zeros((50, 3)), "only 1 place"),
            (np.linspace(0, 1, 300).reshape(100, 3), "on one straight line"),
            (SAMPLE, "read_cloud() reads the file"),
        ):
            with self.subTest(words):
                self.refused(words, treerec.reconstruct, points)
        self.refused("5 points, but 4 colours", treerec.cloud, np.eye(5, 3), np.zeros((4, 3)))
        self.refused("its own colours", treerec.reconstruct, self.cloud, self.cloud.colors)
        self.refused("none.ply", treerec.read_cloud, self.folder / "none.ply")


class Calls(Case):
    def test_options_are_the_programs(self):
        # Of files and of the terminal; the number of threads is set for all calls at once.
        files = {"-o", "--report", "--cloud", "--html", "--sheet", "--picture", "--quiet", "--leaves", "--levels", "--pictures-beside"}
        files |= {"--columns", "--classes", "--threads"}
        for name, call in (("reconstruct", treerec.reconstruct), ("grow", treerec.grow)):
            wanted = {option[2:].replace("-", "_") for option in treerec._treerec.option_names(name) if option not in files}
            taken = inspect.signature(call).parameters.values()
            ours = {parameter.name for parameter in taken if parameter.kind is parameter.KEYWORD_ONLY}
            self.assertEqual(ours - {"progress"}, wanted)

    def test_wrong_options_get_a_sentence(self):
        for options, words in (
            ({"up": "w"}, "'w' is no up axis"),
            ({"scale": float("nan")}, "scale needs a number from"),
            ({"scale": 1.0, "height": 3.0}, "scale, unit, height and length all set the scale"),
            ({"no_clean": 1}, "True and False"),
            ({"tree_at": (1, 2)}, "tree_at needs 3 numbers"),
            ({"length": [0, 0, 0, 0, 0, 0, 1]}, "length needs two different places"),
            ({"voxel": 0.1}, "voxel is the size of the flood's voxels"),
        ):
            with self.subTest(words):
                self.refused(words, treerec.reconstruct, self.cloud, **options)
        with self.assertRaises(TypeError):
            treerec.reconstruct(self.cloud, colour=3)
        self.refused(".glb", self.tree.write_glb, self.folder / "tree.txt")
        self.refused("no format that can be written", self.tree.write, self.folder / "tree.xyz")
        self.refused("nettle", self.tree.leaves, "nettle")
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_options_do_what_they_say(self):
        up = treerec.reconstruct(self.cloud.points[:, [1, 2, 0]], self.cloud.colors, up="y")
        np.testing.assert_allclose(np.ptp(up.positions[:, 1]), np.ptp(self.tree.positions[:, 1]), rtol=0.02)
        high = treerec.reconstruct(self.cloud, height=5.0)
        self.assertAlmostEqual(high.measure()["height_m"], 5.0, delta=0.3)
        self.assertEqual(treerec.reconstruct(self.cloud, scale=np.float64(2.0)).metres_per_unit, 2.0)

    def test_progress_grows_and_names_stages(self):
        told = []
        treerec.reconstruct(self.cloud, progress=lambda share, stage: told.append((share, stage)))
        shares = [share for share, _ in told]
        self.assertEqual(shares, sorted(shares))
        self.assertEqual(shares[-1], 1.0)
        self.assertLess({"Orienting", "Cleaning"}, {stage for _, stage in told})

    def test_progress_cancels(self):
        told = []

        def stop(share, _):
            told.append(share)
            return share < 0.3

        with self.assertRaises(treerec.Cancelled):
            treerec.reconstruct(self.cloud, progress=stop)
        self.assertLess(max(told), 0.9)

    def test_what_progress_raises_comes_out(self):
        def raises(*_):
            raise LookupError("its own")

        with self.assertRaisesRegex(LookupError, "its own"):
            treerec.reconstruct(self.cloud, progress=raises)

    def test_threads_of_python_run_meanwhile(self):
        steps, done = [0], threading.Event()

        def count():
            while not done.wait(0.001):
                steps[0] += 1

        thread = threading.Thread(target=count)
        thread.start()
        treerec.reconstruct(self.cloud)
        done.set()
        thread.join()
        self.assertGreater(steps[0], 20)

    def test_several_at_once(self):
        trees = [None] * 3

        def make(place):
            trees[place] = treerec.reconstruct(self.cloud, progress=lambda *_: True)

        threads = [threading.Thread(target=make, args=(place,)) for place in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for tree in trees:
            self.assertTrue(np.array_equal(tree.positions, self.tree.positions))

    @unittest.skipUnless(hasattr(os, "fork"), "this system does not fork")
    def test_a_forked_child_reconstructs_and_ends(self):
        script = (
            "import os, sys, treerec\n"
            "cloud = treerec.read_cloud(%r)\n"
            "nodes = len(treerec.reconstruct(cloud))\n"
            "child = os.fork()\n"
            "if child == 0:\n"
            "    sys.exit(0 if len(treerec.reconstruct(cloud)) == nodes else 3)\n"
            "sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))\n" % SAMPLE
        )
        self.assertEqual(subprocess.run([sys.executable, "-c", script], timeout=600).returncode, 0)

    @unittest.skipUnless(os.name == "posix", "signals of this system differ")
    def test_interrupt_ends_it(self):
        script = (
            "import os, signal, threading, treerec\n"
            # A shell's background jobs ignore it.
            "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
            "cloud = treerec.read_cloud(%r)\n"
            "threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT)).start()\n"
            "try:\n"
            "    for _ in range(100): treerec.reconstruct(cloud, complete=True)\n"
            "except KeyboardInterrupt: print('heard')\n" % SAMPLE
        )
        done = subprocess.run([sys.executable, "-c", script], timeout=600, capture_output=True, text=True)
        self.assertEqual(done.stdout, "heard\n", done.stderr)


class Types(unittest.TestCase):
    """_treerec.pyi names what there is; mypy reads the rest, which is written in Python."""

    def check(self, declared, thing):
        """How many functions were compared by their arguments."""
        compared = 0
        wanted = {item.name: item for item in declared.body if isinstance(item, (ast.FunctionDef, ast.ClassDef))}
        there = {name for name in vars(thing) if not name.startswith("_") or name == "__len__"}
        self.assertEqual({name for name in wanted if name[0] != "_" or name == "__len__"}, there)
        for name, item in wanted.items():
            member = getattr(thing, name)
            if isinstance(item, ast.ClassDef):
                if not issubclass(member, Exception):
                    compared += self.check(item, member)
            elif hasattr(member, "__nb_signature__") and name != "__len__":
                words = member.__nb_signature__[0][0]
                taken = [argument.arg for argument in item.args.args]
                self.assertEqual(re.findall(r"(\w+):", words.replace("self,", "self:,").replace("self)", "self:)")), taken)
                compared += 1
        return compared

    def test_are_right(self):
        path = pathlib.Path(treerec.__file__).with_name("_treerec.pyi")
        self.assertGreater(self.check(ast.parse(path.read_text(encoding="utf-8")), treerec._treerec), 15)
        self.assertTrue(path.with_name("py.typed").exists())


class Notebook(unittest.TestCase):
    def test_its_cells_run(self):
        path = pathlib.Path(__file__).parents[2] / "docs" / "python.ipynb"
        cells = [cell for cell in json.loads(path.read_text(encoding="utf-8"))["cells"] if cell["cell_type"] == "code"]
        names, said = {}, io.StringIO()
        with contextlib.redirect_stdout(said):
            for cell in cells:
                lines = "".join(cell["source"]).replace("import matplotlib.pyplot as plt\n", "")
                if "plt." not in lines:
                    exec(lines, names)
        self.assertIn("the same after reading it: True", said.getvalue())
        # What stands below the cells is what comes out.
        shown = [text for cell in cells for output in cell["outputs"] for text in output.get("text", [])]
        self.assertIn(repr(names["tree"]), "".join(shown))


class Strings(Case):
    def test_grow(self):
        self.assertIn("oak", treerec.grammars())
        oak = treerec.grow("oak", iterations=3, seed=2)
        self.assertFalse(np.array_equal(oak.radii, treerec.grow("oak", iterations=2, seed=2).radii))
        program("grow", "oak", "--iterations", 3, "--seed", 2, "-o", self.folder / "its.txt", "-o", self.folder / "its.glb")
        oak.write(self.folder / "ours.txt")
        oak.write_glb(self.folder / "ours.glb")
        for ending in (".txt", ".glb"):
            self.assertTrue((self.folder / ("ours" + ending)).read_bytes() == (self.folder / ("its" + ending)).read_bytes())
        self.refused("There is no file 'nettle'", treerec.grow, "nettle")

    def test_lstring_round_trip(self):
        back = treerec.lstring(self.tree.lstring(accuracy=1e-9))
        np.testing.assert_allclose(back.positions, self.tree.positions, atol=1e-6)
        np.testing.assert_allclose(back.origin, self.tree.origin)
        self.assertEqual(len(treerec.lstring("F(1)[+F(1)]F(2)")), 4)
        self.refused("line 1", treerec.lstring, "F(1)[+F(1)")
        self.refused("empty", treerec.lstring, " ")

    def test_tree_files_round_trip(self):
        for ending in ("txt", "ply"):
            path = self.folder / ("tree." + ending)
            self.tree.write(path)
            back = treerec.read_tree(path)
            np.testing.assert_allclose(back.scan_positions, self.tree.scan_positions, atol=1e-12)
            self.assertIsNone(back.report())
            self.assertIsNone(back.cleaned_points)
        self.assertEqual(self.tree.report()["points_read"], len(self.cloud))


if __name__ == "__main__":
    unittest.main()
