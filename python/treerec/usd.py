"""Trees as OpenUSD, for Houdini, Blender, Omniverse, Maya and whatever else reads it.

    python3 -m treerec oak.glb oak.usdz

It is what the GLB has: bark and leaves, materials with pictures (UsdPreviewSurface), and levels of detail as the variants
of the set "LOD". Metres, Y up, the base at the origin. Pixar's own library writes it: `pip install treerec[usd]`, or
`usd-core`.
"""

from __future__ import annotations

import importlib
import os
import pathlib
import shutil
import tempfile
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from ._glb import Glb
from ._treerec import Error

_ENDINGS = (".usd", ".usda", ".usdc", ".usdz")
_PICTURES = "_textures"  # after the model's name


def is_usd(path: Union[str, os.PathLike[str]]) -> bool:
    """Whether a path's ending names a USD file."""
    return os.fspath(path).lower().endswith(_ENDINGS)


def convert(glb: Union[str, os.PathLike[str]], path: Union[str, os.PathLike[str]]) -> None:
    """Writes a GLB that treerec or its addon has written as .usd, .usda, .usdc or .usdz.

    The pictures of the first three lie beside it, in NAME_textures. The file is whole, or not there.
    """
    if not is_usd(path):
        raise Error("'%s' doesn't end in %s." % (os.fspath(path), ", ".join(_ENDINGS)))
    writer = _Writer(Glb(pathlib.Path(glb)))
    target = pathlib.Path(path)
    packed = target.suffix.lower() == ".usdz"
    try:
        with tempfile.TemporaryDirectory(prefix=target.stem, dir=target.parent) as name:
            folder = pathlib.Path(name)
            made = folder / (target.stem + ".usdc" if packed else target.name)
            writer.write(made)
            if packed:
                made = writer.pack(made, folder / target.name)
            else:
                pictures = target.stem + _PICTURES
                shutil.copytree(folder / pictures, target.parent / pictures, dirs_exist_ok=True)
            os.replace(made, target)
    except OSError as error:
        raise Error("'%s' could not be written: %s." % (target, error.strerror)) from error


def library() -> Any:
    """Pixar's, or throws Error where it isn't installed."""
    try:
        for part in ("Gf", "Kind", "Sdf", "Usd", "UsdGeom", "UsdShade", "Vt"):
            importlib.import_module("pxr." + part)
        return importlib.import_module("pxr")
    except ImportError as error:
        raise Error("USD needs Pixar's library; install it by 'pip install usd-core'.") from error


class _Writer:
    def __init__(self, glb: Glb) -> None:
        self._glb = glb
        self._pxr = library()

    def write(self, path: pathlib.Path) -> None:
        pxr = self._pxr
        pictures = path.parent / (path.stem + _PICTURES)
        pictures.mkdir()
        stage = pxr.Usd.Stage.CreateNew(str(path))
        pxr.UsdGeom.SetStageUpAxis(stage, pxr.UsdGeom.Tokens.y)
        pxr.UsdGeom.SetStageMetersPerUnit(stage, 1.0)
        root = pxr.UsdGeom.Xform.Define(stage, "/Tree")
        stage.SetDefaultPrim(root.GetPrim())
        pxr.Usd.ModelAPI(root).SetKind(pxr.Kind.Tokens.component)
        told = {name: value for name, value in self._glb.extras().items() if isinstance(value, (int, float, str))}
        root.GetPrim().SetCustomData({"treerec": told})
        materials = [
            self._material(stage, material, pictures) for material in self._glb.json.get("materials", [])
        ]
        levels = self._glb.levels()
        if len(levels) == 1:
            self._level(stage, levels[0], materials)
        else:
            variants = root.GetPrim().GetVariantSets().AddVariantSet("LOD")
            for number, level in enumerate(levels):
                variants.AddVariant("LOD%d" % number)
                variants.SetVariantSelection("LOD%d" % number)
                with variants.GetVariantEditContext():
                    self._level(stage, level, materials)
            variants.SetVariantSelection("LOD0")
        boxes = pxr.UsdGeom.BBoxCache(pxr.Usd.TimeCode.Default(), [pxr.UsdGeom.Tokens.default_])
        pxr.UsdGeom.ModelAPI.Apply(root.GetPrim())
        pxr.UsdGeom.ModelAPI(root).SetExtentsHint(pxr.UsdGeom.ModelAPI(root).ComputeExtentsHint(boxes))
        stage.GetRootLayer().Save()

    def pack(self, made: pathlib.Path, path: pathlib.Path) -> pathlib.Path:
        # The layer that is opened comes first; the pictures lie beside it as they do here.
        usd, sdf = self._pxr.Usd, self._pxr.Sdf
        maker = sdf.ZipFileWriter if hasattr(sdf, "ZipFileWriter") else usd.ZipFileWriter  # which has moved
        with maker.CreateNew(str(path)) as packed:
            for file in [made, *sorted((made.parent / (made.stem + _PICTURES)).iterdir())]:
                packed.AddFile(str(file), file.relative_to(made.parent).as_posix())
        return path

    def _level(self, stage: Any, level: dict[str, Any], materials: list[Any]) -> None:
        for primitive in level["primitives"]:
            material = materials[primitive["material"]]
            name = self._glb.json["materials"][primitive["material"]]["name"]
            mesh = self._pxr.UsdGeom.Mesh.Define(stage, "/Tree/" + name.capitalize())
            self._fill(mesh, primitive)
            self._pxr.UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(material)

    def _fill(self, mesh: Any, primitive: dict[str, Any]) -> None:
        geom, vt, types = self._pxr.UsdGeom, self._pxr.Vt, self._pxr.Sdf.ValueTypeNames
        values = {name: self._glb.values(accessor) for name, accessor in primitive["attributes"].items()}
        indices = self._glb.values(primitive["indices"]).astype(np.int32)
        points = values["POSITION"]
        mesh.CreateSubdivisionSchemeAttr(geom.Tokens.none)
        mesh.CreatePointsAttr(vt.Vec3fArray.FromNumpy(points))
        mesh.CreateFaceVertexCountsAttr(vt.IntArray.FromNumpy(np.full(len(indices) // 3, 3, np.int32)))
        mesh.CreateFaceVertexIndicesAttr(vt.IntArray.FromNumpy(indices))
        mesh.CreateExtentAttr(vt.Vec3fArray.FromNumpy(np.stack([points.min(0), points.max(0)])))
        mesh.CreateNormalsAttr(vt.Vec3fArray.FromNumpy(values["NORMAL"]))
        mesh.SetNormalsInterpolation(geom.Tokens.vertex)
        primvars = geom.PrimvarsAPI(mesh)

        def add(name: str, kind: Any, array: npt.NDArray[Any], maker: Any) -> None:
            primvars.CreatePrimvar(name, kind, geom.Tokens.vertex).Set(
                maker.FromNumpy(np.ascontiguousarray(array, np.float32))
            )

        # Texture coordinates begin at the bottom.
        add("st", types.TexCoord2fArray, values["TEXCOORD_0"] * [1.0, -1.0] + [0.0, 1.0], vt.Vec2fArray)
        if "_WIND" in values:
            add("wind", types.Float4Array, values["_WIND"], vt.Vec4fArray)
        if "COLOR_0" in values:
            add("displayColor", types.Color3fArray, values["COLOR_0"][:, :3], vt.Vec3fArray)

    def _material(self, stage: Any, told: dict[str, Any], pictures: pathlib.Path) -> Any:
        pxr, types = self._pxr, self._pxr.Sdf.ValueTypeNames
        path = "/Tree/Materials/" + told["name"].capitalize()
        pxr.UsdGeom.Scope.Define(stage, "/Tree/Materials")
        material = pxr.UsdShade.Material.Define(stage, path)
        surface = pxr.UsdShade.Shader.Define(stage, path + "/Surface")
        surface.CreateIdAttr("UsdPreviewSurface")
        material.CreateSurfaceOutput().ConnectToSource(surface.ConnectableAPI(), "surface")
        reader = pxr.UsdShade.Shader.Define(stage, path + "/Coordinates")
        reader.CreateIdAttr("UsdPrimvarReader_float2")
        reader.CreateInput("varname", types.String).Set("st")
        reader.CreateOutput("result", types.Float2)

        def picture(name: str, texture: int, space: str) -> Any:
            file, data = self._glb.picture(texture)
            (pictures / file).write_bytes(data)
            shader = pxr.UsdShade.Shader.Define(stage, path + "/" + name)
            shader.CreateIdAttr("UsdUVTexture")
            shader.CreateInput("file", types.Asset).Set(pictures.name + "/" + file)
            shader.CreateInput("sourceColorSpace", types.Token).Set(space)
            for axis in ("wrapS", "wrapT"):
                shader.CreateInput(axis, types.Token).Set("repeat" if self._glb.repeats(texture) else "clamp")
            shader.CreateInput("st", types.Float2).ConnectToSource(reader.ConnectableAPI(), "result")
            return shader

        def connect(name: str, kind: Any, shader: Any, output: str, output_kind: Any) -> None:
            shader.CreateOutput(output, output_kind)
            surface.CreateInput(name, kind).ConnectToSource(shader.ConnectableAPI(), output)

        metal = told["pbrMetallicRoughness"]
        albedo = picture("Albedo", metal["baseColorTexture"]["index"], "sRGB")
        albedo.CreateInput("scale", types.Float4).Set(pxr.Gf.Vec4f(*metal.get("baseColorFactor", [1.0] * 4)))
        connect("diffuseColor", types.Color3f, albedo, "rgb", types.Float3)
        surface.CreateInput("metallic", types.Float).Set(0.0)
        if told.get("alphaMode") == "MASK":
            connect("opacity", types.Float, albedo, "a", types.Float)
            surface.CreateInput("opacityThreshold", types.Float).Set(told.get("alphaCutoff", 0.5))
        normal = picture("Normal", told["normalTexture"]["index"], "raw")
        normal.CreateInput("scale", types.Float4).Set(pxr.Gf.Vec4f(2.0, 2.0, 2.0, 1.0))
        normal.CreateInput("bias", types.Float4).Set(pxr.Gf.Vec4f(-1.0, -1.0, -1.0, 0.0))
        connect("normal", types.Normal3f, normal, "rgb", types.Float3)
        if "metallicRoughnessTexture" in metal:
            rough = picture("Roughness", metal["metallicRoughnessTexture"]["index"], "raw")
            connect("roughness", types.Float, rough, "g", types.Float)
            connect("occlusion", types.Float, rough, "r", types.Float)
        else:
            surface.CreateInput("roughness", types.Float).Set(metal.get("roughnessFactor", 1.0))
        return material
