@tool
extends "../../test_plugin/garden.gd"
## The FileSystem dock's and the inspector's pictures of what the addon makes.

const SCAN: String = "res://pictured.ply"
const TREE: String = "res://pictured_tree.res"
const RULE: String = "res://addons/tree_reconstruction/presets/oak_rule.tres"
const LEAST_COLORS: int = 8

var _pictures: Dictionary = {}


func run() -> void:
	await step("trees, leaf rules, twigs and collections of twigs have pictures")
	await drop_file(sample, SCAN)
	var made: TreeReconstruction = await imported(SCAN)
	if made == null:
		return
	ResourceSaver.save(made.duplicate(), TREE)
	var library: TwigLibrary = TwigLibrary.presets()
	for twig: Twig in library.twigs:
		twig.thumbnail = null
	ResourceSaver.save(library.twigs[0], "res://twig.tres")
	ResourceSaver.save(library, "res://twigs.res")
	var paths: PackedStringArray = [SCAN, TREE, RULE, "res://twig.tres", "res://twigs.res"]
	var previewer: EditorResourcePreview = EditorInterface.get_resource_previewer()
	for path: String in paths:
		# The one that is kept may be older than the file.
		previewer.check_for_invalidation(path)
		previewer.queue_resource_preview(path, self, &"_on_picture", null)
		if await until(_has_picture.bind(path), path + " has a picture"):
			_check_picture(path)

	await step("what is not saved has a picture, too")
	var rule: LeafRule = LeafRule.new()
	_pictures.clear()
	previewer.queue_edited_resource_preview(rule, self, &"_on_picture", "rule")
	previewer.queue_edited_resource_preview(library.twigs[1], self, &"_on_picture", "twig")
	for key: String in ["rule", "twig"]:
		if await until(_has_picture.bind(key), key + " has a picture"):
			_check_picture(key)

	await step("other resources keep their own")
	ResourceSaver.save(Gradient.new(), "res://gradient.tres")
	previewer.queue_resource_preview("res://gradient.tres", self, &"_on_picture", null)
	if await until(_has_picture.bind("res://gradient.tres"), "the gradient was looked at"):
		check(_pictures["res://gradient.tres"] != null, "A gradient has no picture any more.")


func _on_picture(path: String, preview: Texture2D, _small: Texture2D, key: Variant) -> void:
	_pictures[path if key == null else key] = preview


func _has_picture(key: String) -> bool:
	return _pictures.has(key)


func _check_picture(key: String) -> void:
	var texture: Texture2D = _pictures[key]
	if not check(texture != null, "%s has no picture." % key):
		return
	var image: Image = texture.get_image()
	var colors: Dictionary[Color, bool] = {}
	for y: int in image.get_height():
		for x: int in image.get_width():
			colors[image.get_pixel(x, y)] = true
	check(colors.size() >= LEAST_COLORS, "%s has an empty picture." % key)
