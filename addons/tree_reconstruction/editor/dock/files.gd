@tool
extends RefCounted
## Asks for a file, in the editor's own dialog.

var _dialog: EditorFileDialog


## Shows the dialog. [param done] is called with the path that was chosen. [param filters] are like
## [code]"*.html;Page"[/code]. With [param anywhere], files outside of the project can be chosen.
func ask(
	title: String,
	path: String,
	filters: PackedStringArray,
	done: Callable,
	anywhere: bool = false,
	save: bool = true
) -> void:
	close()
	_dialog = EditorFileDialog.new()
	_dialog.access = (
		EditorFileDialog.ACCESS_FILESYSTEM if anywhere else EditorFileDialog.ACCESS_RESOURCES
	)
	_dialog.file_mode = (
		EditorFileDialog.FILE_MODE_SAVE_FILE if save else EditorFileDialog.FILE_MODE_OPEN_FILE
	)
	# After the mode, which sets a title of its own.
	_dialog.title = title
	_dialog.filters = filters
	var folder: String = path.get_base_dir()
	_dialog.current_dir = ProjectSettings.globalize_path(folder) if anywhere else folder
	_dialog.current_file = path.get_file()
	_dialog.file_selected.connect(done)
	_dialog.visibility_changed.connect(_on_visibility_changed)
	EditorInterface.popup_dialog_centered_clamped(_dialog, Vector2i(900, 600))


## Shows a dialog for a folder, which may be outside of the project.
func ask_folder(title: String, begin: String, done: Callable) -> void:
	close()
	_dialog = EditorFileDialog.new()
	_dialog.access = EditorFileDialog.ACCESS_FILESYSTEM
	_dialog.file_mode = EditorFileDialog.FILE_MODE_OPEN_DIR
	_dialog.title = title
	if not begin.is_empty():
		_dialog.current_dir = begin
	_dialog.dir_selected.connect(done)
	_dialog.visibility_changed.connect(_on_visibility_changed)
	EditorInterface.popup_dialog_centered_clamped(_dialog, Vector2i(900, 600))


## Takes the dialog away.
func close() -> void:
	if is_instance_valid(_dialog):
		_dialog.queue_free()
	_dialog = null


func _on_visibility_changed() -> void:
	if is_instance_valid(_dialog) and not _dialog.visible:
		# What was chosen comes first.
		close.call_deferred()


## A path beside the tree's file or its scan, if these are in the project.
static func beside(tree: TreeReconstruction, extension: String) -> String:
	for path: String in [tree.resource_path, tree.provenance.get("source", "")]:
		if path.begins_with("res://") and not path.contains("::"):
			return path.get_basename() + "." + extension
	return "res://tree." + extension


## A path for a file of this name where the editor doesn't import it: in the user's documents, or
## else in the project's user folder.
static func outside(file: String) -> String:
	var folder: String = OS.get_system_dir(OS.SYSTEM_DIR_DOCUMENTS)
	if folder.is_empty() or not DirAccess.dir_exists_absolute(folder):
		folder = OS.get_user_data_dir()
	return folder.path_join(file)


## Tells the editor of a new file of the project.
static func tell_editor(path: String) -> void:
	if Engine.is_editor_hint() and path.begins_with("res://"):
		EditorInterface.get_resource_filesystem().scan()
