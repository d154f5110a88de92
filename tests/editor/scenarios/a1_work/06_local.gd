@tool
extends "../../test_plugin/garden.gd"
## The first edit of an imported tree makes it the user's own, and a new import keeps the edits.

const SCAN: String = "res://garden/elm.ply"
const LOCAL: String = "res://garden/elm_tree.res"


func run() -> void:
	await step("an imported tree becomes a file beside the scan with its first edit")
	await drop_file(sample, SCAN)
	var made: TreeReconstruction = await imported(SCAN)
	if made == null:
		return
	var node: TreeInstance3D = await open_garden("res://garden/local.tscn", made)
	if node == null:
		return
	var before: PackedByteArray = bytes(made)
	await user.click(node_on_screen(node, clear_nodes(node, large_branches(made))[0]))
	await until(func() -> bool: return session().get(&"selection").size() == 1, "it is selected")
	await user.key("Delete")
	if not await until(func() -> bool: return node.reconstruction != made, "it is the user's own"):
		return
	check_equal(node.reconstruction.resource_path, LOCAL, "the file")
	check_equal(bytes(made), before, "the imported tree")
	check(not FileAccess.file_exists(LOCAL), "It was written before it was saved.")
	await picture("made-local")

	await step("Ctrl+Z goes back to the import, Ctrl+Shift+Z to the copy")
	var local: TreeReconstruction = node.reconstruction
	var edited: PackedByteArray = bytes(local)
	await user.key("ctrl+z")
	await until(func() -> bool: return node.reconstruction == made, "the import is back")
	await user.key("ctrl+shift+z")
	await until(func() -> bool: return node.reconstruction == local, "the copy is back")
	check_equal(bytes(local), edited, "the copy")
	await save_scene()
	await until(func() -> bool: return file_item(LOCAL) != null, "the file is in the dock")

	await step("importing the scan again keeps the edit")
	await user.go()
	var longer: String = OS.get_environment("TREE_EDITOR_TEST").path_join("elm.ply")
	_shift_scan(longer)
	await user.ask(["copy", longer, ProjectSettings.globalize_path(SCAN)])
	await user.come()
	if not await until(func() -> bool: return bytes(local) != edited, "the new import is taken in"):
		return
	check_equal(node.reconstruction, local, "the node's tree")
	check(local.edit_log.contains("remove"), "The edit is lost.")
	check(FileAccess.file_exists(LOCAL + ".bak"), "The tree as it was is not kept.")
	await picture("imported-again")
	await user.move(middle(view().get_parent() as Control))
	await user.key("ctrl+z")
	await until(func() -> bool: return bytes(local) == edited, "the new import is undone")
	await save_scene()


# The same scan, where every third point is some tenths of a millimetre off. A point of the sample
# is three doubles and three bytes.
func _shift_scan(to: String) -> void:
	var data: PackedByteArray = FileAccess.get_file_as_bytes(sample)
	var head: int = data.slice(0, 2000).get_string_from_ascii().find("end_header") + 11
	for at: int in range(head + 5, data.size(), 27 * 3):
		data[at] = data[at] ^ 1
	var file: FileAccess = FileAccess.open(to, FileAccess.WRITE)
	file.store_buffer(data)
	file.close()
