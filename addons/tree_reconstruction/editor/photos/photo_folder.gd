@tool
extends RefCounted
## What photos a folder has, and where in the project work on them is done.

## What COLMAP reads.
const PHOTOS: PackedStringArray = ["jpg", "jpeg", "png", "tif", "tiff", "bmp"]
## What phones save, and is converted to JPEG first.
const HEICS: PackedStringArray = ["heic", "heif", "avif"]
## What ffmpeg takes photos out of.
const FILMS: PackedStringArray = ["mp4", "mov", "m4v", "avi", "mkv", "webm"]
## Fewer are never enough.
const LEAST: int = 8

# What the work's folder ends in, and what is in the file that keeps the engine out of it.
const _WORK: String = "_photos"
const _NOTE: String = "# The work on these photos; the engine leaves it alone.\n"
const _MOST_TRIES: int = 1000


static func is_photo(path: String) -> bool:
	return path.get_extension().to_lower() in PHOTOS or is_heic(path)


static func is_heic(path: String) -> bool:
	return path.get_extension().to_lower() in HEICS


## The photos in [param folder], by name. Of a HEIC and a JPEG of one name, the JPEG.
static func list(folder: String) -> PackedStringArray:
	var found: PackedStringArray = []
	if folder.is_empty() or not DirAccess.dir_exists_absolute(folder):
		return found
	var names: PackedStringArray = DirAccess.get_files_at(folder)
	var jpegs: Dictionary[String, bool] = {}
	for name: String in names:
		if name.get_extension().to_lower() in ["jpg", "jpeg"]:
			jpegs[name.get_basename()] = true
	for name: String in names:
		if name.begins_with(".") or not is_photo(name):
			continue
		if not is_heic(name) or not jpegs.has(name.get_basename()):
			found.append(name)
	found.sort()
	return found


## What the photos of [param names] are called where COLMAP reads them: HEICs became JPEGs there.
static func read_names(names: PackedStringArray) -> PackedStringArray:
	var read: PackedStringArray = []
	var taken: Dictionary[String, bool] = {}
	for name: String in names:
		if not is_heic(name):
			taken[name.to_lower()] = true
	for name: String in names:
		var jpeg: String = name
		if is_heic(name):
			jpeg = name.get_basename() + ".jpg"
			if taken.has(jpeg.to_lower()):
				jpeg = name + ".jpg"
			taken[jpeg.to_lower()] = true
		read.append(jpeg)
	return read


## The film that [param path] means: itself, or the only one in a folder of too few photos; nothing
## where it is none.
static func film_of(path: String) -> String:
	if path.get_extension().to_lower() in FILMS and FileAccess.file_exists(path):
		return path
	if path.is_empty() or not DirAccess.dir_exists_absolute(path) or list(path).size() >= LEAST:
		return ""
	var films: PackedStringArray = []
	for name: String in DirAccess.get_files_at(path):
		if name.get_extension().to_lower() in FILMS:
			films.append(path.path_join(name))
	return films[0] if films.size() == 1 else ""


## A name for the tree of [param folder], as a file of the project that is not there yet.
static func free_tree_path(folder: String) -> String:
	var name: String = folder.trim_suffix("/").get_file()
	if name.get_extension().to_lower() in FILMS:
		name = name.get_basename()
	name = name.validate_filename().to_snake_case()
	return free_path("res://" + ("tree" if name.is_empty() else name))


## [param base] with a resource's extension, and a number before it where that is taken: a file that
## is not there yet.
static func free_path(base: String) -> String:
	for i: int in _MOST_TRIES:
		var path: String = "%s%s.res" % [base, "" if i == 0 else "_%d" % (i + 1)]
		if not FileAccess.file_exists(path):
			return path
	return base + "_new.res"


## The folder beside the tree's file in which [param folder] is worked on: one that was begun with
## the same photos and led to no tree, so that what was done is kept, or a new one.
static func work_folder(folder: String, tree_path: String) -> String:
	var parent: String = tree_path.get_base_dir()
	for name: String in DirAccess.get_directories_at(parent):
		var note: PackedStringArray = _note_of(parent.path_join(name))
		if (
			note.size() == 2
			and note[0] == _absolute(folder)
			and not FileAccess.file_exists(note[1])
		):
			return parent.path_join(name)
	var base: String = tree_path.get_basename()
	for i: int in _MOST_TRIES:
		var path: String = base + ("" if i == 0 else "_%d" % (i + 1)) + _WORK
		if not DirAccess.dir_exists_absolute(path):
			return path
	return base + "_new" + _WORK


## Whether work on these photos was begun there and not ended.
static func is_begun(folder: String, tree_path: String) -> bool:
	return DirAccess.dir_exists_absolute(work_folder(folder, tree_path))


## Makes the folder, with a note of its photos and its tree that also keeps the engine from
## importing what is in it.
static func begin_work(work: String, folder: String, tree_path: String) -> Error:
	var error: Error = DirAccess.make_dir_recursive_absolute(work)
	if error != OK:
		return error
	var file: FileAccess = FileAccess.open(work.path_join(".gdignore"), FileAccess.WRITE)
	if file == null:
		return FileAccess.get_open_error()
	file.store_string("%s%s\n%s\n" % [_NOTE, _absolute(folder), tree_path])
	return file.get_error()


static func _note_of(work: String) -> PackedStringArray:
	var path: String = work.path_join(".gdignore")
	if not work.ends_with(_WORK) or not FileAccess.file_exists(path):
		return []
	var text: String = FileAccess.get_file_as_string(path)
	return text.trim_prefix(_NOTE).split("\n", false) if text.begins_with(_NOTE) else []


static func _absolute(folder: String) -> String:
	return ProjectSettings.globalize_path(folder).simplify_path()
