@tool
extends RefCounted
## Copies of the addon's materials that need no file of the addon.

const _ADDON: String = "res://addons/tree_reconstruction/"
const _QUALITY: float = 0.9
# What baked trees do without: it is the editor's.
const _REST: String = "tree_wind_rest.gdshaderinc"
const _PICTURES: Array[StringName] = [
	&"albedo_texture",
	&"normal_texture",
	&"roughness_texture",
	&"young_albedo_texture",
	&"young_normal_texture",
	&"young_roughness_texture",
]


## Copies of those of [param material]'s pictures that are the addon's and have a source, by their
## paths. They take the longest by far to make, and this may run on any thread.
static func plain_pictures(material: Material) -> Dictionary[String, Texture2D]:
	var made: Dictionary[String, Texture2D] = {}
	var shaded: ShaderMaterial = material as ShaderMaterial
	if shaded == null:
		return made
	for name: StringName in _PICTURES:
		var texture: Texture2D = shaded.get_shader_parameter(name) as Texture2D
		if texture == null or not is_addon_file(texture):
			continue
		var image: Image = _source_of(texture)
		if image != null:
			made[texture.resource_path] = _packed(texture, image, "normal" in String(name))
	return made


## Whether [param material] has one of the addon's shaders.
static func is_addons(material: Material) -> bool:
	var shaded: ShaderMaterial = material as ShaderMaterial
	return shaded != null and shaded.shader != null and is_addon_file(shaded.shader)


## A copy of [param material] with its shader and textures in itself, and with [param values] set
## where its shader has them. A material that has nothing of the addon is returned as it is.
## [param pictures] are those of [method plain_pictures]. [param joined] is whether the leaves are
## one mesh, or the instances of a multimesh. With [param global_wind] its wind is that of the
## project's shader globals, which must be there then.
static func plain(
	material: Material,
	values: Dictionary[StringName, Variant],
	pictures: Dictionary[String, Texture2D],
	joined: bool = true,
	global_wind: bool = false
) -> Material:
	if not is_addons(material):
		return material
	var shaded: ShaderMaterial = material as ShaderMaterial
	var made: ShaderMaterial = ShaderMaterial.new()
	made.resource_name = material.resource_path.get_file().get_basename()
	made.shader = Shader.new()
	made.shader.code = code_of(shaded.shader, joined, global_wind)
	for uniform: Dictionary in shaded.shader.get_shader_uniform_list():
		var value: Variant = shaded.get_shader_parameter(uniform.name)
		if value is Texture2D and is_addon_file(value):
			var path: String = (value as Texture2D).resource_path
			value = (
				pictures[path]
				if pictures.has(path)
				else plain_texture(value, "normal" in String(uniform.name))
			)
		if value != null:
			made.set_shader_parameter(uniform.name, value)
	for name: StringName in values:
		made.set_shader_parameter(name, values[name])
	return made


## The code of [param shader] with all that it includes, for a tree without a [TreeInstance3D]. With
## [param own] what is set per tree is the material's in any case.
static func code_of(shader: Shader, joined: bool, global_wind: bool, own: bool = false) -> String:
	var include: RegEx = RegEx.create_from_string('#include\\s+"([^"]+)"')
	var code: String = shader.code
	var found: RegExMatch = include.search(code)
	while found != null:
		var path: String = found.get_string(1)
		if not path.begins_with("res://"):
			path = shader.resource_path.get_base_dir().path_join(path)
		var included: String = "" if path.ends_with(_REST) else (load(path) as ShaderInclude).code
		code = code.left(found.get_start()) + included + code.substr(found.get_end())
		found = include.search(code)
	var type: RegEx = RegEx.create_from_string("shader_type\\s+\\w+\\s*;")
	var end: int = type.search(code).get_end()
	var defines: String = "\n#define TREE_BAKED\n" if joined else "\n"
	if own and not joined:
		defines += "#define TREE_OWN\n"
	defines += "#define TREE_WIND_%s\n" % ("GLOBALS" if global_wind else "LOCAL")
	return code.left(end) + defines + code.substr(end)


## A copy of [param texture], packed, that needs no file.
static func plain_texture(texture: Texture2D, is_normal: bool) -> Texture2D:
	var image: Image = _image_of(texture)
	return texture if image == null else _packed(texture, image, is_normal)


static func _packed(texture: Texture2D, image: Image, is_normal: bool) -> Texture2D:
	if not image.has_mipmaps():
		image.generate_mipmaps()
	var made: PortableCompressedTexture2D = PortableCompressedTexture2D.new()
	made.keep_compressed_buffer = true
	made.create_from_image(
		image,
		(
			PortableCompressedTexture2D.COMPRESSION_MODE_LOSSLESS
			if is_normal
			else PortableCompressedTexture2D.COMPRESSION_MODE_LOSSY
		),
		is_normal,
		_QUALITY
	)
	made.resource_name = texture.resource_path.get_file().get_basename()
	return made


static func _image_of(texture: Texture2D) -> Image:
	var image: Image = _source_of(texture)
	if image != null:
		return image
	image = texture.get_image()
	if image != null and image.is_compressed() and image.decompress() != OK:
		return null
	return image


# The picture that it was imported from, if that is there: what the graphics card has is less.
static func _source_of(texture: Texture2D) -> Image:
	var path: String = texture.resource_path
	if path.get_extension() not in ["png", "jpg"] or not FileAccess.file_exists(path):
		return null
	var source: Image = Image.new()
	var bytes: PackedByteArray = FileAccess.get_file_as_bytes(path)
	var failure: Error = (
		source.load_jpg_from_buffer(bytes)
		if path.ends_with(".jpg")
		else source.load_png_from_buffer(bytes)
	)
	return source if failure == OK else null


## Whether [param resource] is a file of the addon.
static func is_addon_file(resource: Resource) -> bool:
	return resource.resource_path.begins_with(_ADDON)
