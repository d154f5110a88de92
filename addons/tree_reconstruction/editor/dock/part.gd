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
# Whether the dock stood in front of the inspector when the last tree was let go.
var _was_in_front: bool = false


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


# The first tree of a project shows where the dock is; from then on the user decides. Of whatever
# else is selected it knows nothing: where it stands in front of the inspector, that comes back
# then, and the dock with the next tree.
func _on_node_changed() -> void:
	var settings: EditorSettings = EditorInterface.get_editor_settings()
	if _session.node == null:
		_step_back.call_deferred()
		return
	if not settings.get_project_metadata("tree_reconstruction", _SEEN, false):
		settings.set_project_metadata("tree_reconstruction", _SEEN, true)
		_host.make_visible()
	elif _was_in_front:
		_bring_to_front(_host)
	_was_in_front = false


# Once the editor has taken up what was selected instead.
func _step_back() -> void:
	if _session == null or _session.node != null:
		return
	var inspected: Object = EditorInterface.get_inspector().get_edited_object()
	if inspected == null or not _host.is_visible_in_tree():
		return
	_was_in_front = _bring_to_front(EditorInterface.get_inspector())


# Turns to the tab that a control is in, if it is one of those that the dock is among.
func _bring_to_front(control: Control) -> bool:
	var tabs: TabContainer = _host.get_parent() as TabContainer
	if tabs == null or not tabs.is_ancestor_of(control):
		return false
	while control.get_parent() != tabs:
		control = control.get_parent() as Control
	var tab: int = tabs.get_tab_idx_from_control(control)
	if tab < 0 or tab == tabs.current_tab:
		return false
	tabs.current_tab = tab
	return true
