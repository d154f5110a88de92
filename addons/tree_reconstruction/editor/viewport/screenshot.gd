@tool
extends RefCounted
## Saves what a viewport shows as a picture.

const Session: GDScript = preload("../session.gd")
## Where pictures go, in the editor's settings.
const SETTING: String = "tree_reconstruction/screenshots/folder"
const FOLDER: String = "res://screenshots"

var _session: Session


func _init(session: Session) -> void:
	set_translation_domain(session.get_translation_domain())
	_session = session


## Adds the setting.
static func add_setting(settings: EditorSettings) -> void:
	if not settings.has_setting(SETTING):
		settings.set_setting(SETTING, FOLDER)
	settings.set_initial_value(SETTING, FOLDER, false)
	settings.add_property_info(
		{"name": SETTING, "type": TYPE_STRING, "hint": PROPERTY_HINT_GLOBAL_DIR}
	)


## Saves the picture of the camera's viewport, and says where. Returns its path, or nothing.
func take(camera: Camera3D) -> String:
	return save(camera.get_viewport().get_texture().get_image())


## Saves a picture, and says where. Returns its path, or nothing.
func save(picture: Image) -> String:
	if picture == null or picture.is_empty():
		_session.say(tr("The viewport has no picture yet."), Session.Kind.WARNING)
		return ""
	var folder: String = _folder()
	var time: String = Time.get_datetime_string_from_system().replace(":", "-").replace("T", "_")
	var path: String = folder.path_join(
		"%s_%s.png" % [String(_session.node.name).validate_filename(), time]
	)
	var error: Error = DirAccess.make_dir_recursive_absolute(folder)
	if error == OK and folder.begins_with("res://"):
		error = _keep_out_of_project(folder)
	if error == OK:
		error = picture.save_png(path)
	if error != OK:
		_session.say(
			tr("The picture can't be written to %s: %s.") % [path, error_string(error)],
			Session.Kind.ERROR
		)
		return ""
	_session.say(tr("The picture was saved as %s.") % ProjectSettings.globalize_path(path))
	return path


static func _folder() -> String:
	if not Engine.is_editor_hint():
		return FOLDER
	var settings: EditorSettings = EditorInterface.get_editor_settings()
	var folder: String = settings.get_setting(SETTING) if settings.has_setting(SETTING) else ""
	return FOLDER if folder.is_empty() else folder


# Pictures of work are no part of the game, and need no import.
static func _keep_out_of_project(folder: String) -> Error:
	var marker: String = folder.path_join(".gdignore")
	if FileAccess.file_exists(marker) or not DirAccess.get_files_at(folder).is_empty():
		return OK
	var file: FileAccess = FileAccess.open(marker, FileAccess.WRITE)
	return OK if file != null else FileAccess.get_open_error()
