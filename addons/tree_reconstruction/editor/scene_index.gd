@tool
extends RefCounted
## Which scenes of the project have a resource in them, by their files: none is loaded.

# By path of a scene: [time of its last change, paths of the resources in it].
var _known: Dictionary[String, Array] = {}
# By path of a resource: what was found last, until the project's files change.
var _found: Dictionary[String, PackedStringArray] = {}


## The scenes in whose files the resource at [param path] is. Linear in the number of scenes; each
## is read again only after it has changed, and none is looked at until [method look_again].
func scenes_with(path: String) -> PackedStringArray:
	if _found.has(path):
		return _found[path]
	var found: PackedStringArray = []
	if not Engine.is_editor_hint():
		return found
	var root: EditorFileSystemDirectory = EditorInterface.get_resource_filesystem().get_filesystem()
	if root != null:
		_look(root, path, found)
		_found[path] = found
	return found


## The project's files have changed.
func look_again() -> void:
	_found.clear()


func _look(folder: EditorFileSystemDirectory, path: String, found: PackedStringArray) -> void:
	if folder.get_path() == "res://addons/":
		return
	for i: int in folder.get_file_count():
		if folder.get_file_type(i) == &"PackedScene":
			var scene: String = folder.get_file_path(i)
			if path in _resources_in(scene):
				found.append(scene)
	for i: int in folder.get_subdir_count():
		_look(folder.get_subdir(i), path, found)


func _resources_in(scene: String) -> PackedStringArray:
	var time: int = FileAccess.get_modified_time(scene)
	var known: Array = _known.get(scene, [])
	if known.is_empty() or known[0] != time:
		var paths: PackedStringArray = []
		if scene.get_extension() in ["tscn", "scn"]:
			for dependency: String in ResourceLoader.get_dependencies(scene):
				paths.append(_path_of(dependency))
		known = [time, paths]
		_known[scene] = known
	return known[1]


# A dependency is a path, or "uid::type::path", of which the UID is right where both are known.
static func _path_of(dependency: String) -> String:
	if not dependency.contains("::"):
		return dependency
	var id: int = ResourceUID.text_to_id(dependency.get_slice("::", 0))
	if id != ResourceUID.INVALID_ID and ResourceUID.has_id(id):
		return ResourceUID.get_id_path(id)
	return dependency.get_slice("::", 2)
