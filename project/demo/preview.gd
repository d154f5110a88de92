extends SceneTree
## Reconstructs a scan inside the engine, saves the tree as a scene and as models and draws its
## stages and its four sides. Needs a window (xvfb-run will do):
##
##     godot --path project --script res://demo/preview.gd -- --scan FILE --out FOLDER
##         [--title TEXT] [options of 'treerec reconstruct']
##
## It writes res://demo/result/tree.tscn and points.res (the scan, in the tree's space), and in
## FOLDER tree.glb, tree.obj, report.json and preview.png. What a user should read begins with "> ".

const Plots: GDScript = preload("./plots.gd")
const Sheet: GDScript = preload("./sheet.gd")
const Studio: GDScript = preload("./studio.gd")

const _SCENE: String = "res://demo/result/tree.tscn"
const _POINTS: String = "res://demo/result/points.res"
const _WIDTH: int = 2000
const _STAGE_HEIGHT: int = 600
const _VIEW_HEIGHT: int = 640
const _BREAST_HEIGHT: float = 1.3
const _YAWS: Array[float] = [PI / 2, 0.0, -PI / 2, PI]
const _VIEW_NAMES: Array[String] = ["+X", "+Z", "−X", "−Z"]

# The reconstructor's options by their names on the command line, and the switches.
const _OPTIONS: Dictionary[String, String] = {
	"--seed": "seed",
	"--leaves": "leaves",
	"--up": "up",
	"--scale": "scale",
	"--height": "known_height",
	"--length": "known_length",
	"--tree": "tree_number",
	"--tree-at": "tree_position",
	"--spacing": "spacing",
	"--columns": "columns",
}
const _SWITCHES: Dictionary[String, Array] = {
	"--no-clean": ["remove_extreme_colors", "remove_outliers", "remove_fragments", "remove_ground"],
	"--no-clean-colors": ["remove_extreme_colors"],
	"--no-clean-outliers": ["remove_outliers"],
	"--no-clean-fragments": ["remove_fragments"],
	"--no-clean-ground": ["remove_ground"],
	"--one-tree": ["separate_trees"],
	"--all-wood": ["tell_leaves"],
	"--quiet": [],
}

var _arguments: Dictionary[String, String] = {
	"--scan": "", "--out": "", "--title": "", "--threads": ""
}
var _options: Dictionary[String, Variant] = {}
var _reconstructor: TreeReconstructor
var _tree: TreeReconstruction
var _started: int


func _initialize() -> void:
	_run.call_deferred()


func _run() -> void:
	_started = Time.get_ticks_msec()
	quit(0 if await _work() else 1)


func _work() -> bool:
	if not _read_arguments():
		return false
	_reconstructor = TreeReconstructor.new()
	_tree = _reconstructor.reconstruct_file(_arguments["--scan"], _options)
	if _tree == null:
		printerr(_reconstructor.get_error_message())
		return false
	_say("reconstructed")
	DirAccess.make_dir_recursive_absolute(_arguments["--out"])
	var instance: TreeInstance3D = TreeInstance3D.new()
	TreeInstance3D.threaded = false
	instance.name = "Tree"
	instance.reconstruction = _tree
	if not _save_scene(instance) or not _save_files():
		return false
	_say("saved the scene and the models")
	await instance.rebuilt
	_say("built")
	var saved: bool = await _draw(instance)
	_say("drawn")
	print("> ", _heading(_tree.measure(), instance))
	return saved


func _read_arguments() -> bool:
	var given: PackedStringArray = OS.get_cmdline_user_args()
	var i: int = 0
	while i < given.size():
		var name: String = given[i]
		i += 1
		if _SWITCHES.has(name):
			for option: String in _SWITCHES[name]:
				_options[option] = false
			continue
		if i == given.size() or not (_arguments.has(name) or _OPTIONS.has(name)):
			printerr("preview.gd: unknown option or no value: %s" % name)
			return false
		var value: String = given[i]
		i += 1
		if _arguments.has(name):
			_arguments[name] = value
		elif name in ["--seed", "--tree"]:
			_options[_OPTIONS[name]] = value.to_int()
		elif name in ["--scale", "--height", "--spacing"]:
			_options[_OPTIONS[name]] = value.to_float()
		elif name in ["--length", "--tree-at"]:
			_options[_OPTIONS[name]] = PackedFloat64Array(value.split_floats(","))
		else:
			_options[_OPTIONS[name]] = value
	if _arguments["--scan"].is_empty() or _arguments["--out"].is_empty():
		printerr("preview.gd: --scan FILE and --out FOLDER are needed.")
		return false
	return true


func _save_scene(instance: TreeInstance3D) -> bool:
	var scene: PackedScene = PackedScene.new()
	var error: Error = scene.pack(instance)
	DirAccess.make_dir_recursive_absolute(_SCENE.get_base_dir())
	if error == OK:
		error = ResourceSaver.save(scene, _SCENE)
	if error != OK:
		printerr("Could not save %s: %s." % [_SCENE, error_string(error)])
		return false
	var points: ArrayMesh = Plots.cloud(
		_reconstructor.get_cloud_points(), _reconstructor.get_cloud_colors()
	)
	error = ResourceSaver.save(points, _POINTS, ResourceSaver.FLAG_COMPRESS)
	if error != OK:
		printerr("Could not save %s: %s." % [_POINTS, error_string(error)])
	return error == OK


func _save_files() -> bool:
	for name: String in ["tree.glb", "tree.obj"]:
		if _reconstructor.export_file(_tree, _arguments["--out"].path_join(name)) != OK:
			printerr(_reconstructor.get_error_message())
			return false
	var path: String = _arguments["--out"].path_join("report.json")
	var file: FileAccess = FileAccess.open(path, FileAccess.WRITE)
	if file == null or not file.store_string(_reconstructor.get_report_json()):
		printerr("Could not write %s." % path)
		return false
	for warning: String in _reconstructor.get_report()["warnings"]:
		print("> Warning: ", warning)
	return true


func _draw(instance: TreeInstance3D) -> bool:
	var sheet: Sheet = Sheet.new(_WIDTH)
	var stage_size: Vector2i = Vector2i(sheet.cell_width(5), _STAGE_HEIGHT)
	var view_size: Vector2i = Vector2i(sheet.cell_width(4), _VIEW_HEIGHT)
	var cloud: PackedVector3Array = _reconstructor.get_cloud_points()
	var raw: TreeReconstruction = _reconstructor.get_raw_skeleton()
	var everything: PackedVector3Array = cloud.duplicate()
	everything.append_array(_leaf_places(instance))
	everything.append_array(_tree.get_positions())
	var views: Studio.Framing = Studio.frame(everything, view_size, _YAWS)
	var front: Array[float] = [0.0]
	var stages: Studio.Framing = Studio.frame(everything, stage_size, front)

	var worlds: Array[SubViewport] = [
		Studio.make_world(
			[
				_shape(
					Plots.cloud(cloud, _reconstructor.get_cloud_colors()),
					Plots.bead_material(3.2, 0.0),
					stages
				)
			],
			stages
		),
		Studio.make_world(
			[_shape(Plots.segments(raw, false), Plots.line_material(1.3), stages)], stages
		),
		Studio.make_world(_pruned(stages), stages),
		Studio.make_world([_bark_of(instance)], stages),
		Studio.make_world([instance], views),
	]
	var measures: Dictionary = _tree.measure()
	var captions: Array[String] = [
		"Scan", "Raw skeleton", "Pruned skeleton", "Bark", "Bark and leaves"
	]
	var figures: Array[String] = [
		"%s points" % _grouped(cloud.size()),
		"%s nodes" % _grouped(raw.get_node_count()),
		"%s nodes" % _grouped(_tree.get_node_count()),
		"%s triangles" % _grouped(instance.mesh.surface_get_array_index_len(0) / 3),
		"%s leaf cards" % _grouped(instance.get_leaf_count()),
	]
	var row: Array[Array] = []
	for i: int in worlds.size():
		Studio.place_camera(worlds[i], stage_size, stages, 0.0)
		row.append([worlds[i], captions[i], figures[i]])
	sheet.add_row(row, _STAGE_HEIGHT)
	row = []
	for i: int in _YAWS.size():
		var view: SubViewport = Studio.share_world(worlds[4])
		Studio.place_camera(view, view_size, views, _YAWS[i])
		row.append([view, "From %s" % _VIEW_NAMES[i], ""])
	sheet.add_row(row, _VIEW_HEIGHT)
	var title: String = _arguments["--title"]
	if title.is_empty():
		title = _arguments["--scan"].get_file().get_basename()
	sheet.set_heading(title, _heading(measures, instance))
	_say("arranged")

	root.disable_3d = true
	root.add_child(sheet.viewport)
	await RenderingServer.frame_post_draw
	var picture: Image = sheet.viewport.get_texture().get_image()
	_say("rendered")
	var path: String = _arguments["--out"].path_join("preview.png")
	var error: Error = picture.save_png(path)
	if error != OK:
		printerr("Could not save %s: %s." % [path, error_string(error)])
	return error == OK


func _say(what: String) -> void:
	print("%5d ms  %s" % [Time.get_ticks_msec() - _started, what])


func _shape(mesh: ArrayMesh, material: ShaderMaterial, framing: Studio.Framing) -> MeshInstance3D:
	var shape: MeshInstance3D = MeshInstance3D.new()
	shape.mesh = mesh
	shape.material_override = material
	shape.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	# What is further away is paler, which tells near twigs from far ones.
	material.set_shader_parameter(&"fade", 0.45)
	material.set_shader_parameter(&"fade_color", Color(0.68, 0.72, 0.745))
	var near: float = framing.distance - framing.reach * 0.6
	material.set_shader_parameter(&"fade_range", Vector2(near, near + framing.reach * 1.2))
	return shape


# Lines below, then the nodes by kind: leaves green, forks orange, the trunk red (Chen 2025, figure
# 3.7).
func _pruned(framing: Studio.Framing) -> Array:
	return [
		_shape(Plots.segments(_tree, true), Plots.line_material(2.6), framing),
		_shape(
			Plots.nodes(_tree, _tree.get_leaves(), Plots.LEAF),
			Plots.bead_material(5.0, 0.3),
			framing
		),
		_shape(
			Plots.nodes(_tree, _tree.get_branch_nodes(), Plots.BRANCH),
			Plots.bead_material(5.5, 0.3),
			framing
		),
		_shape(
			Plots.nodes(_tree, _tree.get_trunk_nodes(), Plots.TRUNK),
			Plots.bead_material(7.0, 0.3),
			framing
		),
	]


func _bark_of(instance: TreeInstance3D) -> MeshInstance3D:
	var bark: MeshInstance3D = MeshInstance3D.new()
	bark.mesh = instance.mesh
	return bark


# Bases and tips of some leaves.
func _leaf_places(instance: TreeInstance3D) -> PackedVector3Array:
	var places: PackedVector3Array = PackedVector3Array()
	if instance.get_leaf_count() == 0:
		return places
	var buffer: PackedFloat32Array = _tree.build_leaf_buffer(0)
	for i: int in range(0, buffer.size(), 20 * 4):
		var base: Vector3 = Vector3(buffer[i + 3], buffer[i + 7], buffer[i + 11])
		places.append(base)
		places.append(base + Vector3(buffer[i + 1], buffer[i + 5], buffer[i + 9]))
	return places


func _heading(measures: Dictionary, instance: TreeInstance3D) -> String:
	var parts: PackedStringArray = []
	parts.append("%.1f m tall" % measures["height"])
	if measures["dbh"] > 0.0 and measures["height"] > _BREAST_HEIGHT:
		parts.append("%.1f cm at breast height" % (measures["dbh"] * 100.0))
	parts.append("%s triangles" % _grouped(instance.get_triangle_count()))
	parts.append("rendered by Godot %s" % Engine.get_version_info()["string"].get_slice("-", 0))
	return "   ·   ".join(parts)


# 46311 as 46 311.
static func _grouped(number: int) -> String:
	var digits: String = str(number)
	var at: int = digits.length() - 3
	while at > 0:
		digits = digits.insert(at, "\u202f")
		at -= 3
	return digits
