extends SceneTree
## What the scene of ./dev forest costs: seconds to load, memory, and what is drawn from the edge,
## from amid its trees and from above. In the forest's folder:
##
##     godot --path OUT --rendering-driver opengl3 --script measure_forest.gd [-- FOLDER]
##
## Pictures go into FOLDER.

const FRAMES := 5


func _initialize() -> void:
	_measure.call_deferred()


func _measure() -> void:
	var memory := OS.get_static_memory_usage()
	var begin := Time.get_ticks_usec()
	var packed: PackedScene = load("res://forest.tscn")
	var loaded := Time.get_ticks_usec()
	var forest: Node3D = packed.instantiate()
	root.add_child(forest)
	var entered := Time.get_ticks_usec()
	var trees: Array[Node3D] = []
	var height := 1.0
	for group: Node in forest.get_children():
		for tree: Node in group.get_children():
			if tree.name != &"Ground":
				trees.append(tree as Node3D)
				height = maxf(height, tree.get("values")[&"tree_height"])
	print(
		(
			"%d trees, %d nodes: loaded in %.2f s, in the tree after %.2f s more, %.1f MB"
			% [
				trees.size(),
				get_node_count(),
				(loaded - begin) * 1e-6,
				(entered - loaded) * 1e-6,
				(OS.get_static_memory_usage() - memory) * 1e-6,
			]
		)
	)
	if DisplayServer.get_name() != "headless":
		await _draw(trees, height)
	quit()


func _draw(trees: Array[Node3D], height: float) -> void:
	var box := AABB(trees[0].global_position, Vector3.ZERO)
	for tree: Node3D in trees:
		box = box.expand(tree.global_position)
	var camera := Camera3D.new()
	camera.far = 2000.0
	root.add_child(camera)
	camera.make_current()
	var middle := box.get_center()
	var edge := Vector3(middle.x, box.position.y, box.end.z)
	var half := maxf(box.size.x, box.size.z) * 0.5
	var views: Dictionary[String, PackedVector3Array] = {
		"edge": [edge + Vector3(0, 1.7, 0.9 * height), edge + Vector3(0, 0.5 * height, -height)],
		"amid":
		[middle + Vector3(1.4, 1.7, 1.4), middle + Vector3(-2.0 * height, 0.4 * height, -height)],
		"above": [middle + Vector3(0, 0.7 * half + height, 1.2 * half + height), middle],
	}
	var folder: String = (
		"" if OS.get_cmdline_user_args().is_empty() else OS.get_cmdline_user_args()[0]
	)
	for name: String in views:
		camera.look_at_from_position(views[name][0], views[name][1])
		for i: int in 3:
			await RenderingServer.frame_post_draw
		var begin := Time.get_ticks_usec()
		for i: int in FRAMES:
			await RenderingServer.frame_post_draw
		var draws := 0
		var primitives := 0
		var shadow_draws := 0
		var type := Viewport.RENDER_INFO_TYPE_VISIBLE
		draws = root.get_render_info(type, Viewport.RENDER_INFO_DRAW_CALLS_IN_FRAME)
		primitives = root.get_render_info(type, Viewport.RENDER_INFO_PRIMITIVES_IN_FRAME)
		shadow_draws = root.get_render_info(
			Viewport.RENDER_INFO_TYPE_SHADOW, Viewport.RENDER_INFO_DRAW_CALLS_IN_FRAME
		)
		print(
			(
				"%s: %d draws, %d triangles, %d draws for shadows, %.0f ms a frame"
				% [
					name,
					draws,
					primitives,
					shadow_draws,
					(Time.get_ticks_usec() - begin) * 1e-3 / FRAMES
				]
			)
		)
		if not folder.is_empty():
			root.get_texture().get_image().save_png(folder.path_join("%s.png" % name))
