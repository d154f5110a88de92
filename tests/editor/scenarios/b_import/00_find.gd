@tool
extends "../../test_plugin/scenario.gd"
## Scans whose extension belongs to other files too, and what becomes of trees in the scene.

const SCAN: String = "res://scans/shrub.txt"
const STAND_IN: String = "res://scans/shrub.treescan"

var _files: EditorFileSystem


func run() -> void:
	_files = EditorInterface.get_resource_filesystem()
	await _find()
	await _stay_deleted()
	await _drop()
	await _add_text()
	await _reimport_unedited()
	await _reimport_edited()


func _find() -> void:
	await step("a text cloud and a COLMAP model import, other texts do not")
	# The engine has taken the table for translations before anybody can tell that it is a cloud.
	expect_error("Error importing CSV translation")
	DirAccess.make_dir_recursive_absolute("res://scans/oak/sparse/0")
	_write(SCAN, _branches())
	_write("res://scans/bush.csv", _branches().replace(" ", ","))
	_write("res://scans/notes.txt", "Cut on Tuesday.\n".repeat(400))
	_write("res://scans/words.csv", "keys,en,de\n" + "HELLO,Hello,Hallo\n".repeat(400))
	_write(
		"res://scans/oak/sparse/0/points3D.txt",
		(
			"# 3D point list with one line of data per point:\n"
			+ "#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[]\n"
			+ _numbered(_branches())
		)
	)
	await _look()
	for path: String in [STAND_IN, "res://scans/bush.treescan", "res://scans/oak/oak.treescan"]:
		if not await until(_is_tree.bind(path), path + " is a tree"):
			return
		var made: TreeReconstruction = load(path) as TreeReconstruction
		check_near(made.measure()["height"], 3.5, 0.3, "the height of " + path)
	check_equal(
		(load(STAND_IN) as TreeReconstruction).provenance["source"], SCAN, "the tree's source"
	)
	check_equal(_stand_ins("res://scans"), 2, "files that stand for scans")
	for name: String in DirAccess.get_files_at("res://scans"):
		check(
			not name.begins_with("bush.") or not name.ends_with(".translation"),
			"%s is left of taking the cloud for translations." % name
		)


func _stay_deleted() -> void:
	await step("what stands for a scan stays deleted")
	DirAccess.remove_absolute("res://scans/bush.treescan")
	DirAccess.remove_absolute("res://scans/bush.treescan.import")
	await _look()
	_write("res://scans/more.txt", "Nothing.")
	await _look()
	check_equal(_stand_ins("res://scans"), 1, "files that stand for scans")


func _drop() -> void:
	await step("a tree is dragged into the view, and undone")
	EditorInterface.set_main_screen_editor("3D")
	if EditorInterface.get_edited_scene_root() != null:
		await user.key("ctrl+n")
		if not await until(
			func() -> bool: return EditorInterface.get_edited_scene_root() == null, "a new scene"
		):
			return
	EditorInterface.add_root_node(Node3D.new())
	EditorInterface.save_scene_as("res://garden.tscn", false)
	await user.frames(10)
	EditorInterface.get_file_system_dock().navigate_to_path(STAND_IN)
	if not await until(func() -> bool: return file_item(STAND_IN) != null, "the file is listed"):
		return
	var from: Vector2 = await item_place(file_list(), file_item(STAND_IN))
	var place: Vector3 = Vector3(0.5, 0.0, 0.25)
	var to: Vector2 = on_screen(place)
	await user.drag([from, from.lerp(to, 0.5), to])
	if not await until(func() -> bool: return _node() != null, "a tree stands in the scene"):
		return
	var node: TreeInstance3D = _node()
	check(node.position.distance_to(place) < 0.2, "It stands at %s." % node.position)
	check_equal(node.position.y, 0.0, "its height above the ground")
	check_equal(node.name, &"Shrub", "its name")
	check_equal(node.owner, EditorInterface.get_edited_scene_root(), "its owner")
	await picture("dropped-tree")
	await user.key("ctrl+z")
	check(_node() == null, "It is still there after undo.")
	await user.key("ctrl+shift+z")
	check(_node() == node, "It is not there after redo.")
	for area: Node in EditorInterface.get_base_control().find_children(
		"TreeDropArea", "", true, false
	):
		check(not (area as Control).visible, "An area for drops is in the way.")


func _add_text() -> void:
	await step("the text itself has Add Tree to Scene, which adds the tree of what stands for it")
	var root: Node = EditorInterface.get_edited_scene_root()
	EditorInterface.get_file_system_dock().navigate_to_path(SCAN)
	await click_entry(file_list(), func() -> TreeItem: return file_item(SCAN), User.RIGHT)
	await picture("menu-of-text")
	if not await choose("Add Tree to Scene"):
		return
	if not await until(func() -> bool: return root.get_child_count() == 2, "a second tree stands"):
		return
	var added: TreeInstance3D = root.get_child(1) as TreeInstance3D
	check(added != null and added.reconstruction == load(STAND_IN), "It is another tree.")
	await user.move(middle(view().get_parent() as Control))
	await user.key("ctrl+z")
	await until(func() -> bool: return root.get_child_count() == 1, "it is undone")


func _reimport_unedited() -> void:
	await step("a tree that nobody edited follows its scan")
	var node: TreeInstance3D = _node()
	if not check(node != null, "There is no tree."):
		return
	var before: int = node.reconstruction.get_node_count()
	await _import_with("skeleton/algorithm", "flood")
	await until(
		func() -> bool: return node.reconstruction.get_node_count() != before, "the tree changes"
	)
	await _import_with("skeleton/algorithm", "geodesic")
	await until(
		func() -> bool: return node.reconstruction.get_node_count() == before, "it changes back"
	)


func _reimport_edited() -> void:
	await step("a tree that was edited gets its edits again, as one step, and is kept")
	var node: TreeInstance3D = _node()
	if not check(node != null, "There is no tree."):
		return
	EditorInterface.edit_node(node)
	await user.frames(4)
	session().run("Cut", "prune_order order=2")
	session().run("Smooth", "smooth")
	var local: TreeReconstruction = node.reconstruction
	var path: String = local.resource_path
	check_equal(path, "res://scans/shrub_tree.res", "the user's file")
	var log_before: String = local.edit_log
	var edited: PackedByteArray = bytes(local)
	var tips_before: int = local.measure()["tips"]
	check(not log_before.is_empty(), "Nothing was edited.")
	_write(SCAN, _branches(5))
	await _look()
	await until(func() -> bool: return bytes(local) != edited, "the edits are done on the new scan")
	check(node.reconstruction == local, "The node shows another tree.")
	check(not local.edit_log.is_empty(), "The log of edits is lost.")
	check(FileAccess.file_exists(path + ".bak"), "The tree as it was is not kept.")
	await picture("replayed")
	var again: PackedByteArray = bytes(local)
	await user.key("ctrl+z")
	check_equal(bytes(local), edited, "the tree after undo")
	check_equal(local.edit_log, log_before, "the log after undo")
	await user.key("ctrl+shift+z")
	check_equal(bytes(local), again, "the tree after redo")
	await step("edits that no longer fit are shown in the view, and nothing else is lost")
	local.edit_log += "\ncut node=99999@0.6:-0.5:2.5:0:0:1:0.3"
	_write(SCAN, _branches(6))
	await _look()
	if await until(
		func() -> bool: return dialog("No Longer Fit") != null, "a dialog tells of the edit"
	):
		await picture("edits-that-no-longer-fit")
		check("cut" in local.edit_log, "The command is forgotten.")
		await user.key("Return")
		await until(
			func() -> bool: return session().tool == session().tools[&"unfit"], "its tool is chosen"
		)
		await user.frames(20)
		check_equal(session().tool.get_left(), 1, "edits that fit nowhere")
		await picture("where-it-was")
	await step("the scene and the tree's file are saved together")
	check_equal(session().local_trees.get_unsaved().size(), 1, "trees to save")
	await save_scene()
	check_equal(session().local_trees.get_unsaved().size(), 0, "trees to save")
	check_equal(
		bytes(ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE)),
		bytes(local),
		"the tree in the file"
	)
	await step("a tree that no scene shows gets its edits again in its file")
	EditorInterface.close_scene()
	node = null
	local = null
	await user.frames(4)
	_write(SCAN, _branches(4))
	await _look()
	await until(
		func() -> bool: return FileAccess.get_md5(path) != FileAccess.get_md5(path + ".bak"),
		"the file is written"
	)
	# It is tried again, in vain again.
	if await until(
		func() -> bool: return dialog("No Longer Fit") != null, "a dialog tells of the edit"
	):
		await user.key("Escape")
	local = load(path) as TreeReconstruction
	check_equal(session().local_trees.get_unsaved().size(), 0, "trees to save after their files")
	check("prune_order" in local.edit_log, "The log of edits is lost.")
	check_equal(local.measure()["tips"], tips_before, "the number of tips of the first edit")


# --- means ----------------------------------------------------------------------------------------


func check_near(given: float, wanted: float, tolerance: float, what: String) -> void:
	check(absf(given - wanted) <= tolerance, "%s is %s instead of %s" % [what, given, wanted])


func _node() -> TreeInstance3D:
	var root: Node = EditorInterface.get_edited_scene_root()
	if root == null:
		return null
	for child: Node in root.get_children():
		if child is TreeInstance3D:
			return child
	return null


func _is_tree(path: String) -> bool:
	return _files.get_file_type(path) == "TreeReconstruction" and not _files.is_scanning()


func _stand_ins(folder: String) -> int:
	var count: int = 0
	for name: String in DirAccess.get_files_at(folder):
		count += int(name.get_extension() == "treescan")
	return count


# The editor looks through the project's files, and the addon after it.
func _look() -> void:
	await until(func() -> bool: return not _files.is_scanning(), "the editor has looked at files")
	var changes: Array[int] = [0]
	var count: Callable = func() -> void: changes[0] += 1
	_files.filesystem_changed.connect(count)
	_files.scan()
	await until(func() -> bool: return changes[0] > 0, "the editor looks through the files")
	_files.filesystem_changed.disconnect(count)
	await user.frames(30)
	await until(func() -> bool: return not _files.is_scanning(), "the editor has looked at files")


func _import_with(parameter: String, value: Variant) -> void:
	var config: ConfigFile = ConfigFile.new()
	config.load(STAND_IN + ".import")
	config.set_value("params", parameter, value)
	config.save(STAND_IN + ".import")
	_files.reimport_files([STAND_IN])
	await user.frames(5)


func _write(path: String, text: String) -> void:
	var file: FileAccess = FileAccess.open(path, FileAccess.WRITE)
	file.store_string(text)
	file.close()


func _numbered(points: String) -> String:
	var lines: PackedStringArray = points.split("\n")
	for i: int in lines.size():
		lines[i] = "%d %s 90 80 60 0.5 1 %d 2 %d" % [i + 1, lines[i], i, i]
	return "\n".join(lines)


# A scan of a small forked tree, with as many branches.
func _branches(branches: int = 4) -> String:
	var random: RandomNumberGenerator = RandomNumberGenerator.new()
	random.seed = 11
	var lines: PackedStringArray = []
	var side_branches: Array[Array] = [[Vector3.ZERO, Vector3(0.05, 0.0, 2.2), 0.08, 0.06]]
	for i: int in branches:
		var side: Vector3 = Vector3.RIGHT.rotated(Vector3.BACK, i * 2.4)
		var from: Vector3 = Vector3(0.05, 0.0, 2.2 - 0.25 * i)
		side_branches.append(
			[from, from + side * 0.7 + Vector3(0.0, 0.0, 1.25 - 0.1 * i), 0.045, 0.02]
		)
		from = from + side * 0.35 + Vector3(0.0, 0.0, 0.6)
		side_branches.append([from, from + side.rotated(Vector3.BACK, 1.2) * 0.5, 0.02, 0.01])
	for side_branch: Array in side_branches:
		var from: Vector3 = side_branch[0]
		var to: Vector3 = side_branch[1]
		var along: Vector3 = (to - from).normalized()
		var across: Vector3 = along.cross(Vector3(0.9, 0.2, 0.1)).normalized()
		for i: int in int(from.distance_to(to) * 2500.0):
			var t: float = random.randf()
			var place: Vector3 = from.lerp(to, t)
			place += (
				across.rotated(along, random.randf() * TAU)
				* (lerpf(side_branch[2], side_branch[3], t) + random.randfn() * 0.001)
			)
			lines.append("%.5f %.5f %.5f" % [place.x, place.y, place.z])
	return "\n".join(lines)
