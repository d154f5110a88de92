@tool
extends RefCounted
## Trees of the user's own: made of imported ones at their first edit, saved with the scene.
##
## An imported tree is overwritten whenever its scan is imported again, so it is never edited
## itself: a copy is saved beside the scan, as [code]oak_tree.res[/code] of [code]oak.ply[/code].

const _ADDON: String = "res://addons/"
const _SUFFIX: String = "_tree"

# Paths of files whose trees have changed since they were saved, with weak references to these
# trees: one that was closed unsaved is gone.
var _changed: Dictionary[String, WeakRef] = {}
var _watched: Array[WeakRef] = []
# By path, those of them that have no file yet: they get one as soon as a scene is saved while
# anything in a scene uses them. So what was undone leaves none behind.
var _new: Dictionary[String, bool] = {}


## Whether an edit of [param tree] would be lost, since it belongs to an import, to the addon, or
## to another scene than that of [param node].
static func is_foreign(tree: TreeReconstruction, node: Node) -> bool:
	var path: String = tree.resource_path
	if path.is_empty():
		return false
	if path.begins_with(_ADDON):
		return true
	if path.contains("::"):
		var scene: Node = node.owner if node.owner != null else node
		return path.get_slice("::", 0) != scene.scene_file_path
	return FileAccess.file_exists(path + ".import")


## A copy of [param tree] that may be edited, in a file of its own beside its scan. Returns
## [code]null[/code] if that can't be written; [param say] then gets a sentence.
func make_local(tree: TreeReconstruction, node: Node, say: Callable) -> TreeReconstruction:
	var local: TreeReconstruction = copy_of(tree)
	var path: String = free_path(tree, node)
	var error: Error = ResourceSaver.save(local, path, ResourceSaver.FLAG_COMPRESS)
	if error != OK:
		say.call(
			(
				tr("The tree can't be edited, since its copy can't be written to %s: %s.")
				% [path, error_string(error)]
			)
		)
		return null
	local.take_over_path(path)
	watch(local)
	return local


## A copy that shares nothing that is edited with [param tree].
static func copy_of(tree: TreeReconstruction) -> TreeReconstruction:
	var copy: TreeReconstruction = tree.duplicate() as TreeReconstruction
	copy.resource_name = tree.resource_name
	if tree.leaf_rule != null and tree.leaf_rule.resource_path.contains("::"):
		copy.leaf_rule = tree.leaf_rule.duplicate() as LeafRule
	return copy


## The file that a copy of [param tree] would get: beside its scan if that lies in the project,
## else beside the scene; never one that exists.
static func free_path(tree: TreeReconstruction, node: Node) -> String:
	var scan: String = tree.provenance.get("source", "")
	if not scan.begins_with("res://") or scan.begins_with(_ADDON):
		scan = tree.resource_path
	var folder: String = scan.get_base_dir()
	var stem: String = scan.get_file().get_basename()
	if not scan.begins_with("res://") or scan.begins_with(_ADDON) or scan.contains("::"):
		var scene: Node = node.owner if node.owner != null else node
		folder = scene.scene_file_path.get_base_dir()
		stem = String(node.name).to_snake_case()
	if not folder.begins_with("res://"):
		folder = "res://"
	var path: String = folder.path_join(stem + _SUFFIX + ".res")
	var number: int = 2
	while FileAccess.file_exists(path):
		path = folder.path_join("%s%s_%d.res" % [stem, _SUFFIX, number])
		number += 1
	return path


## Gives [param tree], which was made in the editor, a file of its own. It is written when a scene
## is saved while any uses the tree.
func add_new(tree: TreeReconstruction, path: String) -> void:
	tree.take_over_path(path)
	_new[path] = true
	_changed[path] = weakref(tree)
	watch(tree)


## Notices from now on when [param tree] has to be saved.
func watch(tree: TreeReconstruction) -> void:
	for known: WeakRef in _watched:
		if known.get_ref() == tree:
			return
	_watched = _watched.filter(func(known: WeakRef) -> bool: return known.get_ref() != null)
	_watched.append(weakref(tree))
	tree.changed.connect(_on_changed.bind(weakref(tree)))


## The files that a save would write.
func get_unsaved() -> PackedStringArray:
	var paths: PackedStringArray = []
	for path: String in _changed:
		var tree: TreeReconstruction = _changed[path].get_ref() as TreeReconstruction
		if tree != null and (not _new.has(path) or _is_used(tree)):
			paths.append(path)
	return paths


## These files were changed by another program and loaded again: their trees are as saved.
func forget_changes(paths: PackedStringArray) -> void:
	for path: String in paths:
		_changed.erase(path)


## Writes [param tree] into its file now, whether it has changed or not.
func save_tree(tree: TreeReconstruction) -> Error:
	var error: Error = _write(tree, tree.resource_path)
	if error == OK:
		_changed.erase(tree.resource_path)
		_new.erase(tree.resource_path)
	return error


## Writes the files of all trees that have changed. Returns a sentence for each that could not be.
func save() -> PackedStringArray:
	var failed: PackedStringArray = []
	for path: String in get_unsaved():
		var tree: TreeReconstruction = _changed[path].get_ref() as TreeReconstruction
		# Another tree may have taken its place since.
		if tree.resource_path == path:
			var error: Error = _write(tree, path)
			if error != OK:
				failed.append(tr("%s can't be written: %s.") % [path, error_string(error)])
				continue
		_changed.erase(path)
		_new.erase(path)
	return failed


# Beside it first: a full disk must not cost the file that is there.
static func _write(tree: TreeReconstruction, path: String) -> Error:
	var part: String = path.get_basename() + ".saving." + path.get_extension()
	var error: Error = ResourceSaver.save(tree, part, ResourceSaver.FLAG_COMPRESS)
	if error == OK:
		error = DirAccess.rename_absolute(part, path)
	if error != OK and FileAccess.file_exists(part):
		DirAccess.remove_absolute(part)
	if Engine.is_editor_hint():
		# The engine lists what is saved. It has to know that the file is ours, too: what it finds
		# changed when its user comes back, it loads again, over edits that came since.
		EditorInterface.get_resource_filesystem().update_file(part)
		EditorInterface.get_resource_filesystem().update_file(path)
	return error


# Whether anything in an open scene holds the tree.
static func _is_used(tree: TreeReconstruction) -> bool:
	var scenes: Array[Node] = [(Engine.get_main_loop() as SceneTree).root]
	if Engine.is_editor_hint():
		scenes.assign(EditorInterface.get_open_scene_roots())
	for scene: Node in scenes:
		if scene == null:
			continue
		var nodes: Array[Node] = scene.find_children("*", "", true, false)
		nodes.append(scene)
		for node: Node in nodes:
			# The engine's own nodes hold no tree.
			var may: bool = node is TreeInstance3D or node.get_script() != null
			if (may or not node.get_meta_list().is_empty()) and _holds(node, tree, {}):
				return true
	return false


# Whether a value holds the tree, or one of the resources in it does.
static func _holds(value: Variant, tree: TreeReconstruction, seen: Dictionary) -> bool:
	if value is Array or value is Dictionary:
		var values: Array = value if value is Array else (value as Dictionary).values()
		return values.any(_holds.bind(tree, seen))
	if not is_instance_valid(value) or seen.has(value):
		return false
	if value == tree:
		return true
	# What holds much, and no tree.
	if value is Script or value is Mesh or value is Texture or value is TreeReconstruction:
		return false
	seen[value] = true
	var object: Object = value
	if object is Node and seen.size() > 1:
		return false
	for property: Dictionary in object.get_property_list():
		var type: int = property["type"]
		if (
			property["usage"] & PROPERTY_USAGE_STORAGE
			and type in [TYPE_OBJECT, TYPE_ARRAY, TYPE_DICTIONARY]
			and _holds(object.get(property["name"]), tree, seen)
		):
			return true
	return false


func _on_changed(of: WeakRef) -> void:
	var tree: TreeReconstruction = of.get_ref() as TreeReconstruction
	if tree == null:
		return
	var path: String = tree.resource_path
	# What has no file of its own is saved with its scene.
	if path.begins_with("res://") and not path.contains("::"):
		_changed[path] = of
