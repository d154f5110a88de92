@tool
extends RefCounted
## Finds the trees of the user's own that were made of a scan, wherever in the project they lie, and
## though the scan was renamed or moved, in the editor or outside of it.

const SceneAdder: GDScript = preload("./scene_adder.gd")

# By path of a tree's file: [time of its last change, where the tree comes from].
var _known: Dictionary[String, Array] = {}
# Where files that were moved in the FileSystem dock are now, until their trees have followed.
var _moved: Dictionary[String, String] = {}


## A file was moved in the FileSystem dock.
func note_move(from: String, to: String) -> void:
	for earlier: String in _moved:
		if _moved[earlier] == from:
			_moved[earlier] = to
	# Another one may have come to where the first one was.
	if not _moved.has(from):
		_moved[from] = to


## All trees of the scan have followed it.
func note_followed(scan: String) -> void:
	for earlier: String in _moved.keys():
		if _moved[earlier] == scan:
			_moved.erase(earlier)


## The trees that were made of the scan at [param scan], of which [param fresh] is the new import:
## those of [param loaded], and those in files of the project.
func find(
	scan: String, fresh: TreeReconstruction, loaded: Array[TreeReconstruction]
) -> Array[TreeReconstruction]:
	var found: Array[TreeReconstruction] = []
	var paths: Dictionary[String, bool] = {}
	for tree: TreeReconstruction in loaded:
		paths[tree.resource_path] = true
		if is_of(tree.provenance, scan, fresh.provenance):
			found.append(tree)
	for path: String in _tree_files():
		if paths.has(path) or not is_of(_provenance_of(path), scan, fresh.provenance):
			continue
		var tree: TreeReconstruction = load(path) as TreeReconstruction
		if tree != null:
			found.append(tree)
	return found


## Whether what comes from [param provenance] comes from the scan at [param scan], whose import
## comes from [param fresh].
func is_of(provenance: Dictionary, scan: String, fresh: Dictionary) -> bool:
	var source: String = provenance.get("source", "")
	if source.is_empty() or _moved.has(source):
		return not source.is_empty() and _moved[source] == scan
	if source == scan:
		return true
	# It was moved outside of the editor: the same points lie in another file now.
	if FileAccess.file_exists(source) or not source.begins_with("res://"):
		return false
	var was: Dictionary = provenance.get("report", {})
	var now: Dictionary = fresh.get("report", {})
	if was.is_empty() or now.is_empty():
		# A skeleton, of which nobody counted anything.
		return was.is_empty() and now.is_empty() and source.get_file() == scan.get_file()
	return was.get("points_read", 0) == now.get("points_read", -1) and _is_same_place(was, now)


# The base of the tree, in the scan's own coordinates. Other options move it a little.
static func _is_same_place(was: Dictionary, now: Dictionary) -> bool:
	var before: Array = was.get("origin", [])
	var after: Array = now.get("origin", [])
	if before.size() != 3 or after.size() != 3:
		return false
	var height: float = now.get("height_m", 1.0) / maxf(now.get("metres_per_unit", 1.0), 1e-9)
	var away: float = 0.0
	for axis: int in 3:
		away = maxf(away, absf(float(before[axis]) - float(after[axis])))
	return away < 0.1 * height


# The files of the project that hold trees, and no imported ones.
static func _tree_files() -> PackedStringArray:
	var paths: PackedStringArray = []
	if Engine.is_editor_hint():
		var files: EditorFileSystem = EditorInterface.get_resource_filesystem()
		if files.get_filesystem() != null:
			_add_files(files.get_filesystem(), paths)
	return paths


static func _add_files(folder: EditorFileSystemDirectory, paths: PackedStringArray) -> void:
	if folder.get_path() == "res://addons/":
		return
	for i: int in folder.get_file_count():
		var path: String = folder.get_file_path(i)
		if path.get_extension() in ["res", "tres"]:
			if folder.get_file_type(i) == &"TreeReconstruction" and FileAccess.file_exists(path):
				paths.append(path)
	for i: int in folder.get_subdir_count():
		_add_files(folder.get_subdir(i), paths)


# Each file is loaded once for that, and again when it was changed.
func _provenance_of(path: String) -> Dictionary:
	var time: int = FileAccess.get_modified_time(path)
	var known: Array = _known.get(path, [])
	if known.is_empty() or known[0] != time:
		var tree: TreeReconstruction = load(path) as TreeReconstruction
		known = [time, {} if tree == null else tree.provenance]
		_known[path] = known
	return known[1]
