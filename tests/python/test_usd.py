"""Tests of USD, by Pixar's own library: `./dev test python`. TREEREC_SAMPLE: a grown and scanned tree."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import treerec
import treerec.usd
from pxr import Gf, Kind, Usd, UsdGeom, UsdShade, UsdUtils, UsdValidation
from treerec._glb import Glb

SAMPLE = os.environ["TREEREC_SAMPLE"]


class Files(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.path = pathlib.Path(cls.folder.name)
        cls.tree = treerec.reconstruct(treerec.read_cloud(SAMPLE))
        for name in ("oak.glb", "oak.usda", "oak.usdz"):
            cls.tree.write(cls.path / name, leaves="oak", levels=3)

    def open(self, name):
        stage = Usd.Stage.Open(str(self.path / name))
        self.assertTrue(stage)
        return stage

    def failure(self, source, target):
        with self.assertRaises(treerec.Error) as raised:
            treerec.usd.convert(source, target)
        self.assertFalse(os.path.exists(target))
        return str(raised.exception)

    def test_pixars_validators_find_nothing(self):
        registry = UsdValidation.ValidationRegistry()
        context = UsdValidation.ValidationContext(registry.GetOrLoadAllValidators())
        for name in ("oak.usda", "oak.usdz"):
            found = [str(error.GetMessage()) for error in context.Validate(self.open(name))]
            self.assertEqual(found, [], name)

    def test_all_levels_are_those_of_the_glb(self):
        glb = Glb(self.path / "oak.glb")
        self.assertEqual(len(glb.levels()), 3)
        for name in ("oak.usda", "oak.usdz"):
            stage = self.open(name)
            root = stage.GetDefaultPrim()
            self.assertEqual(Usd.ModelAPI(root).GetKind(), Kind.Tokens.component)
            self.assertEqual((UsdGeom.GetStageUpAxis(stage), UsdGeom.GetStageMetersPerUnit(stage)), ("Y", 1.0))
            self.assertAlmostEqual(root.GetCustomData()["treerec"]["height_m"], self.tree.measure()["height_m"], places=2)
            variants = root.GetVariantSet("LOD")
            self.assertEqual(variants.GetVariantNames(), ["LOD0", "LOD1", "LOD2"])
            self.assertEqual(variants.GetVariantSelection(), "LOD0")
            for number, level in enumerate(glb.levels()):
                variants.SetVariantSelection("LOD%d" % number)
                for part, primitive in zip(("Bark", "Leaves"), level["primitives"]):
                    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/Tree/" + part))
                    of_glb = {key: glb.values(at) for key, at in primitive["attributes"].items()}
                    np.testing.assert_array_equal(mesh.GetPointsAttr().Get(), of_glb["POSITION"])
                    np.testing.assert_array_equal(mesh.GetNormalsAttr().Get(), of_glb["NORMAL"])
                    indices = glb.values(primitive["indices"])
                    np.testing.assert_array_equal(mesh.GetFaceVertexIndicesAttr().Get(), indices)
                    self.assertEqual(len(mesh.GetFaceVertexCountsAttr().Get()) * 3, len(indices))
                    places = np.array(UsdGeom.PrimvarsAPI(mesh).GetPrimvar("st").Get())
                    np.testing.assert_allclose(places, of_glb["TEXCOORD_0"] * [1, -1] + [0, 1], atol=1e-5)
                    wind = np.array(UsdGeom.PrimvarsAPI(mesh).GetPrimvar("wind").Get())
                    np.testing.assert_allclose(wind, of_glb["_WIND"], atol=1e-6)
            variants.SetVariantSelection("LOD0")
            bounds = UsdGeom.BBoxCache(Usd.TimeCode.Default(), ["default"]).ComputeWorldBound(root).GetRange()
            self.assertTrue(bounds.Contains(Gf.Vec3d(0.0, 1.0, 0.0)))
            self.assertGreater(bounds.GetSize()[1], 0.9 * self.tree.measure()["height_m"])

    def test_materials_have_their_pictures(self):
        glb = Glb(self.path / "oak.glb")
        inside = {name for texture in range(len(glb.json["textures"])) for name in [glb.picture(texture)[0]]}
        beside = {file.name: file.read_bytes() for file in (self.path / "oak_textures").iterdir()}
        self.assertEqual(set(beside), inside)
        for texture in range(len(glb.json["textures"])):
            name, data = glb.picture(texture)
            self.assertEqual(beside[name], data)
        for file in ("oak.usda", "oak.usdz"):
            stage = self.open(file)
            for part, opaque in (("Bark", True), ("Leaves", False)):
                bound = UsdShade.MaterialBindingAPI(stage.GetPrimAtPath("/Tree/" + part)).ComputeBoundMaterial()[0]
                self.assertEqual(bound.GetPath(), "/Tree/Materials/" + part)
                surface = bound.ComputeSurfaceSource()[0]
                self.assertEqual(surface.GetShaderId(), "UsdPreviewSurface")
                self.assertEqual(bool(surface.GetInput("opacityThreshold")), not opaque)
                for name in ("diffuseColor", "normal") + (("roughness",) if opaque else ("opacity",)):
                    source = surface.GetInput(name).GetConnectedSources()[0][0].source
                    picture = UsdShade.Shader(source.GetPrim()).GetInput("file").Get()
                    self.assertTrue(picture.resolvedPath, "%s: %s" % (file, picture))
        _, _, missing = UsdUtils.ComputeAllDependencies(str(self.path / "oak.usdz"))
        self.assertEqual(missing, [])

    def test_a_packed_file_is_alone_and_a_lone_level_has_no_variants(self):
        self.assertEqual({file.name for file in self.path.iterdir()}, {"oak.glb", "oak.usda", "oak.usdz", "oak_textures"})
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            treerec.grow("oak").write(folder / "bare.usdc", leaves="none")
            stage = Usd.Stage.Open(str(folder / "bare.usdc"))
            self.assertFalse(stage.GetDefaultPrim().HasVariantSets())
            self.assertTrue(stage.GetPrimAtPath("/Tree/Bark"))
            self.assertFalse(stage.GetPrimAtPath("/Tree/Leaves"))

    def test_the_module_converts(self):
        with tempfile.TemporaryDirectory() as name:
            out = os.path.join(name, "tree.usdz")
            words = [sys.executable, "-m", "treerec", str(self.path / "oak.glb"), out]
            done = subprocess.run(words, capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            stage = Usd.Stage.Open(out)
            self.assertTrue(stage.GetPrimAtPath("/Tree/Leaves"))
            self.assertEqual(subprocess.run(words[:-1], capture_output=True).returncode, 1)

    def test_bad_input_gets_a_sentence(self):
        data = (self.path / "oak.glb").read_bytes()
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            target = folder / "out.usdz"
            for words, content in (
                ("no binary glTF", b"glTF"),
                ("no binary glTF", data[4:]),
                ("is cut off", data[: len(data) // 2]),
                ("its JSON can't be read", data[:20] + b"}" + data[21:]),
                ("lie beyond its end", data[: 20 + int.from_bytes(data[12:16], "little")]),
                ("not a model of treerec", data.replace(b"Tree_LOD0", b"Tree_LODx")),
            ):
                with self.subTest(words):
                    (folder / "bad.glb").write_bytes(content)
                    self.assertIn(words, self.failure(folder / "bad.glb", target))
            self.assertIn("could not be read", self.failure(folder / "none.glb", target))
            self.assertIn("doesn't end in", self.failure(self.path / "oak.glb", folder / "out.obj"))
            self.assertIn("could not be written", self.failure(self.path / "oak.glb", folder / "none" / "out.usda"))
            self.assertEqual([file.name for file in folder.iterdir()], ["bad.glb"])

    def test_without_pixars_library_it_says_what_to_install(self):
        script = "import sys; sys.modules['pxr'] = None\nimport treerec\ntreerec.grow('oak').write('never.usdz')"
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, cwd=self.folder.name)
        self.assertIn("pip install usd-core", done.stderr)
        self.assertFalse((self.path / "never.usdz").exists())


if __name__ == "__main__":
    unittest.main()
