@tool
extends "../../test_plugin/garden.gd"
## The way of docs/first_tree.md, as it is written there. Its pictures are made here:
## tests/editor/make_pictures.sh cuts them out.

const SCAN: String = "res://my_tree.ply"

var _node: TreeInstance3D
var _of: TreeReconstruction


func run() -> void:
	await step("a scan in the project is a tree in the scene after two clicks")
	await drop_file(sample, SCAN)
	var made: TreeReconstruction = await imported(SCAN)
	if made == null or not await _new_scene():
		return
	await until(func() -> bool: return file_item(SCAN) != null, "the file is in the dock")
	await click_file(SCAN, User.RIGHT)
	await until(func() -> bool: return open_menu() != null, "a menu opens")
	await _see_last_entry()
	await fine_picture("tour-menu")
	if not await choose("Add Tree to Scene"):
		return
	var root: Node = EditorInterface.get_edited_scene_root()
	if not await until(func() -> bool: return root.get_child_count() == 1, "the tree is there"):
		return
	_node = root.get_child(0) as TreeInstance3D
	if await take_up(_node) == null or not await take_tool(&"select", "q"):
		return
	_of = made
	await _look_at_it()
	await _work_on_it()
	await user.key("q")
	EditorInterface.save_scene()
	await until(func() -> bool: return not is_unsaved(), "all is saved")


func _look_at_it() -> void:
	await user.move(middle(view().get_parent() as Control) + Vector2(330.0, -150.0))
	await fine_picture("tour-tree")

	await step("the scan is seen on its tree")
	await user.key("p")
	if await until(func() -> bool: return not session().scan.points.is_empty(), "the scan is read"):
		await user.key("l")
		await user.key("t")
		await user.frames(20)
		await fine_picture("tour-scan")
		await user.key("t")
		await user.key("l")
	await user.key("p")


func _work_on_it() -> void:
	await step("a branch is selected and deleted")
	var branch: int = clear_nodes(_node, _branches_of(30))[0]
	await double_click(
		node_on_screen(_node, branch),
		func() -> bool: return session().selection.size() > 5,
		"a branch is selected"
	)
	await fine_picture("tour-branch")
	await user.key("Delete")
	if not await until(func() -> bool: return _node.reconstruction != _of, "it is cut"):
		return
	_of = _node.reconstruction

	await step("another branch is picked and grafted")
	# Without leaves it is seen best.
	await user.key("l")
	if not await take_tool(&"pick", "k"):
		return
	await user.click(node_on_screen(_node, clear_nodes(_node, _branches_of(30))[0]))
	await until(func() -> bool: return session().scion.length() > 40, "a branch is picked")
	if not await take_tool(&"graft", "j"):
		return
	var host: int = clear_nodes(_node, _of.select_nodes("order:..2&radius:0.01..&height:1..8"))[0]
	var children: int = _of.get_node_children(host).size()
	await user.move(node_on_screen(_node, host))
	await until(func() -> bool: return not session().tool.get_ghosts().is_empty(), "it is shown")
	await fine_picture("tour-graft")
	await user.click(node_on_screen(_node, host))
	await until(
		func() -> bool: return _of.get_node_children(host).size() > children, "it is grafted"
	)
	await user.key("l")

	await step("the leaves become those of a maple in autumn")
	# All of them: what was grafted is selected, and would get them alone.
	session().call(&"clear_selection")
	if not await take_tool(&"leaf_rule", "F2"):
		return
	await press(_with_tooltip("OptionButton", "The kind of leaves"))
	if await choose("Maple"):
		await until(func() -> bool: return _of.get_leaf_look() == "maple", "they are a maple's")
	var season: SpinBox = _with_tooltip("SpinBox", "0 the buds open") as SpinBox
	if check(season != null, "There is no season."):
		await user.click(middle(season.get_line_edit()), User.LEFT, "", 3)
		await user.type("0.7")
		await user.key("Return")
		await until(
			func() -> bool: return is_equal_approx(_of.leaf_rule.season, 0.7), "autumn comes"
		)
	await user.move(middle(view().get_parent() as Control) + Vector2(330.0, -150.0))
	await until(func() -> bool: return not _node.is_rebuilding(), "the tree is built")
	await fine_picture("tour-leaves")


func _new_scene() -> bool:
	var root: Node3D = Node3D.new()
	root.name = "Garden"
	return await open_scene(root, "res://garden.tscn")


# The mouse over the entry, for the picture.
func _see_last_entry() -> void:
	var menu: PopupMenu = open_menu()
	var row: float = float(menu.size.y) / menu.item_count
	await user.move(Vector2(menu.position) + Vector2(menu.size.x * 0.4, menu.size.y - row))


# The large ones first.
func _branches_of(least: int) -> PackedInt32Array:
	var found: PackedInt32Array = []
	for id: int in large_branches(_of):
		var size: int = _of.select_nodes("below:%d" % id).size()
		if size >= least and size < 600:
			found.append(id)
	return found


func _with_tooltip(type: String, words: String) -> Control:
	for found: Node in EditorInterface.get_base_control().find_children("*", type, true, false):
		var control: Control = found as Control
		if control.is_visible_in_tree() and control.tooltip_text.begins_with(words):
			return control
	return null
