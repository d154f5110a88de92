@tool
extends RefCounted
## The plugin's part that makes trees of photos: its window, what opens it, and how the tree comes
## into the scene.

const Session := preload("../session.gd")
const FileChooser := preload("../file_chooser.gd")
const PhotosPanel := preload("photos_panel.gd")
const Menu := preload("folder_menu.gd")
const PhotoFolder := preload("photo_folder.gd")
const PhotoLeaves := preload("photo_leaves.gd")
const SceneAdder := preload("../import/scene_adder.gd")
const FreePlace := preload("../import/free_place.gd")

## Where COLMAP is, in the editor's settings.
const SETTING: String = "tree_reconstruction/photos/colmap"

var panel: PhotosPanel
var window: AcceptDialog

var _plugin: EditorPlugin
var _session: Session
var _menu: Menu
var _adder: SceneAdder
var _title: String
var _chooser: FileChooser = FileChooser.new()
# The scene that was edited when the work began.
var _scene: WeakRef = weakref(null)


func enter(plugin: EditorPlugin, session: Session) -> void:
	_plugin = plugin
	_session = session
	_chooser.set_translation_domain(get_translation_domain())
	_add_setting(EditorInterface.get_editor_settings())
	_adder = SceneAdder.new(plugin.get_undo_redo())
	_adder.set_translation_domain(get_translation_domain())
	_adder.added.connect(session.view.show_whole.unbind(1))
	panel = PhotosPanel.new(session)
	panel.folder_wanted.connect(_choose_folder)
	panel.marker_wanted.connect(_choose_marker)
	panel.made.connect(_on_made)
	panel.begins.connect(_on_begins)
	window = AcceptDialog.new()
	window.set_translation_domain(get_translation_domain())
	window.title = tr("New Tree from Photos")
	window.ok_button_text = tr("Close")
	window.exclusive = false
	window.add_child(panel)
	window.files_dropped.connect(_on_dropped)
	window.visible = false
	EditorInterface.get_base_control().add_child(window)
	_title = tr("New Tree from Photos…")
	plugin.add_tool_menu_item(_title, open.bind(""))
	_menu = Menu.new()
	_menu.set_translation_domain(get_translation_domain())
	_menu.chosen.connect(open)
	plugin.add_context_menu_plugin(EditorContextMenuPlugin.CONTEXT_SLOT_FILESYSTEM, _menu)
	session.photos_wanted.connect(open.bind(""))
	session.tree_changed.connect(_on_tree_changed)
	plugin.get_tree().process_frame.connect(_on_frame)


func exit() -> void:
	_plugin.get_tree().process_frame.disconnect(_on_frame)
	_session.tree_changed.disconnect(_on_tree_changed)
	_session.photos_wanted.disconnect(open)
	_plugin.remove_context_menu_plugin(_menu)
	_menu = null
	_plugin.remove_tool_menu_item(_title)
	panel.close()
	window.queue_free()
	window = null
	panel = null
	_chooser.close()
	_adder = null
	_session = null
	_plugin = null


## Shows the window, with another folder of photos if [param folder] names one.
func open(folder: String) -> void:
	if not folder.is_empty():
		panel.show_folder(folder)
	if window.visible:
		window.grab_focus()
	else:
		window.popup_centered_clamped(
			Vector2i(Vector2(760, 640) * EditorInterface.get_editor_scale()), 0.9
		)


## Has the leaves of the edited tree keep the colors of its photos when they are of another kind
## now, by a step or its undoing.
static func suit_leaves(session: Session) -> void:
	if session.node == null or session.tree == null:
		return
	var material: ShaderMaterial = session.node.leaf_material as ShaderMaterial
	if not PhotoLeaves.is_outdated(material, session.tree):
		return
	if not PhotoLeaves.suit(material, session.tree) or not PhotoLeaves.is_file(material):
		return
	var error: Error = ResourceSaver.save(material)
	if error != OK:
		session.say(
			session.tr("%s can't be written: %s.") % [material.resource_path, error_string(error)],
			Session.Kind.ERROR
		)


func _on_frame() -> void:
	panel.update()


func _on_tree_changed() -> void:
	suit_leaves(_session)


func _on_begins() -> void:
	panel.colmap = EditorInterface.get_editor_settings().get_setting(SETTING)
	_scene = weakref(EditorInterface.get_edited_scene_root())


# It comes into the scene that was edited when it began; another one may be none of its business.
func _on_made(tree: TreeReconstruction) -> void:
	var scene: Node = EditorInterface.get_edited_scene_root()
	var is_in_scene: bool = scene == _scene.get_ref()
	if is_in_scene:
		var trees: Array[TreeReconstruction] = [tree]
		var nodes: Array[TreeInstance3D] = _adder.add(trees, FreePlace.in_view(trees))
		if not nodes.is_empty():
			_session.view.want(nodes[0])
	panel.say_where(tree, is_in_scene)
	EditorInterface.get_editor_toaster().push_toast(
		tr("The tree of photos is ready: %s") % tree.resource_path, EditorToaster.SEVERITY_INFO
	)


func _choose_folder() -> void:
	_chooser.open(
		window,
		EditorFileDialog.FILE_MODE_OPEN_ANY,
		tr("Choose Photos"),
		panel.show_folder,
		["*." + ", *.".join(PhotoFolder.FILMS) + ";" + tr("Films")]
	)


func _choose_marker() -> void:
	_chooser.open(
		window,
		EditorFileDialog.FILE_MODE_SAVE_FILE,
		tr("Save Marker to Print"),
		panel.save_marker,
		["*.svg;" + tr("Drawing in millimetres"), "*.png;" + tr("Picture at 300 dpi")],
		"marker.svg"
	)


# A folder, a film, or photos out of one folder.
func _on_dropped(files: PackedStringArray) -> void:
	if files.is_empty():
		return
	var first: String = files[0]
	var is_whole: bool = (
		DirAccess.dir_exists_absolute(first) or not PhotoFolder.film_of(first).is_empty()
	)
	panel.show_folder(first if is_whole else first.get_base_dir())


static func _add_setting(settings: EditorSettings) -> void:
	if not settings.has_setting(SETTING):
		settings.set_setting(SETTING, "")
	settings.set_initial_value(SETTING, "", false)
	settings.add_property_info(
		{"name": SETTING, "type": TYPE_STRING, "hint": PROPERTY_HINT_GLOBAL_FILE}
	)
