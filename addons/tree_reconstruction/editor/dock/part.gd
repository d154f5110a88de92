@tool
extends RefCounted
## Puts the dock "Tree" into the editor.

const Session := preload("../session.gd")
const Dock := preload("dock.gd")
const Host := preload("host.gd")
const TwigDrop := preload("twig_drop.gd")

const _VIEWPORTS: int = 4
const _SEEN: String = "dock_seen"

var _plugin: EditorPlugin
var _host: Host
var _dock: Dock
var _session: Session
var _drops: Array[TwigDrop] = []


func enter(plugin: EditorPlugin, session: Session) -> void:
	_plugin = plugin
	_dock = Dock.new(session)
	_dock.set_translation_domain(get_translation_domain())
	_host = Host.new(_dock)
	_plugin.add_dock(_host)
	_session = session
	for i: int in _VIEWPORTS:
		var viewport: SubViewport = EditorInterface.get_editor_viewport_3d(i)
		var drop: TwigDrop = TwigDrop.new(session, viewport)
		drop.set_translation_domain(get_translation_domain())
		# Above what takes the mouse there.
		viewport.get_parent().get_parent().add_child(drop)
		_drops.append(drop)
	_session.node_changed.connect(_on_node_changed)


func exit() -> void:
	_session.node_changed.disconnect(_on_node_changed)
	for drop: TwigDrop in _drops:
		drop.queue_free()
	_drops.clear()
	_session = null
	_dock.close()
	_plugin.remove_dock(_host)
	_host.queue_free()
	_host = null
	_dock = null
	_plugin = null


# The first tree of a project shows where the dock is; from then on the user decides.
func _on_node_changed() -> void:
	var settings: EditorSettings = EditorInterface.get_editor_settings()
	if _session.node == null or settings.get_project_metadata("tree_reconstruction", _SEEN, false):
		return
	settings.set_project_metadata("tree_reconstruction", _SEEN, true)
	_host.make_visible()
