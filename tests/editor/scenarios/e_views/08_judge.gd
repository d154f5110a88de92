@tool
extends "../../test_plugin/garden.gd"
## How true a tree of photos is to them, in the dock: before and after an edit, by the sky and by
## masks.

const PhotoModel: GDScript = preload("../../test_plugin/photo_model.gd")

var _node: TreeInstance3D
var _photos: RefCounted
var _dock: Control


func run() -> void:
	await step("the dock measures a tree of photos against them, and says by what")
	var made: TreeReconstruction = own_tree("res://judge_tree.res")
	if made == null:
		return
	var folder: String = OS.get_environment("TREE_EDITOR_TEST").path_join("judged")
	var options: Dictionary = made.provenance.get("options", {})
	_photos = PhotoModel.new(folder, made)
	DirAccess.copy_absolute(sample, folder.path_join("cloud.ply"))
	var photos: String = _photos.get(&"photos")
	made.provenance = {
		"source": folder.path_join("cloud.ply"), "options": options, "photos": photos
	}
	ResourceSaver.save(made, "res://judge_tree.res")
	_node = await open_garden("res://judge.tscn", made)
	_dock = EditorInterface.get_base_control().find_child("TreeDock", true, false) as Control
	if _node == null or not check(_dock != null, "There is no dock."):
		return
	# The photos have none.
	_node.leaves = false
	await save_scene()
	@warning_ignore("unsafe_method_access")
	_dock.get_parent().make_visible()
	await _open()
	await press(find_control("CheckBox", "Compare with the scan", _dock))
	if not await until(func() -> bool: return _text(&"precision").begins_with("≤"), "it is told"):
		return
	await _rest()
	check(_text(&"quality").begins_with("≤ 0."), "Q is " + _text(&"quality"))
	check(not _line(&"recall").visible, "It tells of recall, which nobody knows.")
	check(find_control("Label", "Judged by the sky of 6 photos", _dock) != null, "By what?")
	check_fits()
	await fine_picture("judged-by-sky")
	check_equal(is_unsaved(), false, "whether the scene has changes")
	await _see_tooltip()
	await _take_masks()
	await _edit()


func _see_tooltip() -> void:
	await step("each figure says what it is where the mouse rests on it")
	for id: StringName in [&"quality", &"precision"]:
		await user.move(middle(_line(id).get_child(0) as Control))
		var begin: String = "How true" if id == &"quality" else "Of the tree's outline"
		await until(func() -> bool: return _has_tooltip(begin), "the tooltip of %s" % id)
	await picture("judged-tooltip")


func _edit() -> void:
	await step("an edit is judged, and so is its undo")
	var before: Dictionary[StringName, String] = {}
	for id: StringName in [&"quality", &"recall", &"skeleton"]:
		before[id] = _text(id)
	@warning_ignore("unsafe_method_access")
	session().run("Prune", "prune_order order=1")
	if not await until(func() -> bool: return _text(&"quality").begins_with("▼"), "Q is less"):
		return
	await _rest()
	check(_text(&"recall").begins_with("▼"), "Recall is " + _text(&"recall"))
	var words: Label = _section().get(&"_before")[&"quality"]
	check_equal(words.text, before[&"quality"], "Q before the edit")
	await picture("judged-after-edit")
	await user.move(middle(view().get_parent() as Control))
	await user.key("ctrl+z")
	await until(func() -> bool: return _text(&"quality").begins_with("▲"), "Q is more again")
	for id: StringName in before:
		await until(
			func() -> bool: return _text(id).trim_prefix("▲ ").trim_prefix("▼ ") == before[id],
			"%s is what it was: %s" % [id, before[id]]
		)
	await _rest()
	for id: StringName in before:
		var text: String = _text(id).trim_prefix("▲ ").trim_prefix("▼ ")
		check_equal(text, before[id], "the figure after undo")
	await save_scene()


func _take_masks() -> void:
	await step("masks that are chosen tell what is missing, too")
	var masks: String = OS.get_environment("TREE_EDITOR_TEST").path_join("judged_masks")
	DirAccess.make_dir_recursive_absolute(masks)
	for i: int in PhotoModel.COUNT:
		@warning_ignore("unsafe_method_access")
		var name: String = PhotoModel.name_of(i)
		var mask: Image = Image.load_from_file((_photos.get(&"photos") as String).path_join(name))
		for y: int in mask.get_height():
			for x: int in mask.get_width():
				var dark: bool = mask.get_pixel(x, y).get_luminance() < 0.6
				mask.set_pixel(x, y, Color.WHITE if dark else Color.BLACK)
		mask.save_png(masks.path_join(name + ".png"))
	await press(find_control("Button", "Choose Masks", _dock))
	if not await until(func() -> bool: return dialog("Choose Masks") != null, "a dialog opens"):
		return
	var chooser: EditorFileDialog = dialog("Choose Masks") as EditorFileDialog
	chooser.hide()
	chooser.dir_selected.emit(masks)
	if not await until(
		func() -> bool: return _line(&"recall").visible and _text(&"recall") != "-",
		"recall is told"
	):
		return
	await _rest()
	check(not _text(&"quality").begins_with("≤"), "Q is " + _text(&"quality"))
	check(find_control("Button", "Choose Masks", _dock) == null, "Masks are still asked for.")
	check_fits()
	await fine_picture("judged-by-masks")
	check_equal(is_unsaved(), false, "whether the scene has changes")


# Opens the section of the dock, and folds all others.
func _open() -> void:
	@warning_ignore("unsafe_property_access", "unsafe_method_access")
	var ids: Array = _dock.sections.keys()
	ids.erase(&"fidelity")
	@warning_ignore("unsafe_method_access")
	_dock.set_folded(PackedStringArray(ids))
	await user.frames(4)


func _section() -> Control:
	@warning_ignore("unsafe_property_access")
	return _dock.sections[&"fidelity"]


func _line(id: StringName) -> Control:
	return _section().get(&"_lines")[id]


func _text(id: StringName) -> String:
	return (_section().get(&"_figures")[id] as Label).text


# Until nothing is measured any more.
func _rest() -> void:
	await until(
		func() -> bool:
			@warning_ignore("unsafe_method_access")
			return session().get(&"jobs").get_running().is_empty(),
		"all is measured"
	)
	await user.frames(12)


func _has_tooltip(begin: String) -> bool:
	for window: Node in _dock.get_tree().root.find_children("*", "PopupPanel", true, false):
		if not (window as PopupPanel).visible:
			continue
		for label: Node in window.find_children("*", "Label", true, false):
			if (label as Label).text.begins_with(begin):
				return true
	return false
