extends SceneTree
## Draws trunks with the presets of growing bark, and the posts and wires that they swallow:
##
##     godot --path project --script tests/captures/barks.gd -- TREE PICTURE [LEAVES [PRESET…]]
##
## TREE: a skeleton. LEAVES: the preset whose bark the tree has; PRESETs: all, if none is named.
## One that ends with .recipe is a file; those of Mizoguchi and Miyata 2014 are in paper/, for
## paper/trunk.swc.

const Recipe := preload("res://addons/tree_reconstruction/editor/dock/growth_recipe.gd")
const Stage := preload("sketch_stage.gd")
const Things := preload("bark_things.gd")
const _SIZE: Vector2i = Vector2i(420, 640)
const _SUPERSAMPLING: int = 2
const _COLUMNS: int = 6
# Of the height at which the highest feature stands, that a picture shows.
const _HEADROOM: float = 1.3
# Radians that a tree is turned away from where its features face the camera.
const _ASIDE: float = 0.45

var _stage: Stage = Stage.new(_SIZE * _SUPERSAMPLING, 60.0)
var _things: Array[MeshInstance3D] = []


func _initialize() -> void:
	_draw.call_deferred()


func _draw() -> void:
	var arguments: PackedStringArray = OS.get_cmdline_user_args()
	var maker: TreeReconstructor = TreeReconstructor.new()
	var tree: TreeReconstruction = maker.import_skeleton(arguments[0])
	if tree == null:
		_end(maker.get_error_message())
		return
	tree.leaf_preset = arguments[2] if arguments.size() > 2 else "oak"
	var presets: PackedStringArray = arguments.slice(3)
	if presets.is_empty():
		for preset: Dictionary in TreeReconstructor.get_growth_presets():
			presets.append(preset.name)
	root.add_child(_stage)
	await process_frame
	var columns: int = ceili(presets.size() / ceilf(presets.size() / float(_COLUMNS)))
	var sheet: Image = Image.create_empty(
		_SIZE.x * columns,
		_SIZE.y * ceili(presets.size() / float(columns)),
		false,
		Image.FORMAT_RGB8
	)
	for i: int in presets.size():
		var recipe: String = (
			FileAccess.get_file_as_string(presets[i])
			if presets[i].ends_with(".recipe")
			else TreeReconstructor.scale_growth_preset(presets[i], tree)
		)
		var grown: TreeReconstruction = maker.grow_bark(tree, recipe)
		if grown == null:
			_end(maker.get_error_message())
			return
		_stage.shown.reconstruction = grown
		await _stage.shown.rebuilt
		sheet.blit_rect(
			await _look(tree, recipe, maker.find_bark(tree, recipe)),
			Rect2i(Vector2i.ZERO, _SIZE),
			Vector2i(i % columns, i / columns) * _SIZE
		)
		print(presets[i])
	if arguments[1].get_extension() == "jpg":
		sheet.save_jpg(arguments[1], 0.9)
	else:
		sheet.save_png(arguments[1])
	quit()


func _end(error: String) -> void:
	push_error(error)
	quit(1)


# From where its features are seen.
func _look(tree: TreeReconstruction, recipe: String, places: Array[Dictionary]) -> Image:
	var out: Vector3 = Vector3.ZERO
	var highest: float = 0.0
	for thing: MeshInstance3D in _things:
		thing.free()
	_things.clear()
	var lines: Array[Recipe.Line] = Recipe.new(recipe).lines
	for i: int in places.size():
		var place: Dictionary = places[i]
		if place.is_empty():
			continue
		out += place.out
		highest = maxf(highest, place.along)
		if i < lines.size() and lines[i].command == "obstacle":
			_things.append(Things.make(lines[i], place))
			_stage.shown.add_child(_things.back())
	out = Vector3(out.x, 0.0, out.z).normalized() if out.length() > 0.3 else Vector3.BACK
	# Turned to the camera and the sun; a little aside and from above, so that lumps stand out.
	var turn: Basis = Basis(Vector3.UP, -atan2(out.x, out.z) - _ASIDE)
	_stage.shown.transform = Transform3D(turn, turn * -tree.get_node_position(tree.get_root()))
	var height: float = highest * _HEADROOM
	_stage.camera.size = height
	var middle: Vector3 = Vector3(0.0, 0.46 * height, 0.0)
	_stage.camera.look_at_from_position(
		middle + 50.0 * Vector3(0.0, 0.12, 1.0).normalized(), middle
	)
	_stage.render_target_update_mode = SubViewport.UPDATE_ONCE
	await RenderingServer.frame_post_draw
	var picture: Image = _stage.get_texture().get_image()
	picture.resize(_SIZE.x, _SIZE.y, Image.INTERPOLATE_LANCZOS)
	picture.convert(Image.FORMAT_RGB8)
	return picture
