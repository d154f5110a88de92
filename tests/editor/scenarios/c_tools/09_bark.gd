@tool
extends "../../test_plugin/garden.gd"
## The dock's section Bark Growth: a burl is added, changed, grown, made stale, and saved.

var _node: TreeInstance3D
var _of: TreeReconstruction
var _dock: Control


func run() -> void:
	await step("a burl is added to the trunk and changed by keys")
	_of = own_tree("res://bark_tree.res")
	_node = await open_garden("res://bark.tscn", _of)
	_dock = EditorInterface.get_base_control().find_child("TreeDock", true, false) as Control
	if _node == null or not check(_dock != null, "There is no dock."):
		return
	@warning_ignore("unsafe_method_access")
	_dock.get_parent().make_visible()
	await _open()
	await press(find_control("Button", "Add Burl", _dock))
	var list: ItemList = find_control("ItemList", "The burls that are to grow", _dock)
	if not await until(func() -> bool: return list.item_count == 1, "it is in the list"):
		return
	await _type("radius", "0.4")
	await _type("growth", "1")
	await _type_into(_surface().get(&"edge") as SpinBox, "0.09")
	await picture("bark-a-burl-to-grow")

	await step("Grow makes a surface of it, as one step")
	var before: PackedByteArray = bytes(_of)
	var tubes: Array = _of.build_mesh_arrays(0)
	await press(_section().get(&"grow") as Control)
	if not await until(func() -> bool: return _of.has_grown_bark(), "bark has grown"):
		return
	check(not _of.is_bark_stale(), "It is stale at once.")
	check("radius=0.4 growth=1" in _of.growth_recipe, _of.growth_recipe)
	check(_of.build_mesh_arrays(0) != tubes, "The tubes are drawn.")
	if session().get(&"view").leaves:
		await user.move(middle(view().get_parent() as Control))
		await user.key("l")
	await until(func() -> bool: return not _node.is_building_levels(), "the tree is built")
	await fine_picture("bark-has-grown")
	session().get(&"view").leaves = true
	await _press_undo("ctrl+z")
	check_equal(bytes(_of), before, "the tree after undo")
	check_equal(list.item_count, 0, "burls after undo")
	await _press_undo("ctrl+shift+z")
	check(_of.has_grown_bark(), "Redo has no bark.")

	await step("an edit of the wood beneath is told, and the bark grows again")
	@warning_ignore("unsafe_method_access")
	session().run("Thicken", "thicken nodes=trunk factor=1.2")
	await until(func() -> bool: return _of.is_bark_stale(), "it is stale")
	if not await until(
		func() -> bool: return find_control("Button", "Grow Again", _dock) != null,
		"it can be grown again"
	):
		return
	var again: Button = find_control("Button", "Grow Again", _dock)
	await picture("bark-is-stale")
	await press(again)
	await until(func() -> bool: return not _of.is_bark_stale(), "it has grown again")
	await _press_undo("ctrl+z")
	await _press_undo("ctrl+z")
	check(not _of.is_bark_stale(), "It is stale after undo of both.")

	await step("it is cancelled by the button beside its progress")
	await _type_into(_surface().get(&"edge") as SpinBox, "0.01")
	var recipe: String = _of.growth_recipe
	await press(_section().get(&"grow") as Control)
	if not await until(
		func() -> bool: return find_control("Button", "Ends this work", _dock) != null,
		"there is a button"
	):
		return
	await picture("bark-grows")
	await press(find_control("Button", "Ends this work", _dock))
	await until(
		func() -> bool: return not (_section().get(&"grow") as Button).disabled, "it has ended"
	)
	check_equal(_of.growth_recipe, recipe, "the recipe")

	await step("it is saved with the tree")
	check(await save_scene(), "The scene can't be saved.")
	var saved: TreeReconstruction = ResourceLoader.load(
		_of.resource_path, "", ResourceLoader.CACHE_MODE_IGNORE
	)
	check(saved.has_grown_bark() and not saved.is_bark_stale(), "The file has no bark.")
	check_equal(saved.growth_recipe, _of.growth_recipe, "the recipe in the file")


# The fields of the whole surface.
func _surface() -> Control:
	return _section().get(&"surface") as Control


func _section() -> Control:
	@warning_ignore("unsafe_property_access")
	return _dock.sections[&"bark"]


# Opens the section, and folds all others.
func _open() -> void:
	@warning_ignore("unsafe_property_access", "unsafe_method_access")
	var ids: Array = _dock.sections.keys()
	ids.erase(&"bark")
	@warning_ignore("unsafe_method_access")
	_dock.set_folded(PackedStringArray(ids))
	await user.frames(4)


func _type(parameter: String, number: String) -> void:
	var fields: Dictionary[String, SpinBox] = _section().get(&"fields")
	await _type_into(fields[parameter], number)


func _type_into(field: SpinBox, number: String) -> void:
	await press(field.get_line_edit())
	await user.key("ctrl+a")
	await user.type(number)
	await user.key("Return")
	await until(func() -> bool: return is_equal_approx(field.value, number.to_float()), number)


func _press_undo(keys: String) -> void:
	var version: int = _version()
	await user.move(middle(view().get_parent() as Control))
	await user.key(keys)
	await until(func() -> bool: return _version() != version, keys)
	await user.frames(4)


func _version() -> int:
	var manager: EditorUndoRedoManager = EditorInterface.get_editor_undo_redo()
	var scene: Node = EditorInterface.get_edited_scene_root()
	return manager.get_history_undo_redo(manager.get_object_history_id(scene)).get_version()
