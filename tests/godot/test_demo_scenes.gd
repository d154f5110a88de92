extends "./suite.gd"
## The scenes of the demo project: each opens, takes whatever its controls are set to, and closes.

const DemoTree := preload("res://scenes/demo_tree.gd")

const _FOLDER: String = "res://scenes/"
const _SCENES: PackedStringArray = ["start", "one_tree", "scan_and_tree", "forest", "felling"]
const _PATIENCE: int = 60000
const _FALL_STEPS: int = 900


func test_every_scene_takes_every_setting() -> void:
	for name: String in _SCENES:
		var scene: Node = await _open(name)
		if scene == null:
			continue
		for slider: Node in scene.find_children("*", "HSlider", true, false):
			for value: float in [0.0, 0.35, 1.0, 0.6]:
				(slider as HSlider).ratio = value
				await tree.process_frame
		for choice: Node in scene.find_children("*", "OptionButton", true, false):
			for i: int in (choice as OptionButton).item_count:
				(choice as OptionButton).item_selected.emit(i)
				await tree.process_frame
		for switch: Node in scene.find_children("*", "CheckButton", true, false):
			(switch as CheckButton).button_pressed = not (switch as CheckButton).button_pressed
			await tree.process_frame
		for control: Node in scene.find_children("*", "Control", true, false):
			var told: Control = control as Control
			if told is BaseButton or told is Slider:
				check(not told.tooltip_text.is_empty(), "%s: %s has no tooltip" % [name, told])
		await _settle(scene)
		await _close(scene)


func test_the_list_names_scenes_that_exist() -> void:
	var script: GDScript = load(_FOLDER + "start.gd") as GDScript
	for scene: Array in script.get_script_constant_map()["_SCENES"]:
		check(ResourceLoader.exists(_FOLDER + scene[0] + ".tscn"), "%s is missing" % scene[0])
		check(scene[0] in _SCENES, "%s is not tested" % scene[0])


func test_a_click_fells_a_tree_and_what_fell_can_be_cut_again() -> void:
	# Not the one that somebody reconstructed last, which may be of any shape.
	var shown: TreeReconstruction = DemoTree.load_tree()
	DemoTree.show_tree(DemoTree.grow())
	await _fell_and_cut_again()
	DemoTree.show_tree(shown)


func _fell_and_cut_again() -> void:
	var scene: Node = await _open("felling")
	if scene == null:
		return
	await tree.physics_frame
	await tree.physics_frame
	var trees: Node = scene.get_node(^"Trees")
	# The middle one alone: the others grow by chance, and may hold it up or hide it.
	trees.get_child(2).free()
	trees.get_child(0).free()
	var standing: int = trees.get_child_count()
	var first: TreeInstance3D = trees.get_child(0) as TreeInstance3D
	await _click(scene, first.global_transform * _place_on_trunk(first.reconstruction, 0.3))
	check_equal(trees.get_child_count(), standing + 1, "what stands there after the first cut")
	var body: RigidBody3D = _newest_body(trees)
	if body == null:
		check(false, "nothing fell")
	else:
		var before: float = body.global_position.y
		# A tall tree topples slowly at first.
		for i: int in _FALL_STEPS:
			if body.global_position.y < before - 0.2:
				break
			await tree.physics_frame
		check(body.global_position.y < before - 0.2, "it did not fall")
		var fallen: TreeInstance3D = _tree_in(body)
		await _settle(scene)
		var whole: int = fallen.reconstruction.get_node_count()
		# So that it stays where one aims.
		body.freeze = true
		await tree.physics_frame
		await _click(scene, _place_in_sight(scene, body))
		check(_count_bodies(scene) >= 2, "what fell can't be cut again")
		check(fallen.reconstruction.get_node_count() < whole, "what was cut is as before")
		await _settle(scene)
	await _close(scene)


func _open(name: String) -> Node:
	var packed: PackedScene = load("%s%s.tscn" % [_FOLDER, name]) as PackedScene
	check(packed != null, "%s does not load" % name)
	if packed == null:
		return null
	# Without a screen the window is too small for the panel.
	var window: SubViewport = SubViewport.new()
	window.size = Vector2i(1280, 720)
	window.own_world_3d = true
	tree.root.add_child(window)
	var scene: Node = packed.instantiate()
	window.add_child(scene)
	await _settle(scene)
	return scene


func _close(scene: Node) -> void:
	scene.get_parent().free()
	await tree.process_frame


# Until all that is being built is there.
func _settle(scene: Node) -> void:
	var end: int = Time.get_ticks_msec() + _PATIENCE
	var quiet: int = 0
	while quiet < 5 and Time.get_ticks_msec() < end:
		await tree.process_frame
		quiet += 1
		for node: Node in scene.find_children("*", "MeshInstance3D", true, false):
			if node is TreeInstance3D and (node as TreeInstance3D).is_rebuilding():
				quiet = 0
	check(quiet == 5, "%s is still being built" % scene.name)


func _click(scene: Node, at: Vector3) -> void:
	var camera: Camera3D = scene.get_node(^"World/Camera") as Camera3D
	var event: InputEventMouseButton = InputEventMouseButton.new()
	event.button_index = MOUSE_BUTTON_LEFT
	event.position = camera.unproject_position(at)
	for pressed: bool in [true, false]:
		event.pressed = pressed
		scene.get_viewport().push_input(event.duplicate() as InputEvent, true)
		await tree.process_frame
	await tree.physics_frame


# A place on the trunk's surface, nearest to a share of its height.
func _place_on_trunk(of: TreeReconstruction, share: float) -> Vector3:
	var box: AABB = of.get_aabb()
	var wanted: float = box.position.y + share * box.size.y
	var best: Vector3
	for id: int in of.get_trunk_nodes():
		var place: Vector3 = of.get_node_position(id)
		if best == Vector3.ZERO or absf(place.y - wanted) < absf(best.y - wanted):
			best = place
	return best


func _newest_body(trees: Node) -> RigidBody3D:
	for child: Node in trees.get_children():
		if child is RigidBody3D:
			return child as RigidBody3D
	return null


func _tree_in(body: RigidBody3D) -> TreeInstance3D:
	for child: Node in body.get_children():
		if child is TreeInstance3D:
			return child as TreeInstance3D
	return null


func _count_bodies(scene: Node) -> int:
	return scene.find_children("*", "RigidBody3D", true, false).size()


# Where a click hits this body and nothing in front of it.
func _place_in_sight(scene: Node, body: RigidBody3D) -> Vector3:
	var camera: Camera3D = scene.get_node(^"World/Camera") as Camera3D
	var space: PhysicsDirectSpaceState3D = camera.get_world_3d().direct_space_state
	var eye: Vector3 = camera.global_position
	for shape: Node in body.find_children("*", "CollisionShape3D", true, false):
		var at: Vector3 = (shape as CollisionShape3D).global_position
		var ray: PhysicsRayQueryParameters3D = PhysicsRayQueryParameters3D.create(
			eye, eye + (at - eye) * 2.0
		)
		if space.intersect_ray(ray).get("collider") == body:
			return at
	check(false, "nothing of what fell is in sight")
	return body.global_position
