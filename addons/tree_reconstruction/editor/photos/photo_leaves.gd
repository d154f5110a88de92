@tool
extends RefCounted
## The colors that photos gave a tree's leaves, as a material of the project, and how their tree
## knows it.
##
## The material shows the drawn picture of the tree's kind of leaves, multiplied so that a crown has
## the measured mean, its hues and their course over height. It keeps what was measured, so that
## another kind of leaves gets the same colors.

const Kinds := preload("../../nodes/leaf_kinds.gd")
const PhotoFolder := preload("photo_folder.gd")

const _KNOWN_AS: StringName = &"leaf_material"
const _COLORS: StringName = &"leaf_colors"
const _LOOK: StringName = &"leaf_look"
# How far the leaf that is the least green goes towards the color of such leaves.
const _VARIATION: float = 0.8
# The mean of the leaves' hues (INSTANCE_CUSTOM.z).
const _MEAN_HUE: float = 0.5
# Light that went through a leaf has more of its color.
const _THROUGH: float = 1.5
const _LUMINANCE: Vector3 = Vector3(0.2126, 0.7152, 0.0722)
# The shader's own lightness of stored colors.
const _LIGHTNESS: Vector3 = Vector3(0.299, 0.587, 0.114)


## A material with [param colors], the report's [code]leaf_colors[/code], for the leaves of
## [param tree]; [code]null[/code] where their picture can't be read.
static func make(colors: Dictionary, tree: TreeReconstruction) -> ShaderMaterial:
	var material: ShaderMaterial = ShaderMaterial.new()
	material.set_meta(_COLORS, colors)
	return material if suit(material, tree) else null


## Whether [param material] has colors of photos.
static func is_made(material: Material) -> bool:
	return material is ShaderMaterial and material.has_meta(_COLORS)


## Whether [param material] shows leaves of another kind than [param tree] bears.
static func is_outdated(material: Material, tree: TreeReconstruction) -> bool:
	return is_made(material) and material.get_meta(_LOOK, "") != _look_of(tree)


## Has [param material] show the leaves that [param tree] bears now, in the colors that it has;
## [code]false[/code] where their picture can't be read.
static func suit(material: ShaderMaterial, tree: TreeReconstruction) -> bool:
	var look: String = _look_of(tree)
	var preset: ShaderMaterial = load(look) as ShaderMaterial
	var pixels: PackedByteArray = _pixels(
		preset.get_shader_parameter(&"albedo_texture") as Texture2D
	)
	if pixels.is_empty():
		return false
	material.shader = preset.shader
	for uniform: Dictionary in preset.shader.get_shader_uniform_list():
		var value: Variant = preset.get_shader_parameter(uniform.name)
		material.set_shader_parameter(uniform.name, value)
	var values: Dictionary[StringName, Variant] = _values(material.get_meta(_COLORS), pixels, tree)
	for name: StringName in values:
		material.set_shader_parameter(name, values[name])
	material.set_meta(_LOOK, look)
	return true


## Whether [param material] has a file of its own.
static func is_file(material: Material) -> bool:
	return material.resource_path.begins_with("res://") and "::" not in material.resource_path


## Saves [param material] beside the tree's file under a name that no other file has.
static func save(material: ShaderMaterial, tree_path: String) -> Error:
	var path: String = free_path(tree_path)
	var error: Error = ResourceSaver.save(material, path)
	if error == OK:
		material.take_over_path(path)
	return error


## A name for the leaves of the tree in [param tree_path], of a file that is not there yet.
static func free_path(tree_path: String) -> String:
	return PhotoFolder.free_path(tree_path.get_basename() + "_leaves")


## Has [param tree] know its leaves' material, in its file too; [code]null[/code] makes it forget.
static func give(tree: TreeReconstruction, material: Material) -> void:
	# As metadata, the engine follows it when it is moved.
	tree.set_meta(_KNOWN_AS, material)


## The material that [param tree] knows, or [code]null[/code]: then it has that of its kind.
static func of(tree: TreeReconstruction) -> Material:
	return tree.get_meta(_KNOWN_AS) as Material if tree.has_meta(_KNOWN_AS) else null


static func _look_of(tree: TreeReconstruction) -> String:
	return Kinds.material_path(tree.get_leaf_kinds()[0])


static func _values(
	colors: Dictionary, pixels: PackedByteArray, tree: TreeReconstruction
) -> Dictionary[StringName, Variant]:
	var albedo: Vector3 = _vector(colors["albedo"])
	var mean: Vector3 = _stored(albedo)
	# Leaves turn from the picture's color towards this one, and keep their lightness: the picture
	# is by so much greener that the mean is the measured one.
	var towards: Vector3 = _stored(_vector(colors["least_green"]))
	towards *= mean.dot(_LIGHTNESS) / towards.dot(_LIGHTNESS)
	var turned: float = _VARIATION * _MEAN_HUE
	var own: Vector3 = (mean - turned * towards) / (1.0 - turned)
	own = own.clamp(0.3 * mean, 2.0 * mean)
	var values: Dictionary[StringName, Variant] = {
		&"tint": Color.WHITE,
		&"saturation": 1.0,
		&"variation_color": Color(towards.x, towards.y, towards.z, _VARIATION),
		&"picture_gain": TreeReconstructor.get_picture_gain(pixels, _light(own)),
		&"low_gain": _stored(albedo * _vector(colors["low"])) / mean,
		&"high_gain": _stored(albedo * _vector(colors["high"])) / mean,
	}
	var height: float = maxf(tree.get_aabb().end.y, 0.1)
	values[&"gain_heights"] = Vector2(colors["low_height_m"], colors["high_height_m"]) / height
	# As light as the drawn leaves let it through.
	var through: Vector3 = albedo / albedo.dot(_LUMINANCE)
	for axis: int in 3:
		through[axis] = pow(through[axis], _THROUGH)
	var usual: Color = Color(0.42, 0.55, 0.12).srgb_to_linear()
	through *= Vector3(usual.r, usual.g, usual.b).dot(_LUMINANCE) / through.dot(_LUMINANCE)
	through = _stored(through).clampf(0.0, 1.0)
	values[&"transmission"] = Color(through.x, through.y, through.z)
	return values


# As get_picture_gain() takes them; none where the picture can't be read.
static func _pixels(texture: Texture2D) -> PackedByteArray:
	var image: Image = null if texture == null else texture.get_image()
	if image == null or (image.is_compressed() and image.decompress() != OK):
		return PackedByteArray()
	image.clear_mipmaps()
	image.convert(Image.FORMAT_RGBA8)
	return image.get_data()


static func _light(stored: Vector3) -> Vector3:
	var light: Color = Color(stored.x, stored.y, stored.z).srgb_to_linear()
	return Vector3(light.r, light.g, light.b)


static func _stored(light: Vector3) -> Vector3:
	var stored: Color = Color(light.x, light.y, light.z).linear_to_srgb()
	return Vector3(stored.r, stored.g, stored.b)


static func _vector(numbers: Array) -> Vector3:
	return Vector3(numbers[0], numbers[1], numbers[2])
