@tool
extends EditorResourcePreviewGenerator
## Draws the pictures of trees, twigs, collections of twigs and leaf rules in the FileSystem dock
## and the inspector.

const _SCRIPTS: PackedStringArray = ["/resources/twig.gd", "/resources/twig_library.gd"]
const _NATIVE: PackedStringArray = ["TreeReconstruction", "LeafRule"]
const _PRESETS: String = "res://addons/tree_reconstruction/presets/%s_%s.tres"
const _SMALLEST: int = 16
const _LARGEST: int = 512
# How many twigs are shown of a collection.
const _SHOWN: int = 4

## Whether this one draws the resources that have a script. The engine tells a generator nothing
## about a file but its path, so that there are two of them: this one looks which script it is.
var of_scripts: bool = false


func _handles(type: String) -> bool:
	return type == "Resource" if of_scripts else type in _NATIVE


func _can_generate_small_preview() -> bool:
	return true


func _generate_small_preview_automatically() -> bool:
	return true


func _generate_from_path(path: String, size: Vector2i, metadata: Dictionary) -> Texture2D:
	if of_scripts and not _has_our_script(path):
		return null
	var resource: Resource = ResourceLoader.load(path)
	if resource == null:
		return null
	var picture: Texture2D = _generate(resource, size, metadata)
	# This is the engine's thread of pictures. Were it the last to let go of the resource, it would
	# take it off the signals of others while the main thread may be emitting them.
	_let_go.call_deferred(resource)
	return picture


func _let_go(_resource: Resource) -> void:
	pass


func _generate(resource: Resource, size: Vector2i, _metadata: Dictionary) -> Texture2D:
	var edge: int = clampi(mini(size.x, size.y), _SMALLEST, _LARGEST)
	var image: Image = null
	if resource is TreeReconstruction:
		image = _of_tree(resource as TreeReconstruction, edge)
	elif resource is Twig:
		image = _of_branch((resource as Twig).get_string(), edge)
	elif resource is TwigLibrary:
		image = _of_library(resource as TwigLibrary, edge)
	elif resource is LeafRule:
		image = _of_leaf(resource as LeafRule, edge)
	return null if image == null else ImageTexture.create_from_image(image)


# Without loading it: all resources with scripts come by.
static func _has_our_script(path: String) -> bool:
	for dependency: String in ResourceLoader.get_dependencies(path):
		for script: String in _SCRIPTS:
			if dependency.ends_with(script):
				return true
	return false


static func _of_tree(tree: TreeReconstruction, edge: int) -> Image:
	if tree.get_node_count() < 2:
		return null
	return _of_pixels(tree.draw(edge), edge)


static func _of_branch(lstring: String, edge: int) -> Image:
	if lstring.is_empty():
		return null
	return _of_pixels(TreeReconstruction.draw_branch(lstring, edge), edge)


static func _of_pixels(pixels: PackedByteArray, edge: int) -> Image:
	if pixels.is_empty():
		return null
	return Image.create_from_data(edge, edge, false, Image.FORMAT_RGBA8, pixels)


# The first ones, two by two.
static func _of_library(library: TwigLibrary, edge: int) -> Image:
	@warning_ignore("integer_division")
	var half: int = maxi(edge / 2, _SMALLEST)
	var image: Image = Image.create_empty(2 * half, 2 * half, false, Image.FORMAT_RGBA8)
	var shown: int = 0
	for twig: Twig in library.twigs:
		if shown == _SHOWN:
			break
		var part: Image = null if twig == null else _of_branch(twig.get_string(), half)
		if part == null:
			continue
		@warning_ignore("integer_division")
		var cell: Vector2i = Vector2i(shown % 2, shown / 2) * half
		image.blit_rect(part, Rect2i(Vector2i.ZERO, part.get_size()), cell)
		shown += 1
	return null if shown == 0 else image


# The picture of one leaf, or of one spray.
static func _of_leaf(rule: LeafRule, edge: int) -> Image:
	var part: String = "leaf" if rule.form == LeafRule.FORM_SPRAY else "blade"
	var path: String = _PRESETS % [rule.look, part]
	if not ResourceLoader.exists(path):
		path = _PRESETS % ["generic", part]
	var material: ShaderMaterial = load(path) as ShaderMaterial
	var texture: Texture2D = (
		null if material == null else material.get_shader_parameter(&"albedo_texture")
	)
	var image: Image = null if texture == null else texture.get_image()
	if image == null:
		return null
	image = image.duplicate() as Image
	if image.is_compressed() and image.decompress() != OK:
		return null
	image.clear_mipmaps()
	image.convert(Image.FORMAT_RGBA8)
	var many: Variant = material.get_shader_parameter(&"picture_sprays")
	if many is Vector2i:
		image.crop(
			image.get_width() / (many as Vector2i).x, image.get_height() / (many as Vector2i).y
		)
	var scale: float = float(edge) / maxi(image.get_width(), image.get_height())
	image.resize(
		maxi(int(image.get_width() * scale), 1),
		maxi(int(image.get_height() * scale), 1),
		Image.INTERPOLATE_LANCZOS
	)
	return image
