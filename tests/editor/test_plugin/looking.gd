@tool
extends RefCounted
## Eyes: finds what a user sees in the editor.

const ADDON: String = "res://addons/tree_reconstruction/plugin.gd"

var tree: SceneTree

var _addon: EditorPlugin


## The middle of a control on the screen.
func middle(control: Control) -> Vector2:
	return control.get_screen_transform() * (control.size / 2.0)


## The open dialog whose text or title contains `part`, or null.
func dialog(part: String) -> AcceptDialog:
	for node: Node in EditorInterface.get_base_control().get_window().find_children(
		"*", "AcceptDialog", true, false
	):
		var found: AcceptDialog = node as AcceptDialog
		if found.visible and (part in found.dialog_text or part in found.title):
			return found
	return null


## The menu that is open, or null.
func open_menu() -> PopupMenu:
	for node: Node in EditorInterface.get_base_control().get_window().find_children(
		"*", "PopupMenu", true, false
	):
		if (node as PopupMenu).visible:
			return node as PopupMenu
	return null


## The control of a class below `root` that can be seen and whose text or tooltip begins so.
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


## The addon's plugin, or null where it is off. It is kept: scenarios ask for it frame by frame, and
## the editor has thousands of nodes.
func addon() -> EditorPlugin:
	if is_instance_valid(_addon) and _addon.is_inside_tree():
		return _addon
	for node: Node in tree.root.find_children("*", "EditorPlugin", true, false):
		var script: Script = node.get_script() as Script
		if script != null and script.resource_path == ADDON:
			_addon = node as EditorPlugin
			return _addon
	return null


## What the addon's plugin edits (editor/session.gd), or null where the addon is off.
func session() -> RefCounted:
	var plugin: EditorPlugin = addon()
	return null if plugin == null else plugin.get(&"_session") as RefCounted


func scene_path() -> String:
	var root: Node = EditorInterface.get_edited_scene_root()
	return "" if root == null else root.scene_file_path


## Whether the edited scene's tab says that it has changes.
func is_unsaved() -> bool:
	var tabs: TabBar = scene_tabs()
	return tabs.get_tab_title(tabs.current_tab).ends_with("(*)")


## The tab of an open scene, or -1.
func scene_tab(path: String) -> int:
	var tabs: TabBar = scene_tabs()
	for i: int in tabs.tab_count:
		if tabs.get_tab_title(i).trim_suffix("(*)") == path.get_file().get_basename():
			return i
	return -1


## Whether the tab of an open scene says that it has changes.
func is_marked(path: String) -> bool:
	var tab: int = scene_tab(path)
	return tab >= 0 and scene_tabs().get_tab_title(tab).ends_with("(*)")


func scene_tabs() -> TabBar:
	var bars: Array[Node] = EditorInterface.get_base_control().find_children(
		"*", "EditorSceneTabs", true, false
	)
	return bars[0].find_children("*", "TabBar", true, false)[0] as TabBar
