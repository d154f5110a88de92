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
	if ClassDB.class_exists(&"TreeReconstruction"):
		wrong.append("the addon is here: nothing shows that the forest needs none")
	var standing := 0
	for group: Node in forest.get_children():
		if group is not Node3D or group is DirectionalLight3D:
			continue
		for tree: Node in group.get_children():
			if tree.name == &"Ground":
				continue
			standing += 1
			_check_levels(tree, wrong)
			if group.name == PLOT:
				_check_foot(forest, tree as Node3D, wrong)
	if standing != 8:
		wrong.append("%d trees stand in the scene" % standing)
	_check_heights(wrong)
	_end(wrong)


## Four of wood, each with its leaves, that take turns.
func _check_levels(tree: Node, wrong: PackedStringArray) -> void:
	var last := 0.0
	var levels := tree.find_children("*_LOD?", "MeshInstance3D", true, false)
	for level: MeshInstance3D in levels:
		if level.visibility_range_begin != last or level.get_child_count() != 1:
			wrong.append("%s of %s is no level" % [level.name, tree.name])
		last = level.visibility_range_end
		var leaves := (level.get_child(0) as MultiMeshInstance3D).multimesh
		if leaves.instance_count == 0 or not leaves.mesh.resource_path.begins_with("res://shared/"):
			wrong.append("%s of %s has no leaves of the shared kind" % [level.name, tree.name])
	if levels.size() != 4 or last != 0.0:
		wrong.append("%s has %d levels, the last to %.1f m" % [tree.name, levels.size(), last])
	if tree.find_children("*", "CollisionShape3D", true, false).is_empty():
		wrong.append("%s has no body" % tree.name)


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
