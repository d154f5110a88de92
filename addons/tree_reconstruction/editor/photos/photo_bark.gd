@tool
extends RefCounted
## The bark that photos gave, as a material of the project, and how their tree knows it.
##
## The material is one file with its pictures in it, compressed for video memory. Files of their own
## would have to be imported, which waits while the editor scans, and the folder that they were made
## in is kept out of the project; this one is there at once, and moves as one.

const Kinds := preload("../../nodes/leaf_kinds.gd")
const PhotoFolder := preload("photo_folder.gd")

## The pictures by the parameter of bark.gdshader that takes them.
const PICTURES: Dictionary[StringName, String] = {
	&"albedo_texture": "albedo.png",
	&"normal_texture": "normal.png",
	&"roughness_texture": "roughness.png",
}

# Metres: the radius of what has its own young bark.
const _TWIG: float = 0.015
const _KNOWN_AS: StringName = &"bark_material"


## The bark out of the pictures in [param folder] for a tree whose leaves look like those of the
## preset [param look]; [code]null[/code] where one of them can't be read. It takes seconds, and may
## run on a thread.
static func make(folder: String, look: String) -> ShaderMaterial:
	var preset: ShaderMaterial = load(Kinds.preset_path(look, "bark")) as ShaderMaterial
	var material: ShaderMaterial = preset.duplicate() as ShaderMaterial
	# The photos tell the colour.
	material.set_shader_parameter(&"tint", Color.WHITE)
	# And how old it is, and what grows on it: only twigs, which photos don't show, are drawn.
	material.set_shader_parameter(&"young_radius", _TWIG)
	material.set_shader_parameter(&"old_radius", 2.0 * _TWIG)
	material.set_shader_parameter(&"moss", 0.0)
	material.set_shader_parameter(&"lichen", 0.0)
	for parameter: StringName in PICTURES:
		var picture: Image = _read(folder.path_join(PICTURES[parameter]))
		if picture == null:
			return null
		var texture: PortableCompressedTexture2D = PortableCompressedTexture2D.new()
		texture.create_from_image(
			picture,
			PortableCompressedTexture2D.COMPRESSION_MODE_BASIS_UNIVERSAL,
			parameter == &"normal_texture"
		)
		material.set_shader_parameter(parameter, texture)
	return material


## Saves [param material] beside the tree's file under a name that no other file has.
static func save(material: ShaderMaterial, tree_path: String) -> Error:
	var path: String = free_path(tree_path)
	var error: Error = ResourceSaver.save(material, path, ResourceSaver.FLAG_COMPRESS)
	if error == OK:
		material.take_over_path(path)
	return error


## A name for the bark of the tree in [param tree_path], of a file that is not there yet.
static func free_path(tree_path: String) -> String:
	return PhotoFolder.free_path(tree_path.get_basename() + "_bark")


## Has [param tree] know its bark, in its file too; [code]null[/code] makes it forget.
static func give(tree: TreeReconstruction, material: Material) -> void:
	# As metadata, the engine follows it when it is moved.
	tree.set_meta(_KNOWN_AS, material)


## The bark that [param tree] knows, or [code]null[/code]: then it has that of its kind.
static func of(tree: TreeReconstruction) -> Material:
	return tree.get_meta(_KNOWN_AS) as Material if tree.has_meta(_KNOWN_AS) else null


static func _read(path: String) -> Image:
	var picture: Image = Image.new()
	# Image.load_from_file() warns of files of the project, since exported games don't have them.
	var bytes: PackedByteArray = FileAccess.get_file_as_bytes(path)
	if bytes.is_empty() or picture.load_png_from_buffer(bytes) != OK:
		return null
	return picture if picture.generate_mipmaps() == OK else null
