extends SceneTree
## A trunk that swallows a fence post and its wire, step by step:
##
##     godot --path project --script tests/captures/bark_film.gd -- TREE FOLDER [LEAVES]
##
## TREE: a skeleton. LEAVES: the preset whose bark the tree has. FOLDER gets the pictures 0000.png
## and so on; make_captures.sh makes a film of them.

const BuildJob := preload("res://addons/tree_reconstruction/nodes/tree_build_job.gd")
const Recipe := preload("res://addons/tree_reconstruction/editor/dock/growth_recipe.gd")
const Stage := preload("sketch_stage.gd")
const Things := preload("bark_things.gd")
const _SIZE: Vector2i = Vector2i(360, 480)
const _SUPERSAMPLING: int = 2
const _PRESET: String = "fence_post_swallowed"
const _EDGES: String = "edges longest=0.045\n"
const _FRAMES: int = 84
# The result is looked at for a while.
const _LAST: int = 14
# Radians that the camera goes about the tree meanwhile, and where it begins, from the post.
const _TURN: float = -0.45
const _BEGIN: float = 0.95
# Of the height at which the highest feature stands.
const _HEADROOM: float = 1.45

var _stage: Stage = Stage.new(_SIZE * _SUPERSAMPLING, 60.0)
var _folder: String
var _count: int = 0


func _initialize() -> void:
	_film.call_deferred()


func _film() -> void:
	var arguments: PackedStringArray = OS.get_cmdline_user_args()
	_folder = arguments[1]
	var maker: TreeReconstructor = TreeReconstructor.new()
	var tree: TreeReconstruction = maker.import_skeleton(arguments[0])
	var recipe: String = ""
	var grown: TreeReconstruction = null
	if tree != null:
		tree.leaf_preset = arguments[2] if arguments.size() > 2 else "oak"
		recipe = TreeReconstructor.scale_growth_preset(_PRESET, tree) + _EDGES
		grown = maker.grow_bark(tree, recipe, true)
	if grown == null:
		push_error(maker.get_error_message())
		quit(1)
		return
	root.add_child(_stage)
	_stage.shown.leaves = false
	_stage.shown.reconstruction = grown
	await _stage.shown.rebuilt
	var look: Material = _stage.shown.get_active_material(0)
	# Its place is the tree's, and its own mesh is drawn by the stages of the growth.
	var trunk: MeshInstance3D = MeshInstance3D.new()
	_stage.shown.add_child(trunk)
	_stage.shown.mesh = null
	var places: Array[Dictionary] = maker.find_bark(tree, recipe)
	var lines: Array[Recipe.Line] = Recipe.new(recipe).lines
	var out: Vector3 = Vector3.ZERO
	var height: float = 0.0
	for i: int in lines.size():
		if lines[i].command == "obstacle":
			_stage.shown.add_child(Things.make(lines[i], places[i]))
			out += places[i].out
			height = maxf(height, (places[i].along as float) * _HEADROOM)
	_stage.camera.size = height
	var frames: Array[Dictionary] = maker.get_growth_frames()
	for i: int in _FRAMES + _LAST:
		var at: int = mini(roundi((frames.size() - 1.0) * (i + 1.0) / _FRAMES), frames.size() - 1)
		trunk.mesh = BuildJob.bark_mesh(TreeReconstructor.draw_grown_bark(tree, frames[at].bark))
		trunk.material_override = look
		var turn: float = _BEGIN + _TURN * i / (_FRAMES + _LAST)
		var basis: Basis = Basis(Vector3.UP, -atan2(out.x, out.z) - turn)
		_stage.shown.transform = Transform3D(
			basis, basis * -tree.get_node_position(tree.get_root())
		)
		await _keep(height)
	quit()


func _keep(height: float) -> void:
	var middle: Vector3 = Vector3(0.0, 0.46 * height, 0.0)
	_stage.camera.look_at_from_position(
		middle + 50.0 * Vector3(0.0, 0.12, 1.0).normalized(), middle
	)
	_stage.render_target_update_mode = SubViewport.UPDATE_ONCE
	await RenderingServer.frame_post_draw
	var picture: Image = _stage.get_texture().get_image()
	picture.resize(_SIZE.x, _SIZE.y, Image.INTERPOLATE_LANCZOS)
	picture.convert(Image.FORMAT_RGB8)
	picture.save_png(_folder.path_join("%04d.png" % _count))
	_count += 1
