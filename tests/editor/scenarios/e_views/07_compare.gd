@tool
extends "../../test_plugin/garden.gd"
## The tree compared with its photos: seen from where they were taken, and nothing else is touched.

const PhotoModel: GDScript = preload("../../test_plugin/photo_model.gd")
const MODES: PackedStringArray = ["Photo behind", "Photo in front", "Difference"]

var _node: TreeInstance3D
var _photos: RefCounted
var _before: Transform3D


func run() -> void:
	var made: TreeReconstruction = own_tree("res://compare_tree.res")
	if made == null:
		return
	_photos = PhotoModel.new(OS.get_environment("TREE_EDITOR_TEST").path_join("round"), made)
	ResourceSaver.save(made, "res://compare_tree.res")
	_node = await open_garden("res://compare.tscn", made)
	if _node == null:
		return
	session().get(&"view").leaves = false
	_node.transform = Transform3D(
		Basis(Vector3.UP, 0.7).scaled(Vector3.ONE * 1.5), Vector3(2.0, 0.5, -1.0)
	)
	await frame_view()
	await save_scene()
	await _open()
	await _look_at_others()
	await _go_nearer()
	await _come_back()
	await _leave()
	await _lack_photos()
	await _lack_cameras()
	session().get(&"view").leaves = true


func _cover() -> Control:
	return EditorInterface.get_base_control().find_child("PhotoCompare", true, false) as Control


func _part(name: String) -> Control:
	return _cover().find_child(name, true, false) as Control


func _stage() -> Control:
	return _part("PhotoStage")


func _compare() -> RefCounted:
	for part: RefCounted in addon().get(&"_parts"):
		if part.has_method(&"draw_over"):
			return part.get(&"_actions").get(&"photos")
	return null


func _source() -> RefCounted:
	return _compare().get(&"source")


func _is_seen() -> bool:
	return _source().get(&"picture") != null


func _press_key() -> bool:
	await user.move(middle(view().get_parent() as Control))
	await user.key("F4")
	return await until(func() -> bool: return _cover() != null, "the photos are there")


# How much of what is seen of the tree lies on the photo's wood, moved by so many of its pixels.
func _share_on_wood(index: int, off: Vector2) -> float:
	var path: String = _photos.get(&"photos")
	var photo: Image = Image.load_from_file(path.path_join("photo_%d.png" % index))
	var stage: Control = _stage()
	var seen: Image = (stage.get(&"_viewport") as SubViewport).get_texture().get_image()
	var shown: Rect2 = stage.call(&"get_shown")
	var tree_pixels: int = 0
	var on_wood: int = 0
	for y: int in range(0, seen.get_height(), 2):
		for x: int in range(0, seen.get_width(), 2):
			if seen.get_pixel(x, y).a < 0.5:
				continue
			var part: Vector2 = (Vector2(x, y) + Vector2(0.5, 0.5)) / Vector2(seen.get_size())
			var at: Vector2i = Vector2i(shown.position + part * shown.size + off)
			if Rect2i(Vector2i.ZERO, photo.get_size()).has_point(at):
				tree_pixels += 1
				on_wood += int(photo.get_pixelv(at).get_luminance() < 0.6)
	check(tree_pixels > 200, "The tree is hardly seen: %d pixels of it." % tree_pixels)
	return float(on_wood) / maxf(tree_pixels, 1.0)


func _open() -> void:
	await step("F4 stands where the nearest photo was taken, and the tree lies on the photo's")
	_before = view().get_camera_3d().global_transform
	if not await _press_key() or not await until(_is_seen, "the photo is seen"):
		return
	check_equal(_source().get(&"views").size(), PhotoModel.COUNT, "photos")
	await user.frames(6)
	await fine_picture("compare-behind")
	check_fits()
	var index: int = _source().get(&"index")
	var on: float = _share_on_wood(index, Vector2.ZERO)
	var beside: float = _share_on_wood(index, Vector2(9.0, 0.0))
	check(on > 0.7, "Only %.2f of the tree lies on the photo's." % on)
	check(beside < on - 0.25, "%.2f lies on it where it was moved." % beside)
	var camera: Camera3D = _stage().get(&"camera")
	for i: int in PhotoModel.COUNT:
		var pose: Transform3D = _source().get(&"views")[i]["transform"]
		var place: Vector3 = _node.global_transform * pose.origin
		check(
			(
				camera.global_position.distance_to(_before.origin)
				<= place.distance_to(_before.origin) + 1e-3
			),
			"Photo %d was taken nearer." % i
		)


func _look_at_others() -> void:
	await step("other photos come by buttons, keys and names, and lie where they should")
	var index: int = _source().get(&"index")
	var next: int = posmod(index + 1, PhotoModel.COUNT)
	var place: Vector3 = (_stage().get(&"camera") as Camera3D).global_position
	await press(_part("Next"))
	await until(func() -> bool: return _source().get(&"index") == next and _is_seen(), "the next")
	await user.drawn()
	var away: float = (_stage().get(&"camera") as Camera3D).global_position.distance_to(place)
	check(away > 1.0, "The camera has hardly moved.")
	await user.key("Left")
	await until(func() -> bool: return _source().get(&"index") == index and _is_seen(), "the last")
	await press(_part("Photos"))
	await choose("photo_4.png")
	await until(func() -> bool: return _source().get(&"index") == 4 and _is_seen(), "photo_4.png")
	await user.drawn()
	check(_share_on_wood(4, Vector2.ZERO) > 0.7, "The tree is not on it.")
	await step("the photo lies before the tree, fades, or is compared with it")
	for mode: int in [1, 2]:
		await press(_part("Modes"))
		await choose(MODES[mode])
		await until(func() -> bool: return _stage().get(&"mode") == mode, MODES[mode])
		if mode == 1:
			var slider: Control = _part("Opacity")
			await user.click(
				slider.get_screen_transform() * Vector2(slider.size.x * 0.5, slider.size.y * 0.5)
			)
			var opacity: float = _stage().get(&"opacity")
			check(absf(opacity - 0.5) < 0.1, "The photo is seen by %.2f." % opacity)
		await fine_picture("compare-" + MODES[mode].to_lower().replace(" ", "-"))
	await step("F9 keeps a picture of it, L shows and hides the leaves")
	await user.move(middle(_stage()))
	await user.key("F9")
	await until(func() -> bool: return not _pictures().is_empty(), "a picture is saved")
	for file: String in _pictures():
		var kept: Image = Image.load_from_file("res://screenshots".path_join(file))
		check_equal(kept.get_size(), Vector2i(_stage().size), "the picture's size")
		DirAccess.remove_absolute("res://screenshots".path_join(file))
	check(not _node.leaves or not session().get(&"view").leaves, "There are leaves.")
	await user.key("l")
	await until(func() -> bool: return session().get(&"view").leaves, "the leaves are shown")
	await picture("compare-leaves")
	await user.key("l")


func _pictures() -> PackedStringArray:
	var found: PackedStringArray = []
	if DirAccess.dir_exists_absolute("res://screenshots"):
		for file: String in DirAccess.get_files_at("res://screenshots"):
			if file.ends_with(".png"):
				found.append(file)
	return found


func _go_nearer() -> void:
	await step("the wheel goes nearer, a drag moves, and the tree stays on the photo")
	await press(_part("Modes"))
	await choose(MODES[0])
	var whole: Rect2 = _stage().call(&"get_shown")
	await user.click(middle(_stage()), User.WHEEL_UP, "", 6)
	var near: Rect2 = _stage().call(&"get_shown")
	check(near.size.x < 0.5 * whole.size.x, "It went no nearer.")
	await user.drag([middle(_stage()), middle(_stage()) + Vector2(0.0, 60.0)])
	await user.drawn()
	check((_stage().call(&"get_shown") as Rect2).position.y < near.position.y, "It didn't move.")
	await fine_picture("compare-near")
	check(_share_on_wood(4, Vector2.ZERO) > 0.7, "The tree is not on the photo.")
	await double_click(
		middle(_stage()),
		func() -> bool: return _stage().call(&"get_shown") == whole,
		"all of it is seen after a double-click"
	)


func _come_back() -> void:
	await step("what the photo covers is not drawn, nor after another screen was shown")
	var off: SubViewport.UpdateMode = SubViewport.UPDATE_DISABLED
	check_equal(view().render_target_update_mode, off, "how the view is drawn")
	EditorInterface.set_main_screen_editor("2D")
	await user.frames(6)
	EditorInterface.set_main_screen_editor("3D")
	await user.frames(6)
	check_equal(view().render_target_update_mode, off, "how it is drawn after that")
	# As anybody does whose keys should go to the photo again.
	await user.click(middle(_stage()))
	await step("F4 twice at once leaves and comes again, and after it the view is drawn as ever")
	var photos: RefCounted = _compare()
	photos.call(&"toggle", view().get_camera_3d())
	photos.call(&"toggle", view().get_camera_3d())
	await until(_is_seen, "the photo is seen again")
	await user.frames(6)
	check_equal(view().render_target_update_mode, off, "how the view is drawn")


func _leave() -> void:
	await step("Escape leaves, and camera, selection and scene are what they were")
	await user.key("Escape")
	await until(func() -> bool: return _cover() == null, "the photos are gone")
	await user.frames(4)
	var on: SubViewport.UpdateMode = SubViewport.UPDATE_ALWAYS
	check_equal(view().render_target_update_mode, on, "how the view is drawn")
	check_equal(view().get_camera_3d().global_transform, _before, "the editor's camera")
	check_equal(EditorInterface.get_selection().get_selected_nodes(), [_node], "the selection")
	check_equal(session().get(&"node"), _node, "the edited node")
	check_equal(is_unsaved(), false, "whether the scene has changes")
	var status: Label = EditorInterface.get_base_control().find_child("Status", true, false)
	check(not "photo was taken" in status.text, "It says still: " + status.text)
	await picture("compare-left")
	await step("it ends with the selection, too")
	if await _press_key():
		EditorInterface.get_selection().clear()
		await until(func() -> bool: return _cover() == null, "the photos are gone")
		await click_node(_node)


func _lack_photos() -> void:
	await step("photos that are elsewhere are asked for, and remembered")
	var from: String = _photos.get(&"photos")
	var to: String = from.get_base_dir().path_join("moved away")
	DirAccess.rename_absolute(from, to)
	if not await _press_key():
		return
	if not await until(
		func() -> bool: return find_control("Button", "Choose Photos", _cover()) != null,
		"they are asked for"
	):
		return
	var message: Label = _part("Message") as Label
	check("photo_0.png" in message.text, "It says: " + message.text)
	await picture("compare-lacks-photos")
	await press(find_control("Button", "Choose Photos", _cover()))
	if not await until(func() -> bool: return dialog("Choose Photos") != null, "a dialog opens"):
		return
	var chooser: EditorFileDialog = dialog("Choose Photos") as EditorFileDialog
	chooser.hide()
	chooser.dir_selected.emit(to)
	await until(_is_seen, "the photo is seen")
	check(find_control("Button", "Choose Photos", _cover()) == null, "They are still asked for.")
	await press(_part("Leave"))
	await until(func() -> bool: return _cover() == null, "the photos are gone")
	if await _press_key():
		await until(_is_seen, "the photo is seen the next time")
		# Without a move of the mouse, the viewport has the keys again.
		await user.key("Escape")


func _lack_cameras() -> void:
	await step("a damaged model gets a sentence, and another one can be chosen")
	var model: String = _photos.get(&"model")
	PhotoModel.write(model.path_join("images.txt"), "1 0.5 nonsense\n")
	if not await _press_key():
		return
	if not await until(
		func() -> bool: return find_control("Button", "Choose Cameras", _cover()) != null,
		"another one is asked for"
	):
		return
	var message: Label = _part("Message") as Label
	check(message.text.ends_with("."), "It says: " + message.text)
	check((_part("Next") as Button).disabled, "There are photos.")
	await picture("compare-lacks-cameras")
	await user.key("F4")
	await until(func() -> bool: return _cover() == null, "the photos are gone")
	check_equal(is_unsaved(), false, "whether the scene has changes")
