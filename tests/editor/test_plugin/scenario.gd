@tool
extends RefCounted
## What every scenario extends: a run() that goes through steps, each of which is what a user does and
## what should come of it.
##
## A step passes when all its checks hold and the editor reported no error that expect_error() did not
## announce. What the next line needs is waited for with `if not await until(…): return`.

const User: GDScript = preload("./user.gd")
const ErrorCollector: GDScript = preload("./error_collector.gd")

const ADDON: String = "res://addons/tree_reconstruction/plugin.gd"
# What the editor reports by itself where there is no window manager, no sound and no network.
const _NOISE: PackedStringArray = []

var user: User
var errors: ErrorCollector
var title: String
var tree: SceneTree

var _step: String = ""
var _failures: PackedStringArray = []
var _expected: PackedStringArray = []
var _seen: PackedStringArray = []
var _started: int = 0


## What the scenario does.
func run() -> void:
	check(false, "This scenario has no run().")


## Ends the step before and begins one that does what `what` says.
func step(what: String) -> void:
	await _judge()
	_step = what
	_started = Time.get_ticks_msec()


## Called by the plugin after run().
func finish() -> void:
	await _judge()


## Fails the step with `message` unless `condition` holds.
func check(condition: bool, message: String) -> bool:
	if not condition:
		var place: String = ""
		for frame: Dictionary in get_stack():
			if not str(frame.source).ends_with("/scenario.gd"):
				place = " (%s:%d)" % [str(frame.source).get_file(), frame.line]
				break
		_failures.append(message + place)
	return condition


## Fails the step unless `given` equals `wanted`.
func check_equal(given: Variant, wanted: Variant, what: String) -> bool:
	return check(
		typeof(given) == typeof(wanted) and given == wanted,
		"%s is %s instead of %s" % [what, str(given).left(200), str(wanted).left(200)]
	)


## Announces that the editor will report an error containing `part`; the step fails if it does not.
func expect_error(part: String) -> void:
	_expected.append(part)


## Waits until `condition` holds. Fails the step, with a picture, where that takes too long.
func until(condition: Callable, what: String) -> bool:
	var end: int = Time.get_ticks_msec() + 1000 * patience()
	while not condition.call():
		if Time.get_ticks_msec() > end:
			check(false, "In vain waited until " + what)
			await user.picture("FAILED-" + title)
			return false
		await tree.process_frame
	return true


## Seconds that anything may take.
func patience() -> int:
	return maxi(OS.get_environment("TREE_EDITOR_PATIENCE").to_int(), 5)


func picture(name: String) -> void:
	await user.picture(name)


## The middle of a control on the screen.
func middle(control: Control) -> Vector2:
	return control.get_screen_transform() * (control.size / 2.0)


## Clicks on the middle of a control that can be seen.
func press(control: Control, button: int = User.LEFT, times: int = 1) -> void:
	if check(control != null and control.is_visible_in_tree(), "There is nothing to press."):
		await user.click(middle(control), button, "", times)


## Takes an entry of a menu that is open, as a mouse finds it: by going down until it is lit.
func choose(menu: PopupMenu, text: String) -> bool:
	if not await until(func() -> bool: return menu.visible, "a menu opens"):
		return false
	var wanted: int = -1
	for i: int in menu.item_count:
		if menu.get_item_text(i).begins_with(text):
			wanted = i
	if not check(wanted >= 0, "The menu has no '%s'." % text):
		await user.key("Escape")
		return false
	var from: Vector2 = Vector2(menu.position) + Vector2(menu.size.x * 0.4, 4.0)
	while from.y < menu.position.y + menu.size.y:
		await user.move(from)
		if menu.get_focused_item() == wanted:
			await user.click(from)
			return true
		from.y += 9.0
	return check(false, "The mouse finds no '%s' in the menu." % text)


## The open dialog whose text or title contains `part`, or null.
func dialog(part: String) -> AcceptDialog:
	for node: Node in EditorInterface.get_base_control().get_window().find_children(
		"*", "AcceptDialog", true, false
	):
		var found: AcceptDialog = node as AcceptDialog
		if found.visible and (part in found.dialog_text or part in found.title):
			return found
	return null


## The control of a class below `root` that can be seen and whose text or tooltip begins with `text`.
func find_control(type: String, text: String, root: Node = null) -> Control:
	if root == null:
		root = EditorInterface.get_base_control()
	for node: Node in root.find_children("*", type, true, false):
		var control: Control = node as Control
		if not control.is_visible_in_tree():
			continue
		var words: Variant = control.get(&"text")
		if control.tooltip_text.begins_with(text):
			return control
		if words is String and (words as String).begins_with(text):
			return control
	return null


## The place of an entry of a list or tree of the editor on the screen; scrolls to it.
func item_place(list: Tree, item: TreeItem) -> Vector2:
	list.scroll_to_item(item)
	await user.frames(2)
	for y: int in range(4, int(list.size.y), 6):
		for x: float in [0.35, 0.5, 0.2, 0.7]:
			var at: Vector2 = Vector2(list.size.x * x, y + 4.0)
			if list.get_item_at_position(at) == item:
				return list.get_screen_transform() * at
	check(false, "The entry '%s' cannot be seen." % item.get_text(0))
	return Vector2.ZERO


## The entry of a file in the FileSystem dock, or null.
func file_item(path: String) -> TreeItem:
	return _item_with(file_list().get_root(), path)


func file_list() -> Tree:
	var dock: FileSystemDock = EditorInterface.get_file_system_dock()
	return dock.find_children("*", "Tree", true, false)[0] as Tree


## The entry of a node of the edited scene in the Scene dock, or null.
func node_item(node: Node) -> TreeItem:
	return _item_with(node_list().get_root(), node.get_path())


func node_list() -> Tree:
	for editor: Node in EditorInterface.get_base_control().find_children(
		"*", "SceneTreeEditor", true, false
	):
		for list: Node in editor.find_children("*", "Tree", true, false):
			if (list as Tree).is_visible_in_tree():
				return list as Tree
	return null


func _item_with(item: TreeItem, metadata: Variant) -> TreeItem:
	while item != null:
		var found: Variant = item.get_metadata(0)
		if typeof(found) == typeof(metadata) and found == metadata:
			return item
		item = item.get_next_in_tree()
	return null


## The 3D view's viewport.
func view() -> SubViewport:
	return EditorInterface.get_editor_viewport_3d(0)


## Where a place of the scene is seen on the screen.
func on_screen(place: Vector3) -> Vector2:
	var container: Control = view().get_parent() as Control
	return container.get_screen_transform() * view().get_camera_3d().unproject_position(place)


## The addon's plugin, or null where it is off.
func addon() -> EditorPlugin:
	for node: Node in tree.root.find_children("*", "EditorPlugin", true, false):
		var script: Script = node.get_script() as Script
		if script != null and script.resource_path == ADDON:
			return node as EditorPlugin
	return null


## What the addon's plugin edits (editor/session.gd), or null where the addon is off.
func session() -> RefCounted:
	var plugin: EditorPlugin = addon()
	return null if plugin == null else plugin.get(&"session") as RefCounted


## Saves the edited scene with Ctrl+S.
func save_scene() -> bool:
	await user.key("ctrl+s")
	return await until(func() -> bool: return not is_unsaved(), "the scene is saved")


## Whether the edited scene's tab says that it has changes.
func is_unsaved() -> bool:
	var tabs: TabBar = scene_tabs()
	return tabs.get_tab_title(tabs.current_tab).ends_with("(*)")


func scene_tabs() -> TabBar:
	var bars: Array[Node] = EditorInterface.get_base_control().find_children(
		"*", "EditorSceneTabs", true, false
	)
	return bars[0].find_children("*", "TabBar", true, false)[0] as TabBar


func scene_path() -> String:
	var root: Node = EditorInterface.get_edited_scene_root()
	return "" if root == null else root.scene_file_path


## Bytes by which two states of a tree are told apart.
func bytes(of: Resource) -> PackedByteArray:
	return var_to_bytes(of.get(&"skeleton"))


func _judge() -> void:
	if _step.is_empty():
		return
	for error: String in errors.take():
		var known: bool = false
		for part: String in _expected:
			if part in error:
				known = true
				_seen.append(part)
		for part: String in _NOISE:
			known = known or part in error
		if not known:
			_failures.append("The editor reported: " + error)
	for part: String in _expected:
		if not part in _seen:
			_failures.append("No error said '%s'." % part)
	var took: float = (Time.get_ticks_msec() - _started) / 1000.0
	var line: String = "%s: %s (%.1f s)" % [title, _step, took]
	await user.say(("ok      " if _failures.is_empty() else "FAILED  ") + line)
	for failure: String in _failures:
		await user.say("        " + failure)
	_step = ""
	_failures = []
	_expected = []
	_seen = []
