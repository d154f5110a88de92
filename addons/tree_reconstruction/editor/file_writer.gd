@tool
extends RefCounted
## Writes resources into files of the project, on any thread.
##
## ResourceSaver itself tells the editor of each path of the project, on the thread that saves. On a
## worker that has the list of files locked then, and waits until the main thread helps it to load
## the file; a main thread that saves a scene just then waits for that list. It tells nothing of
## paths of the disk.


## Writes [param made] whole or not at all: a full disk must not cost the file that is there. The
## editor is to be told of it on the main thread.
static func write(made: Resource, path: String) -> Error:
	var target: String = ProjectSettings.globalize_path(path)
	# The engine overlooks files that begin with a dot.
	var part: String = target.get_base_dir().path_join(".saving_" + target.get_file())
	var error: Error = ResourceSaver.save(made, part, ResourceSaver.FLAG_COMPRESS)
	if error == OK and path.begins_with("res://"):
		# By its UID scenes find it, so a file that is there keeps the one that it has.
		var uid: int = ResourceUID.INVALID_ID
		if FileAccess.file_exists(path):
			uid = ResourceLoader.get_resource_uid(path)
		if uid == ResourceUID.INVALID_ID:
			uid = ResourceUID.create_id()
		error = ResourceSaver.set_uid(part, uid)
	if error == OK:
		error = DirAccess.rename_absolute(part, target)
	if error != OK and FileAccess.file_exists(part):
		DirAccess.remove_absolute(part)
	return error
