extends SceneTree
## In the demo project as users get it: opens each scene, and tells what stands in it.

const _SCENES: PackedStringArray = ["start", "one_tree", "scan_and_tree", "forest", "felling"]
const _FRAMES: int = 40
const _PATIENCE: int = 120000


func _initialize() -> void:
	_visit.call_deferred()


func _visit() -> void:
	for scene: String in _SCENES:
		change_scene_to_file("res://scenes/%s.tscn" % scene)
		await process_frame
		await process_frame
		var end: int = Time.get_ticks_msec() + _PATIENCE
		while not _stands() and Time.get_ticks_msec() < end:
			await process_frame
		for frame: int in _FRAMES:
			await process_frame
		if _stands():
			print("%s shows trees" % scene)
	var result: String = "res://demo/result/"
	var points: ArrayMesh = load(result + "points.res") as ArrayMesh
	var tree: Node = (load(result + "tree.tscn") as PackedScene).instantiate()
	var of: Resource = tree.get(&"reconstruction") as Resource
	if points != null and of.resource_path == result + "tree.res":
		print("the tree has its scan")
	tree.free()
	quit()


func _stands() -> bool:
	for node: Node in current_scene.find_children("*", "Node3D", true, false):
		if node.has_method(&"get_tree_count") and int(node.call(&"get_tree_count")) > 0:
			return true
		if node.has_method(&"get_triangle_count") and int(node.call(&"get_triangle_count")) > 0:
			return true
	return false
