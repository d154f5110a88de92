@tool
extends "../../test_plugin/garden.gd"
## A branch is cut away and drawn anew: over its scan, in an orthogonal view, and over a photo.

const PhotoModel: GDScript = preload("../../test_plugin/photo_model.gd")

var _node: TreeInstance3D
var _of: TreeReconstruction
# Without the branch, and with the one that was drawn.
var _pruned: PackedByteArray
var _drawn: PackedByteArray
# The node whose upper wood was pruned, and the branch's axis from there on, in the tree's space.
var _stub: int
var _axis: PackedVector3Array


func run() -> void:
	await step("a branch is pruned away, and the scan shows it")
	_of = own_tree("res://branch_tree.res")
	if _of == null:
		return
	# Photos of the whole tree, and its scan beside their cameras.
	var provenance: Dictionary = _of.provenance
	var photos: RefCounted = PhotoModel.new(
		OS.get_environment("TREE_EDITOR_TEST").path_join("draw_branch"), _of
	)
	DirAccess.copy_absolute(sample, photos.get(&"source"))
	_of.provenance = provenance.merged(_of.provenance, true)
	ResourceSaver.save(_of, "res://branch_tree.res")
	_node = await open_garden("res://branch.tscn", _of)
	if _node == null:
		return
	session().get(&"view").leaves = false
	if not await _prune():
		return
	await _give_up()
	await _draw_over_scan()
	await _draw_orthogonal()
	await _draw_over_photo()
	check(not session().get(&"view").leaves, "The leaves came back.")
	session().get(&"view").leaves = true
	session().get(&"view").point_size = 2.0
	session().get(&"scan").call(&"stop_measuring")
	check(await save_scene(), "The scene can't be saved.")


func _tool() -> RefCounted:
	return session().get(&"tool") as RefCounted


func _is_idle() -> bool:
	return not _tool().call(&"is_busy") and session().get(&"jobs").call(&"get_running").is_empty()


func _status() -> String:
	var strip: Node = EditorInterface.get_base_control().find_child("TreeStrip", true, false)
	return (strip.find_child("Status", true, false) as Label).text


# Of the largest branches the one that is seen longest.
func _prune() -> bool:
	var longest: float = 0.0
	for id: int in clear_nodes(_node, large_branches(_of), 3, 1):
		var axis: PackedVector3Array = _axis_above(id)
		var line: PackedVector2Array = _on_screen(axis)
		var length: float = line[0].distance_to(line[-1])
		if length > longest:
			longest = length
			_axis = axis
			_stub = id
	if not check(longest > 50.0, "The longest branch is seen only %.0f px long." % longest):
		return false
	var whole: PackedByteArray = bytes(_of)
	if not await take_tool(&"prune", "d"):
		return false
	await user.click(node_on_screen(_node, _stub))
	if not await until(func() -> bool: return bytes(_of) != whole, "it is pruned"):
		return false
	_pruned = bytes(_of)
	await user.key("p")
	var box: AABB = AABB(_axis[0], Vector3.ZERO)
	for place: Vector3 in _axis:
		box = box.expand(place)
	session().emit_signal(&"view_wanted", box.grow(0.4))
	await view_rests()
	if not await take_tool(&"draw_branch", "z"):
		return false
	# Red are the points that nothing explains.
	session().get(&"scan").call(&"measure")
	if not await until(
		func() -> bool: return session().get(&"scan").fidelity != null, "the tree is measured"
	):
		return false
	session().get(&"view").point_colors = 2
	session().get(&"view").point_size = 3.0
	# As near as all of the branch is seen.
	var room: Rect2 = (view().get_parent() as Control).get_global_rect().grow(-30.0)
	for i: int in 9:
		await user.click(middle(view().get_parent() as Control), User.WHEEL_UP)
		await view_rests()
		if not _is_within(room):
			await user.click(middle(view().get_parent() as Control), User.WHEEL_DOWN)
			await view_rests()
			break
	return check(_is_within(room), "Not all of the branch is seen.")


func _is_within(room: Rect2) -> bool:
	for at: Vector2 in _on_screen(_axis):
		if not room.has_point(at):
			return false
	return true


# The way along the child with most wood above it.
func _axis_above(id: int) -> PackedVector3Array:
	var places: PackedVector3Array = [_of.get_node_position(id)]
	while not _of.get_node_children(id).is_empty():
		var most: int = -1
		var next: int = id
		for child: int in _of.get_node_children(id):
			var count: int = _of.select_nodes("below:%d" % child).size()
			if count > most:
				most = count
				next = child
		id = next
		places.append(_of.get_node_position(id))
	return places


func _on_screen(axis: PackedVector3Array) -> PackedVector2Array:
	var line: PackedVector2Array = []
	for place: Vector3 in axis:
		line.append(on_screen(_node.global_transform * place))
	return line


# As a hand does: from place to place, with a look at what is drawn half way.
func _drag(line: PackedVector2Array, shot: String) -> void:
	await user.move(line[0])
	await user.ask(["x", "mousedown", str(User.LEFT)])
	await user.frames(4)
	for i: int in range(1, line.size()):
		await user.glide(line[i - 1].lerp(line[i], 0.5))
		await user.glide(line[i])
		if i == line.size() * 2 / 3 and not shot.is_empty():
			await fine_picture(shot)
	await user.frames(2)
	check(_tool().call(&"is_held"), "No stroke is drawn.")


func _let_go() -> void:
	await user.ask(["x", "mouseup", str(User.LEFT)])
	await user.frames(4)


func _give_up() -> void:
	await step("Escape gives up a stroke")
	await _drag(_on_screen(_axis), "")
	await user.key("Escape")
	await until(func() -> bool: return not _tool().call(&"is_busy"), "the stroke is given up")
	await _let_go()
	check_equal(bytes(_of), _pruned, "the tree")
	check(_tool() == session().get(&"tools")[&"draw_branch"], "Escape has put the tool away.")


func _draw_over_scan() -> void:
	await step("the branch is drawn over the scan's points, and comes as one step")
	var steps: int = _of.edit_log.count("graft")
	await _drag(_on_screen(_axis), "branch-drawn")
	await _let_go()
	if not await until(func() -> bool: return bytes(_of) != _pruned, "the branch has grown"):
		return
	_drawn = bytes(_of)
	check_equal(_of.edit_log.count("graft"), steps + 1, "grafts in the log")
	await until(func() -> bool: return _status().begins_with("Fidelity"), "the fidelity is told")
	_check_better(_status())
	check(not _status().contains("guessed"), _status())
	await until(func() -> bool: return not _node.is_rebuilding(), "the tree is built")
	check_fits()
	await user.move(_on_screen(_axis)[0] - Vector2(0, 120))
	await fine_picture("branch-grown")
	await step("the branch is undone and done again")
	await user.key("ctrl+z")
	await until(func() -> bool: return bytes(_of) == _pruned, "Ctrl+Z takes the branch back")
	await user.key("ctrl+shift+z")
	await until(func() -> bool: return bytes(_of) == _drawn, "Ctrl+Shift+Z brings it again")
	await user.key("ctrl+z")
	await until(func() -> bool: return bytes(_of) == _pruned, "Ctrl+Z takes it back once more")


# 'Fidelity R_s a → b, explained c % → d %.': all of it became better.
func _check_better(sentence: String) -> void:
	var shares: PackedStringArray = sentence.get_slice("explained ", 1).split(" % → ")
	check(
		shares.size() == 2 and shares[1].to_float() > shares[0].to_float(),
		"It has not become better: " + sentence
	)
	var wood: PackedStringArray = sentence.get_slice("R_s ", 1).split(" → ")
	check(
		wood.size() > 1 and wood[1].to_float() >= wood[0].to_float(),
		"The wood has become worse: " + sentence
	)


func _draw_orthogonal() -> void:
	await step("the branch is drawn in an orthogonal view")
	var camera: Camera3D = view().get_camera_3d()
	await _look(camera, Camera3D.PROJECTION_ORTHOGONAL)
	await view_rests()
	await _drag(_on_screen(_axis), "branch-orthogonal")
	await _let_go()
	await until(func() -> bool: return bytes(_of) != _pruned, "the branch has grown")
	await until(func() -> bool: return _status().begins_with("Fidelity"), "the fidelity is told")
	_check_better(_status())
	await user.key("ctrl+z")
	await until(func() -> bool: return bytes(_of) == _pruned, "the branch is undone")
	await _look(camera, Camera3D.PROJECTION_PERSPECTIVE)


func _look(camera: Camera3D, projection: Camera3D.ProjectionType) -> void:
	for attempt: int in 4:
		await user.key("KP_5")
		await user.frames(10)
		if camera.projection == projection:
			return
	check(false, "The view's projection stays.")


func _stage() -> Control:
	var cover: Node = EditorInterface.get_base_control().find_child("PhotoCompare", true, false)
	return null if cover == null else cover.find_child("PhotoStage", true, false) as Control


func _on_photo(axis: PackedVector3Array) -> PackedVector2Array:
	var camera: Camera3D = _stage().get(&"camera")
	var line: PackedVector2Array = []
	for place: Vector3 in axis:
		var seen: Vector2 = camera.unproject_position(_node.global_transform * place)
		line.append(_stage().get_screen_transform() * seen)
	return line


func _draw_over_photo() -> void:
	await step("the branch is drawn over a photo, near to it")
	await user.move(middle(view().get_parent() as Control))
	await user.key("F4")
	if not await until(
		func() -> bool: return _stage() != null and _stage().get(&"_picture") != null,
		"the photo is seen"
	):
		return
	await user.frames(6)
	var at: Vector2 = _on_photo(_axis)[_axis.size() / 2]
	for i: int in 4:
		await user.click(at, User.WHEEL_UP)
	await user.frames(6)
	var shown: Rect2 = _stage().call(&"get_shown")
	await _drag(_on_photo(_axis), "branch-over-photo")
	check_equal(_stage().call(&"get_shown"), shown, "what is shown of the photo")
	await user.key("Escape")
	check(_stage() != null, "Escape has left the photo with the stroke under way.")
	await _let_go()
	check_equal(bytes(_of), _pruned, "the tree after Escape")
	await _drag(_on_photo(_axis), "")
	await _let_go()
	await until(func() -> bool: return bytes(_of) != _pruned, "the branch has grown")
	await until(func() -> bool: return _status().begins_with("Fidelity"), "the fidelity is told")
	_check_better(_status())
	await until(func() -> bool: return not _node.is_rebuilding(), "the tree is built")
	await fine_picture("branch-grown-on-photo")
	await step("the middle button moves the photo, and Escape leaves it")
	await user.drag([at, at + Vector2(40, 20)], User.MIDDLE)
	check(_stage().call(&"get_shown") != shown, "The photo can't be moved.")
	await user.key("Escape")
	await until(func() -> bool: return _stage() == null, "the photo is gone")
	await user.move(middle(view().get_parent() as Control))
	await user.key("ctrl+z")
	await until(func() -> bool: return bytes(_of) == _pruned, "the branch is undone")
	await user.key("p")
	# The next scenario drags over a photo, too, and draws nothing.
	await user.key("Escape")
	await until(
		func() -> bool: return session().get(&"tool") == session().get(&"tools")[&"select"],
		"the Select tool is back"
	)
