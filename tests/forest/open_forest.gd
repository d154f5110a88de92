extends SceneTree
## Opens the scene of ./dev forest: every tree and the ground are there, and each tree of the plot
## stands on it.

const PLOT := "slope"


func _initialize() -> void:
	_open.call_deferred()


func _open() -> void:
	var packed: PackedScene = load("res://forest.tscn")
	if packed == null:
		return _end(["forest.tscn does not open"])
	var forest: Node3D = packed.instantiate()
	root.add_child(forest)
	await physics_frame
	await physics_frame
	var wrong: PackedStringArray = []
	var trees := forest.find_children("*", "MeshInstance3D", true, false)
	var standing := 0
	for group: Node in forest.get_children():
		if group is not Node3D or group is DirectionalLight3D:
			continue
		for tree: Node in group.get_children():
			if tree.name == &"Ground":
				continue
			standing += 1
			if tree.find_children("*", "MeshInstance3D", true, false).is_empty():
				wrong.append("%s has no mesh" % tree.name)
			if group.name == PLOT:
				_check_foot(forest, tree as Node3D, wrong)
	if standing != 8:
		wrong.append("%d trees stand in the scene" % standing)
	if trees.size() < 10:
		wrong.append("%d meshes are in the scene" % trees.size())
	_check_heights(wrong)
	_end(wrong)


func _check_foot(forest: Node3D, tree: Node3D, wrong: PackedStringArray) -> void:
	var foot := tree.global_position
	var from := foot + Vector3(0.6, 20, 0)
	var query := PhysicsRayQueryParameters3D.create(from, from + Vector3(0, -40, 0))
	var hit := forest.get_world_3d().direct_space_state.intersect_ray(query)
	if hit.is_empty():
		wrong.append("there is no ground under %s" % tree.name)
	elif absf(hit["position"].y - foot.y) > 0.35:
		wrong.append("%s stands %.2f m over the ground" % [tree.name, foot.y - hit["position"].y])


## The heightmap opens as heights, too.
func _check_heights(wrong: PackedStringArray) -> void:
	var heights := Image.load_from_file(ProjectSettings.globalize_path("res://ground_slope.exr"))
	if heights == null or heights.get_format() != Image.FORMAT_RF:
		wrong.append("ground_slope.exr is no picture of floats")
		return
	var shape := HeightMapShape3D.new()
	shape.update_map_data_from_image(heights.duplicate(), 0.0, 1.0)
	var corners := heights.get_size() - Vector2i.ONE
	var fall := heights.get_pixel(corners.x, 0).r - heights.get_pixel(0, 0).r
	# The slope of make_scans.py: .1 along x, over 19 m.
	if absf(fall - 1.9) > 0.3:
		wrong.append("the ground of 1.9 m rises by %.2f m in ground_slope.exr" % fall)


func _end(wrong: PackedStringArray) -> void:
	for sentence in wrong:
		print("WRONG: ", sentence)
	print("OPENED" if wrong.is_empty() else "NOT WHOLE")
	quit(0 if wrong.is_empty() else 1)
