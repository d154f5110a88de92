@tool
extends RefCounted
## Finds scans that cannot import by themselves, since their extension belongs to other files too:
## text clouds ([code].txt[/code], [code].csv[/code]) and COLMAP models. A [code].treescan[/code]
## file that is written beside such a scan stands for it and imports.
##
## It looks, on a worker thread, whenever the engine has looked through the project, and remembers
## what it saw. A [code].treescan[/code] that the user deletes is not made again.

## Files that stand for scans were written; the engine imports them next.
signal found(stand_ins: PackedStringArray)

const ScanFiles: GDScript = preload("./scan_files.gd")

const _SECTION: String = "tree_reconstruction"
const _TEXTS: PackedStringArray = ["txt", "csv"]
# How many folders deep it looks.
const _DEEPEST: int = 16
# Names of folders that say nothing about the scan in them.
const _PLAIN_FOLDERS: PackedStringArray = ["sparse", "dense", "colmap"]
# The end of an import is followed by that of the look that found what to import.
const _QUIET_FRAMES: int = 3

var _importing: bool = false
var _task: int = -1
var _again: bool = false
# By path: [time of the last change, whether it is a scan].
var _seen: Dictionary
# The scans that have, or had, a file that stands for them; its path by theirs.
var _stand_ins: Dictionary
# By path of a file that stands for a scan: when that scan was changed last.
var _times: Dictionary


func enter() -> void:
	_seen = _remembered("seen_texts")
	_stand_ins = _remembered("stand_ins")
	_times = _remembered("scan_times")
	var files: EditorFileSystem = EditorInterface.get_resource_filesystem()
	files.resources_reimporting.connect(_on_reimporting)
	files.resources_reimported.connect(_on_reimported)
	files.filesystem_changed.connect(look)
	EditorInterface.get_file_system_dock().files_moved.connect(_on_file_moved)
	look()


func exit() -> void:
	EditorInterface.get_file_system_dock().files_moved.disconnect(_on_file_moved)
	var files: EditorFileSystem = EditorInterface.get_resource_filesystem()
	files.filesystem_changed.disconnect(look)
	files.resources_reimported.disconnect(_on_reimported)
	files.resources_reimporting.disconnect(_on_reimporting)
	if _task >= 0:
		WorkerThreadPool.wait_for_task_completion(_task)
		_task = -1


## Looks through the project, now or as soon as the look that is under way has ended.
func look() -> void:
	if _task >= 0:
		_again = true
		return
	_again = false
	var look_at: Look = Look.new()
	look_at.seen = _seen.duplicate(true)
	_task = WorkerThreadPool.add_task(_run.bind(look_at), false, "Look for scans")


## The file that stands for the scan, or an empty string.
func get_stand_in(scan: String) -> String:
	var stand_in: String = _stand_ins.get(scan, "")
	return stand_in if FileAccess.file_exists(stand_in) else ""


## Whether a look is under way.
func is_looking() -> bool:
	return _task >= 0


func _run(look_at: Look) -> void:
	look_at.folder("res://")
	_take.call_deferred(look_at)


func _take(look_at: Look) -> void:
	if _task < 0:
		return  # The plugin was turned off meanwhile.
	WorkerThreadPool.wait_for_task_completion(_task)
	_task = -1
	_seen = look_at.seen
	for scan: String in _stand_ins.keys():
		if scan not in look_at.scans:
			_stand_ins.erase(scan)  # If it comes back it is a new one.
	for stand_in: String in look_at.stand_ins:
		_stand_ins[look_at.stand_ins[stand_in]] = stand_in
	var written: PackedStringArray = []
	for scan: String in look_at.scans:
		if _stand_ins.has(scan):
			continue
		var path: String = _free_path(look_at.scans[scan])
		_leave_to_us(scan)
		var error: Error = ScanFiles.write_stand_in(path, scan)
		_stand_ins[scan] = path
		if error == OK:
			written.append(path)
			print("%s is a point cloud: %s stands for it and is imported." % [scan, path])
		else:
			push_error("Could not write '%s': %s." % [path, error_string(error)])
	_import_changed(look_at)
	_remember("seen_texts", _seen)
	_remember("stand_ins", _stand_ins)
	_remember("scan_times", _times)
	if not written.is_empty():
		_scan_files.call_deferred()
		found.emit(written)
	if _again:
		look()


# Imports again what stands for scans that were changed: the engine does not see that.
func _import_changed(look_at: Look) -> void:
	var changed: PackedStringArray = []
	var times: Dictionary = {}
	for stand_in: String in look_at.stand_ins:
		var time: int = FileAccess.get_modified_time(look_at.stand_ins[stand_in])
		if _times.get(stand_in, time) != time:
			changed.append(stand_in)
		times[stand_in] = time
	_times = times
	if not changed.is_empty():
		_reimport.call_deferred(changed)


func _scan_files() -> void:
	await _wait_for_engine()
	EditorInterface.get_resource_filesystem().scan()


func _reimport(paths: PackedStringArray) -> void:
	await _wait_for_engine()
	EditorInterface.get_resource_filesystem().reimport_files(paths)


# A look of the engine's that is under way may have passed the new files, and no other one begins
# meanwhile. One that begins during an import loses what it finds, since that import's end clears
# the list; and none may begin while deferred calls are made.
func _wait_for_engine() -> void:
	var quiet: int = 0
	while quiet < _QUIET_FRAMES:
		await (Engine.get_main_loop() as SceneTree).process_frame
		var files: EditorFileSystem = EditorInterface.get_resource_filesystem()
		quiet = 0 if _importing or files.is_scanning() else quiet + 1


func _on_reimporting(_paths: PackedStringArray) -> void:
	_importing = true


func _on_reimported(_paths: PackedStringArray) -> void:
	_importing = false


# The engine takes every .csv file for translations. A scan is left alone, and not exported.
func _leave_to_us(scan: String) -> void:
	var settings: String = scan + ".import"
	if scan.get_extension().to_lower() != "csv":
		return
	var config: ConfigFile = ConfigFile.new()
	if config.load(settings) == OK:
		if config.get_value("remap", "importer", "") != "csv_translation":
			return
		for made: String in config.get_value("deps", "files", []):
			DirAccess.remove_absolute(made)
			EditorInterface.get_resource_filesystem().update_file(made)
	config.clear()
	config.set_value("remap", "importer", "skip")
	var error: Error = config.save(settings)
	if error != OK:
		push_warning("Could not write '%s': %s." % [settings, error_string(error)])


# A scan that is moved in the FileSystem dock takes along what stands for it, and that finds its
# scan from wherever it is moved to.
func _on_file_moved(from: String, to: String) -> void:
	var scan: Variant = to
	var stand_in: String = _stand_ins.get(from, "")
	if _stand_ins.has(from):
		_stand_ins.erase(from)
	else:
		scan = _stand_ins.find_key(from)
		stand_in = to
		if scan == null:
			return
	_stand_ins[scan] = stand_in
	_remember("stand_ins", _stand_ins)
	if FileAccess.file_exists(stand_in):
		var error: Error = ScanFiles.write_stand_in(stand_in, scan as String)
		if error != OK:
			push_error("Could not write '%s': %s." % [stand_in, error_string(error)])


static func _free_path(wanted: String) -> String:
	var path: String = "%s.%s" % [wanted, ScanFiles.STAND_IN]
	var number: int = 2
	while FileAccess.file_exists(path):
		path = "%s_%d.%s" % [wanted, number, ScanFiles.STAND_IN]
		number += 1
	return path


static func _remembered(key: String) -> Dictionary:
	return EditorInterface.get_editor_settings().get_project_metadata(_SECTION, key, {})


static func _remember(key: String, value: Dictionary) -> void:
	EditorInterface.get_editor_settings().set_project_metadata(_SECTION, key, value)


## One walk through the project's folders. Any thread.
class Look:
	extends RefCounted
	## By path of a text file: [time of its last change, whether it is a scan].
	var seen: Dictionary = {}
	## The scans that need a file that stands for them; its path without extension by theirs.
	var scans: Dictionary[String, String] = {}
	## The scans by the files that stand for them.
	var stand_ins: Dictionary[String, String] = {}

	var _now: Dictionary = {}

	## Looks into the folder and all folders in it.
	func folder(path: String) -> void:
		_folder(path, _DEEPEST)
		seen = _now

	# `levels`: of folders below this one that are looked into. Links may lead in a circle.
	func _folder(path: String, levels: int) -> void:
		# It is hidden, so not among the names.
		if FileAccess.file_exists(path.path_join(".gdignore")):
			return
		var names: PackedStringArray = DirAccess.get_files_at(path)
		var model: String = ""
		for points: String in ["points3D.bin", "points3D.txt"]:
			if model.is_empty() and points in names:
				model = path.path_join(points)
				scans[model] = _model_name(path)
		for name: String in names:
			var file: String = path.path_join(name)
			var extension: String = name.get_extension().to_lower()
			if extension == ScanFiles.STAND_IN:
				var stands_for: Dictionary = ScanFiles.read_stand_in(file)
				if stands_for.has("scan"):
					stand_ins[file] = stands_for["scan"]
			elif extension in _TEXTS and model.is_empty() and _is_scan(file):
				scans[file] = file.get_basename()
		if levels == 0:
			return
		for name: String in DirAccess.get_directories_at(path):
			if name.begins_with(".") or (path == "res://" and name == "addons"):
				continue
			_folder(path.path_join(name), levels - 1)

	func _is_scan(file: String) -> bool:
		var time: int = FileAccess.get_modified_time(file)
		var known: Array = seen.get(file, [])
		if known.is_empty() or known[0] != time:
			known = [time, ScanFiles.is_text_cloud(file)]
		_now[file] = known
		return known[1]

	# A model is named after the scene, which is some folders above it:
	# scene/sparse/0/points3D.bin.
	static func _model_name(path: String) -> String:
		var scene: String = path
		while (
			scene != "res://"
			and (scene.get_file().to_lower() in _PLAIN_FOLDERS or scene.get_file().is_valid_int())
		):
			scene = scene.get_base_dir()
		if scene == "res://":
			return path.path_join("points3D")
		return scene.path_join(scene.get_file())
