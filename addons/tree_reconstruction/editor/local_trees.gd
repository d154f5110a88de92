@tool
extends RefCounted
## Trees of the user's own: made of imported ones at their first edit, saved with the scene.
##
## An imported tree is overwritten whenever its scan is imported again, so it is never edited
## itself: a copy gets a file beside the scan, as [code]oak_tree.res[/code] of [code]oak.ply[/code].
## Nothing is written before a scene is saved: neither by the engine, which would save whatever a
## step of the history has touched, nor at the editor's end.

## Trees have changed that a save would write; at most once a frame.
signal changed

const FileWriter := preload("file_writer.gd")
const SceneIndex: GDScript = preload("scene_index.gd")

const _ADDON: String = "res://addons/"
const _SUFFIX: String = "_tree"

## Which scenes have which trees in their files.
var scene_index: SceneIndex = SceneIndex.new()

# Paths of files whose trees have changed since they were saved, with weak references to these
# trees: one that was closed unsaved is gone.
var _changed: Dictionary[String, WeakRef] = {}
var _watched: Array[WeakRef] = []
# By path, those of them that have no file yet: they get one as soon as a scene is saved while
# anything in a scene uses them. So what was undone leaves none behind.
var _new: Dictionary[String, bool] = {}
# Whether nothing has changed since the engine was last kept from saving.
var _is_kept: bool = true
# The trees whose steps are in the history of all scenes, by path: no scene's end ends them.
var _outliving: Dictionary[String, bool] = {}


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


## A copy of [param tree] that may be edited, with a file of its own beside its scan. It is written
## when a scene is saved while any uses the copy: what is undone, or not saved, leaves no file.
func make_local(tree: TreeReconstruction, node: Node) -> TreeReconstruction:
	var local: TreeReconstruction = copy_of(tree)
	add_new(local, free_path(tree, node))
	return local


## Forgets a tree that was made in the editor and of which nothing came.
func drop_new(tree: TreeReconstruction) -> void:
	_changed.erase(tree.resource_path)
	_new.erase(tree.resource_path)
	tree.take_over_path("")


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
	stem = stem.trim_suffix(_SUFFIX) + _SUFFIX
	var path: String = folder.path_join(stem + ".res")
	var number: int = 2
	while FileAccess.file_exists(path) or ResourceLoader.has_cached(path):
		path = folder.path_join("%s_%d.res" % [stem, number])
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
		var tree: TreeReconstruction = get_changed(path)
		if tree != null and (not _new.has(path) or _is_used(tree)):
			paths.append(path)
	return paths


## Whether a save would write the file.
func is_changed(path: String) -> bool:
	return get_changed(path) != null


## The trees in files, or to be, that are in memory and were edited, or may be. What was undone
## before it had a file is none of them.
func get_loaded() -> Array[TreeReconstruction]:
	var trees: Array[TreeReconstruction] = []
	for known: WeakRef in _watched:
		var tree: TreeReconstruction = known.get_ref() as TreeReconstruction
		if tree != null and has_file(tree):
			if not _new.has(tree.resource_path) or _is_used(tree):
				trees.append(tree)
	return trees


## A file was moved in the FileSystem dock; the engine tells its tree.
func note_move(from: String, to: String) -> void:
	if _changed.has(from):
		_changed[to] = _changed[from]
		_changed.erase(from)


## The tree of a file, if it has changed since it was saved, or else [code]null[/code].
func get_changed(path: String) -> TreeReconstruction:
	var known: WeakRef = _changed.get(path)
	var tree: TreeReconstruction = null if known == null else known.get_ref() as TreeReconstruction
	# Another one may have taken its place since.
	return tree if tree != null and tree.resource_path == path else null


## The engine would write the trees by itself whenever it writes a resource, be they undone or
## without a file: what it has marked for that is ours to save.
func keep_from_engine() -> void:
	_is_kept = true
	for known: WeakRef in _watched:
		var tree: TreeReconstruction = known.get_ref() as TreeReconstruction
		if tree == null or not has_file(tree):
			continue
		for part: Resource in _parts_of(tree):
			if Engine.is_editor_hint() and EditorInterface.is_object_edited(part):
				EditorInterface.set_object_edited(part, false)
				_changed[tree.resource_path] = known
	changed.emit()


## The files with trees of a scene that a save would write.
func get_unsaved_of(scene: Node) -> PackedStringArray:
	var paths: PackedStringArray = []
	for path: String in _changed:
		var tree: TreeReconstruction = get_changed(path)
		if tree != null and not get_holders(tree, scene).is_empty():
			paths.append(path)
	return paths


## The scenes other than that of [param node] that show the tree: open ones, and files.
func get_other_scenes(tree: TreeReconstruction, node: Node) -> PackedStringArray:
	var here: Node = node.owner if node.owner != null else node
	var paths: PackedStringArray = []
	for holder: Node in get_holders(tree):
		var scene: Node = holder.owner if holder.owner != null else holder
		if scene != here and scene.scene_file_path not in paths:
			paths.append(scene.scene_file_path)
	if has_file(tree):
		for path: String in scene_index.scenes_with(tree.resource_path):
			if path != here.scene_file_path and path not in paths:
				paths.append(path)
	return paths


## Whether other scenes than that of a node show the tree: [param node], or any that shows it. Its
## steps then are no scene's.
func is_in_other_scenes(tree: TreeReconstruction, node: Node = null) -> bool:
	if not Engine.is_editor_hint() or not has_file(tree):
		return false
	if node == null:
		var holders: Array[Node] = get_holders(tree)
		if holders.is_empty():
			return false
		node = holders[0]
	return not get_other_scenes(tree, node).is_empty()


## Steps of the tree go into the history of all scenes from now on.
func note_outliving(tree: TreeReconstruction) -> void:
	_outliving[tree.resource_path] = true


## After a scene was closed: lets go of the changed trees that none shows any more. Its user did not
## save them, so the file is what opens next.
func drop_unused() -> void:
	for path: String in _outliving.keys():
		var tree: TreeReconstruction = get_changed(path)
		if tree != null and not _new.has(path) and not _is_used(tree):
			_changed.erase(path)
			_outliving.erase(path)
			tree.take_over_path("")


## These files were changed by another program and loaded again: their trees are as saved.
func forget_changes(paths: PackedStringArray) -> void:
	for path: String in paths:
		var tree: TreeReconstruction = get_changed(path)
		if tree != null and Engine.is_editor_hint():
			# Else keep_from_engine() would take it for one that a step has changed.
			for part: Resource in _parts_of(tree):
				EditorInterface.set_object_edited(part, false)
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
		var error: Error = _write(get_changed(path), path)
		if error != OK:
			failed.append(tr("%s can't be written: %s.") % [path, error_string(error)])
			continue
		_changed.erase(path)
		_new.erase(path)
	return failed


static func _write(tree: TreeReconstruction, path: String) -> Error:
	var error: Error = FileWriter.write(tree, path)
	if Engine.is_editor_hint():
		# The engine lists what is saved. It has to know that the file is ours, too: what it finds
		# changed when its user comes back, it loads again, over edits that came since.
		EditorInterface.get_resource_filesystem().update_file(path)
	return error


## Whether the tree has, or will get, a file of its own.
static func has_file(tree: TreeReconstruction) -> bool:
	return tree.resource_path.begins_with("res://") and not tree.resource_path.contains("::")


## The nodes that hold the tree, of [param in_scene] or all open scenes.
static func get_holders(tree: TreeReconstruction, in_scene: Node = null) -> Array[Node]:
	var scenes: Array[Node] = [in_scene]
	if in_scene == null and Engine.is_editor_hint():
		scenes.assign(EditorInterface.get_open_scene_roots())
	elif in_scene == null:
		scenes = [(Engine.get_main_loop() as SceneTree).root]
	var holders: Array[Node] = []
	for scene: Node in scenes:
		if scene == null:
			continue
		var nodes: Array[Node] = scene.find_children("*", "", true, false)
		nodes.append(scene)
		for node: Node in nodes:
			# The engine's own nodes hold no tree.
			var may: bool = node is TreeInstance3D or node.get_script() != null
			if (may or not node.get_meta_list().is_empty()) and _holds(node, tree, {}):
				holders.append(node)
	return holders


# Whether anything in an open scene holds the tree.
static func _is_used(tree: TreeReconstruction) -> bool:
	return not get_holders(tree).is_empty()


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


# The resources that a tree's file holds.
static func _parts_of(tree: TreeReconstruction) -> Array[Resource]:
	var parts: Array[Resource] = [tree]
	if tree.leaf_rule != null and tree.leaf_rule.resource_path.begins_with(tree.resource_path):
		parts.append(tree.leaf_rule)
	return parts


func _on_changed(of: WeakRef) -> void:
	var tree: TreeReconstruction = of.get_ref() as TreeReconstruction
	if tree == null:
		return
	# What has no file of its own is saved with its scene.
	if not has_file(tree):
		return
	_changed[tree.resource_path] = of
	if _is_kept:
		# The history marks what it has changed right after.
		_is_kept = false
		keep_from_engine.call_deferred()
