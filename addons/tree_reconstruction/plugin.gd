@tool
extends EditorPlugin
## The editor's side of the addon: makes the session of what is being edited, and the parts that
## show it.
##
## The classes register themselves: TreeReconstruction and TreeReconstructor by the native
## library, TreeInstance3D by its class_name. The parts are loaded once the library is known to be
## there, since their scripts are made of its classes.

const DOMAIN: StringName = &"tree_reconstruction"
const _EDITOR: String = "res://addons/tree_reconstruction/editor/"
# In the order in which they come; they go in the opposite one. Each has enter(plugin, session)
# and exit().
const _PARTS: PackedStringArray = [
	"translations/part.gd",
	"import/part.gd",
	"photos/part.gd",
	"sketch/part.gd",
	"sharing/part.gd",
	"viewport/part.gd",
	"dock/part.gd",
]

var _session: RefCounted
var _parts: Array[RefCounted] = []
# Those that take the viewport's events: they have input(camera, event), and may have
# draw_over(overlay).
var _listeners: Array[RefCounted] = []
# Those that draw over the viewport also where no tree is selected: they have draw_always(overlay).
var _drawers: Array[RefCounted] = []
var _game_export: EditorExportPlugin


func _enter_tree() -> void:
	if not ClassDB.class_exists(&"TreeReconstruction"):
		var sentence: String = (
			"Tree Reconstruction: the native library did not load. Look for its error message above,"
			+ " and check that addons/tree_reconstruction/bin/ holds a library for this system."
		)
		push_error(sentence)
		EditorInterface.get_editor_toaster().push_toast(sentence, EditorToaster.SEVERITY_ERROR)
		return
	var exporter: GDScript = _load("export/game_export.gd")
	exporter.call(&"add_setting")
	_game_export = exporter.new()
	add_export_plugin(_game_export)
	_session = _load("session.gd").new(get_undo_redo())
	for speaker: RefCounted in [
		_session, _session.local_trees, _session.consent, _session.scan, _session.photos
	]:
		speaker.set_translation_domain(DOMAIN)
	_session.view.restore(EditorInterface.get_editor_settings())
	_session.said.connect(_on_said)
	var files: EditorFileSystem = EditorInterface.get_resource_filesystem()
	files.resources_reload.connect(_session.local_trees.forget_changes)
	for path: String in _PARTS:
		var part: RefCounted = _load(path).new()
		part.set_translation_domain(DOMAIN)
		part.call(&"enter", self, _session)
		_parts.append(part)
		if part.has_method(&"input"):
			_listeners.append(part)
		if part.has_method(&"draw_always"):
			_drawers.append(part)
	set_process(true)


# The user switched it on in the project's settings, or off.
func _enable_plugin() -> void:
	if ClassDB.class_exists(&"TreeReconstruction") and _load("wind_globals.gd").call(&"add") > 0:
		_save_settings()


func _disable_plugin() -> void:
	if ClassDB.class_exists(&"TreeReconstruction") and _load("wind_globals.gd").call(&"remove") > 0:
		_save_settings()


func _exit_tree() -> void:
	if _session == null:
		return
	set_process(false)
	_session.edit_node(null)
	_drawers.clear()
	_listeners.clear()
	_parts.reverse()
	for part: RefCounted in _parts:
		part.call(&"exit")
	_parts.clear()
	var files: EditorFileSystem = EditorInterface.get_resource_filesystem()
	files.resources_reload.disconnect(_session.local_trees.forget_changes)
	_session.said.disconnect(_on_said)
	_session.view.keep(EditorInterface.get_editor_settings())
	_session.shut_down()
	_session = null
	remove_export_plugin(_game_export)
	_game_export = null


func _process(_delta: float) -> void:
	# Without the native library there is none.
	if _session != null:
		_session.update()


func _handles(object: Object) -> bool:
	return _session != null and object is TreeInstance3D


func _edit(object: Object) -> void:
	if _session != null:
		_session.edit_node(object as TreeInstance3D)


func _make_visible(visible: bool) -> void:
	if _session != null and not visible:
		_session.edit_node(null)


func _forward_3d_gui_input(camera: Camera3D, event: InputEvent) -> int:
	for listener: RefCounted in _listeners:
		var answer: int = listener.call(&"input", camera, event)
		if answer != AFTER_GUI_INPUT_PASS:
			return answer
	return AFTER_GUI_INPUT_PASS


func _forward_3d_draw_over_viewport(overlay: Control) -> void:
	for listener: RefCounted in _listeners:
		if listener.has_method(&"draw_over"):
			listener.call(&"draw_over", overlay)


func _forward_3d_force_draw_over_viewport(overlay: Control) -> void:
	for drawer: RefCounted in _drawers:
		drawer.call(&"draw_always", overlay)


# Before a scene is saved.
func _apply_changes() -> void:
	if _session != null:
		_session.local_trees.keep_from_engine()


# With the scenes.
func _save_external_data() -> void:
	if _session == null:
		return
	for sentence: String in _session.local_trees.save():
		_session.say(sentence, _session.Kind.ERROR)


func _get_unsaved_status(for_scene: String) -> String:
	if _session == null:
		return ""
	var unsaved: PackedStringArray = []
	if for_scene.is_empty():
		unsaved = _session.local_trees.get_unsaved()
	else:
		for scene: Node in EditorInterface.get_open_scene_roots():
			if scene != null and scene.scene_file_path == for_scene:
				unsaved = _session.local_trees.get_unsaved_of(scene)
	if unsaved.is_empty():
		return ""
	return (
		_session.tr("Save the changes of these trees before closing?") + "\n" + "\n".join(unsaved)
	)


func _on_said(sentence: String, kind: int) -> void:
	# What is no more than information stands in the viewport's status line.
	if kind == _session.Kind.WARNING:
		EditorInterface.get_editor_toaster().push_toast(sentence, EditorToaster.SEVERITY_WARNING)
	elif kind == _session.Kind.ERROR:
		EditorInterface.get_editor_toaster().push_toast(sentence, EditorToaster.SEVERITY_ERROR)


static func _save_settings() -> void:
	var error: Error = ProjectSettings.save()
	if error != OK:
		push_error("The project's settings could not be saved: %s." % error_string(error))


static func _load(path: String) -> GDScript:
	return load(_EDITOR + path) as GDScript
