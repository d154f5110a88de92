@tool
extends "../../test_plugin/garden.gd"
## What the user did not save is not written: not by undo, not by another program's turn, and not by
## closing with Don't Save. The next run of the editor (d2_saved) looks at the files.

const SCAN: String = "res://garden/elm.ply"
const LOCAL: String = "res://garden/elm_tree.res"
const UNSAVED: String = "res://garden/elm_tree_2.res"
const SCENE: String = "res://garden/saving.tscn"


func run() -> void:
	await step("a new import is undone after it was saved: the file stays as it was saved")
	var node: TreeInstance3D = await open_edited(SCAN, SCENE)
	if node == null:
		return
	var local: TreeReconstruction = node.reconstruction
	var edited: PackedByteArray = bytes(local)
	if not await _import_with("Fast"):
		return
	if not await until(func() -> bool: return bytes(local) != edited, "the new import is taken in"):
		return
	await user.move(middle(view().get_parent() as Control))
	await save_scene()
	var saved: String = FileAccess.get_sha256(LOCAL)
	await user.key("ctrl+z")
	await until(func() -> bool: return bytes(local) == edited, "the new import is undone")
	check_equal(FileAccess.get_sha256(LOCAL), saved, "the file after undo")

	await step("another program's turn writes nothing")
	await user.go()
	await user.frames(30)
	check_equal(FileAccess.get_sha256(LOCAL), saved, "the file while away")
	await user.come()
	await user.frames(30)
	check_equal(FileAccess.get_sha256(LOCAL), saved, "the file afterwards")
	check(is_unsaved(), "The scene is not marked as changed.")

	var note: FileAccess = FileAccess.open("res://saved.cfg", FileAccess.WRITE)
	note.store_string(saved)
	note.close()
	await _quit()


# With another scene that was never saved.
func _quit() -> void:
	await step("the copy that a first edit makes has no file before it is saved")
	var other: TreeInstance3D = await open_garden(
		"res://garden/unsaved.tscn", load(SCAN) as TreeReconstruction
	)
	if other == null:
		return
	var imported_tree: TreeReconstruction = other.reconstruction
	await user.click(node_on_screen(other, clear_nodes(other, large_branches(imported_tree))[0]))
	await until(func() -> bool: return session().get(&"selection").size() == 1, "it is selected")
	await user.key("Delete")
	await until(func() -> bool: return other.reconstruction != imported_tree, "it is a copy")
	check_equal(other.reconstruction.resource_path, UNSAVED, "the path of its file")
	check(not FileAccess.file_exists(UNSAVED), "It is written.")

	await step("Ctrl+Q asks, and Don't Save is pressed")
	await user.key("ctrl+q")
	if not await until(func() -> bool: return dialog("before quitting") != null, "it asks"):
		return
	await picture("asks")
	var button: Control = find_control("Button", "Don't Save", dialog("before quitting"))
	if check(button != null, "There is no Don't Save."):
		_press_later(middle(button))


# By the Import dock.
func _import_with(preset: String) -> bool:
	await click_file(SCAN)
	if not await _show_dock("Import"):
		return false
	if not await until(
		func() -> bool: return find_control("Button", "Reimport") != null, "its options are shown"
	):
		return false
	await press(find_control("Button", "Preset"))
	if not await choose(preset):
		return false
	await picture("preset")
	await press(find_control("Button", "Reimport"))
	return await _show_dock("Scene")


# Clicks on the tab of a dock.
func _show_dock(dock: String) -> bool:
	for node: Node in EditorInterface.get_base_control().find_children("*", "TabBar", true, false):
		var bar: TabBar = node as TabBar
		for i: int in bar.tab_count:
			if bar.get_tab_title(i) == dock and bar.is_visible_in_tree():
				# While it imports, a dialog takes the clicks.
				for attempt: int in 10:
					await user.click(bar.get_screen_transform() * bar.get_tab_rect(i).get_center())
					await user.frames(10)
					if bar.current_tab == i:
						return true
	return check(false, "The dock '%s' cannot be shown." % dock)


# When this has come to its end: the editor ends, too.
func _press_later(at: Vector2) -> void:
	OS.create_process("sh", ["-c", "sleep 3; xdotool mousemove %d %d click 1" % [at.x, at.y]])
