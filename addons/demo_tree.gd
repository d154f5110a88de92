extends SceneTree
## Makes what the scenes of the demo project show (scenes/demo_tree.gd) of a scan, for its zip:
##
##     godot --headless --path project --script addons/demo_tree.gd -- SCAN FOLDER
##
## FOLDER gets tree.tscn, tree.res and points.res, which name each other as in res://demo/result/.

const Plots := preload("res://demo/plots.gd")
const _PLACE: String = "res://demo/result/"


func _init() -> void:
	var given: PackedStringArray = OS.get_cmdline_user_args()
	quit(0 if given.size() == 2 and _make(given[0], given[1]) else 1)


func _make(scan: String, folder: String) -> bool:
	var maker: TreeReconstructor = TreeReconstructor.new()
	var tree: TreeReconstruction = maker.reconstruct_file(scan, {})
	if tree == null:
		printerr(maker.get_error_message())
		return false
	tree.leaf_preset = "oak"
	var points: ArrayMesh = Plots.cloud(maker.get_cloud_points(), maker.get_cloud_colors())
	var node: TreeInstance3D = TreeInstance3D.new()
	node.name = "Tree"
	node.reconstruction = tree
	tree.take_over_path(_PLACE + "tree.res")
	var scene: PackedScene = PackedScene.new()
	scene.pack(node)
	node.free()
	DirAccess.make_dir_recursive_absolute(folder)
	var files: Dictionary[String, Resource] = {
		"tree.res": tree, "points.res": points, "tree.tscn": scene
	}
	for file: String in files:
		var path: String = folder.path_join(file)
		var error: Error = ResourceSaver.save(files[file], path, ResourceSaver.FLAG_COMPRESS)
		if error != OK:
			printerr("Could not save %s: %s." % [path, error_string(error)])
			return false
	return true
