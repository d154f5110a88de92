extends SceneTree
## Plays one of the demo scenes as a visitor would, and keeps pictures of it: see make_captures.sh.
##
##     godot --fixed-fps 12 --path project --script tests/captures/film.gd -- SCENE FOLDER

const _PATIENCE: int = 120000

var _folder: String
var _scene: Node
var _count: int = 0


func _initialize() -> void:
	_film.call_deferred()


func _film() -> void:
	var name: String = OS.get_cmdline_user_args()[0]
	_folder = OS.get_cmdline_user_args()[1]
	change_scene_to_file("res://scenes/%s.tscn" % name)
	await process_frame
	await process_frame
	# The controls are made for a larger window.
	root.content_scale_factor = 0.6
	_scene = current_scene
	await _settle()
	match name:
		"one_tree":
			await _one_tree()
		"scan_and_tree":
			await _scan_and_tree()
		"felling":
			await _felling()
	quit()


func _one_tree() -> void:
	for step: int in 12:
		_slide("Season", 0.4 + 0.33 * step / 11.0)
		await _settle()
		await _keep(1)
	_slide("Variation", 0.8)
	for step: int in 10:
		_slide("Seed", 2 + step)
		await _settle()
		await _keep(2)
	for step: int in 12:
		_slide("Age", 1.0 - 0.7 * step / 11.0)
		await _settle()
		await _keep(1)


func _scan_and_tree() -> void:
	_slide("Points", 1.5)
	for step: int in 40:
		_slide("Line", 0.5 - 0.35 * sin(TAU * step / 40.0))
		await _keep(1)


# The one that stands nearest, at its base, then the one in the middle, higher up.
func _felling() -> void:
	await _keep(3)
	await _cut(3, 0.08)
	await _keep(44)
	await _cut(2, 0.3)
	await _keep(32)


func _cut(number: int, share: float) -> void:
	var trees: Array[Node] = _scene.get_node(^"Trees").get_children()
	var standing: TreeInstance3D = null
	for child: Node in trees:
		if child is TreeInstance3D:
			number -= 1
			if number == 0:
				standing = child as TreeInstance3D
	var shape: TreeReconstruction = standing.reconstruction
	var wanted: float = share * shape.get_aabb().size.y
	var best: Vector3 = Vector3.INF
	for id: int in shape.get_trunk_nodes():
		var place: Vector3 = shape.get_node_position(id)
		if absf(place.y - wanted) < absf(best.y - wanted):
			best = place
	var event: InputEventMouseButton = InputEventMouseButton.new()
	event.button_index = MOUSE_BUTTON_LEFT
	event.position = root.get_camera_3d().unproject_position(standing.global_transform * best)
	for pressed: bool in [true, false]:
		event.pressed = pressed
		root.push_input(event.duplicate() as InputEvent, true)
		await process_frame


# Moves the slider beside a word.
func _slide(title: String, value: float) -> void:
	for label: Node in _scene.find_children("*", "Label", true, false):
		if (label as Label).text == title:
			for slider: Node in label.get_parent().find_children("*", "HSlider", false, false):
				(slider as HSlider).value = value


func _keep(count: int) -> void:
	for i: int in count:
		await RenderingServer.frame_post_draw
		root.get_texture().get_image().save_png(_folder.path_join("%04d.png" % _count))
		_count += 1


# Until all that is being built is there.
func _settle() -> void:
	var end: int = Time.get_ticks_msec() + _PATIENCE
	var quiet: int = 0
	while quiet < 3 and Time.get_ticks_msec() < end:
		await process_frame
		quiet += 1
		for node: Node in _scene.find_children("*", "Node3D", true, false):
			if node is TreeInstance3D and (node as TreeInstance3D).is_rebuilding():
				quiet = 0
