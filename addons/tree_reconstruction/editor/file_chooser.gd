@tool
extends RefCounted
## Asks for a file or a folder anywhere on the disk: photos come from a phone, drawings from another
## program, and markers go to a printer.

const _SIZE: Vector2i = Vector2i(900, 600)

var _dialog: EditorFileDialog


## Shows the dialog above [param parent]; [param chosen] gets the path. [param filters]: as
## [member EditorFileDialog.filters] has them. [param begin]: the folder or the file's name that it
## opens with, or empty.
func open(
	parent: Node,
	mode: EditorFileDialog.FileMode,
	title: String,
	chosen: Callable,
	filters: PackedStringArray = [],
	begin: String = ""
) -> void:
	close()
	_dialog = EditorFileDialog.new()
	_dialog.set_translation_domain(get_translation_domain())
	_dialog.access = EditorFileDialog.ACCESS_FILESYSTEM
	_dialog.file_mode = mode
	# After the mode, which sets a title of its own.
	_dialog.title = title
	_dialog.filters = filters
	if begin.is_absolute_path():
		_dialog.current_dir = begin
	elif not begin.is_empty():
		_dialog.current_file = begin
	_dialog.file_selected.connect(chosen)
	_dialog.dir_selected.connect(chosen)
	parent.add_child(_dialog)
	_dialog.popup_centered_clamped(_SIZE)


func close() -> void:
	if is_instance_valid(_dialog):
		_dialog.queue_free()
	_dialog = null
