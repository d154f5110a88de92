@tool
extends RefCounted
## The plugin's part that makes trees of strokes: its window, what opens it, and how the first tree
## comes into the scene.

const Session := preload("../session.gd")
const FileChooser := preload("../file_chooser.gd")
const SketchPanel := preload("sketch_panel.gd")
const SceneAdder := preload("../import/scene_adder.gd")
const FreePlace := preload("../import/free_place.gd")
const ViewHost := preload("view_host.gd")

# At the editor's scale of 1.
const _SIZE: Vector2 = Vector2(620, 580)
const _MARGIN: float = 8.0

var panel: SketchPanel
var window: AcceptDialog

var _plugin: EditorPlugin
var _session: Session
var _adder: SceneAdder
var _title: String
var _chooser: FileChooser = FileChooser.new()
var _host: ViewHost = ViewHost.new()
# Whether the skeleton was hidden for the window.
var _skeleton_hidden: bool = false


func enter(plugin: EditorPlugin, session: Session) -> void:
	_plugin = plugin
	_session = session
	_chooser.set_translation_domain(get_translation_domain())
	_adder = SceneAdder.new(plugin.get_undo_redo())
	_adder.set_translation_domain(get_translation_domain())
	_adder.added.connect(session.view.show_whole.unbind(1))
	panel = SketchPanel.new(session)
	panel.made.connect(_on_made)
	panel.node_wanted.connect(_on_node_wanted)
	panel.history_wanted.connect(_on_history_wanted)
	panel.load_wanted.connect(_choose_to_load)
	panel.save_wanted.connect(_choose_to_save)
	window = AcceptDialog.new()
	window.set_translation_domain(get_translation_domain())
	window.title = tr("Sketch Tree")
	window.ok_button_text = tr("Close")
	window.exclusive = false
	# Escape ends a stroke under way first: the panel sees to it.
	window.dialog_close_on_escape = false
	window.add_child(panel)
	window.files_dropped.connect(_on_dropped)
	window.visible = false
	window.visibility_changed.connect(_on_visibility_changed)
	panel.close_wanted.connect(window.hide)
	_host.enter(plugin, session, panel)
	EditorInterface.get_base_control().add_child(window)
	_title = tr("Sketch a Tree…")
	plugin.add_tool_menu_item(_title, open)
	session.sketch_wanted.connect(open)
	plugin.get_tree().process_frame.connect(_on_frame)


func exit() -> void:
	_plugin.get_tree().process_frame.disconnect(_on_frame)
	_session.sketch_wanted.disconnect(open)
	_plugin.remove_tool_menu_item(_title)
	window.visibility_changed.disconnect(_on_visibility_changed)
	_show_skeleton()
	panel.close()
	_host.exit()
	window.queue_free()
	window = null
	panel = null
	_chooser.close()
	_adder = null
	_session = null
	_plugin = null


## Takes an event of the 3D viewport, or leaves it to the editor.
func input(camera: Camera3D, event: InputEvent) -> int:
	return _host.input(camera, event)


func draw_always(overlay: Control) -> void:
	_host.draw_always(overlay)


## Shows the window, on the edited tree where that is one of strokes.
func open() -> void:
	var edited: TreeInstance3D = _session.node
	if edited != null and SketchPanel.sketch_of(edited.reconstruction) != null:
		panel.set_node(edited)
	if window.visible:
		window.grab_focus()
	else:
		_pop_up()
	panel.canvas.grab_focus()


# At the left, over the docks: the tree is seen beside it as it grows.
func _pop_up() -> void:
	var base: Window = EditorInterface.get_base_control().get_window()
	var scale: float = EditorInterface.get_editor_scale()
	window.popup_centered_clamped(Vector2i(_SIZE * scale), 0.9)
	var left: int = 0 if window.is_embedded() else base.position.x
	window.position.x = left + roundi(_MARGIN * scale)


# What is drawn is judged by its leaves, and lines over all twigs would be in the way of the pen.
func _on_visibility_changed() -> void:
	if not window.visible:
		panel.bar.in_view.button_pressed = false
		_show_skeleton()
	elif _session.view.skeleton:
		_skeleton_hidden = true
		_session.view.skeleton = false


# As it was before, unless the user chose otherwise.
func _show_skeleton() -> void:
	if _skeleton_hidden:
		_skeleton_hidden = false
		_session.view.skeleton = true


func _on_frame() -> void:
	if window.visible or panel.is_busy():
		panel.update()
	_host.update()


# The tree is the scene's own: its strokes are saved with it there.
func _on_made(tree: TreeReconstruction) -> void:
	var trees: Array[TreeReconstruction] = [tree]
	var nodes: Array[TreeInstance3D] = _adder.add(trees, FreePlace.in_view(trees))
	if nodes.is_empty():
		return
	if panel.view.place is Transform3D:
		nodes[0].global_transform = panel.view.place
	else:
		_session.view.want(nodes[0])
	panel.set_node(nodes[0])


func _on_node_wanted(node: TreeInstance3D) -> void:
	var selection: EditorSelection = EditorInterface.get_selection()
	selection.clear()
	selection.add_node(node)


# By the editor's own keys, so that all of it knows of the step.
func _on_history_wanted(redo: bool) -> void:
	var action: StringName = &"ui_redo" if redo else &"ui_undo"
	for event: InputEvent in InputMap.action_get_events(action):
		var key: InputEventKey = event.duplicate() as InputEventKey
		if key == null:
			continue
		key.pressed = true
		var main: Viewport = EditorInterface.get_base_control().get_viewport()
		# Past whatever has the keyboard there.
		main.push_unhandled_input(key, true)
		return


func _choose_to_load() -> void:
	var endings: String = "*.json, *.svg, *.png, *.jpg, *.jpeg;"
	_chooser.open(
		window,
		EditorFileDialog.FILE_MODE_OPEN_FILE,
		tr("Load Sketch"),
		panel.files.read,
		[endings + tr("Strokes and drawings")]
	)


func _choose_to_save() -> void:
	_chooser.open(
		window,
		EditorFileDialog.FILE_MODE_SAVE_FILE,
		tr("Save Sketch"),
		_save,
		["*.json;" + tr("Strokes")],
		"sketch.json"
	)


func _save(path: String) -> void:
	panel.files.write(panel.get_sketch(), path)


func _on_dropped(files: PackedStringArray) -> void:
	if not files.is_empty():
		panel.files.read(files[0])
