@tool
extends RefCounted
## Has the editor drawn seldom. Without a graphics card that takes most of a frame, and a scenario
## goes through thousands of them only to move the mouse and to wait. What the editor has set of its
## viewports stays as it is.

# Milliseconds from one picture to the next.
const _PAUSE: int = 1000
# Microseconds that a frame takes at least. No user does anything in less, and who waits leaves the
# cores to others.
const _FRAME: int = 30_000

## Whether each frame is drawn after all, as for a picture.
var suspended: bool = false

# Every viewport in the window.
var _views: Array[WeakRef] = []
var _next: int = 0
# What the editor has set of its frames.
var _frame: int = 0


## From now on.
func begin() -> void:
	_frame = OS.low_processor_usage_mode_sleep_usec
	OS.low_processor_usage_mode_sleep_usec = _FRAME
	for view: Node in _tree().root.find_children("*", "SubViewport", true, false):
		_on_node_added(view)
	_tree().node_added.connect(_on_node_added)
	_tree().process_frame.connect(_on_frame)


## All is as it was before.
func end() -> void:
	_tree().process_frame.disconnect(_on_frame)
	_tree().node_added.disconnect(_on_node_added)
	OS.low_processor_usage_mode_sleep_usec = _frame
	_draw(_tree().root, RenderingServer.VIEWPORT_UPDATE_WHEN_VISIBLE)
	for reference: WeakRef in _views:
		var view: SubViewport = reference.get_ref()
		if view != null:
			# Their numbers are the same.
			_draw(view, view.render_target_update_mode as RenderingServer.ViewportUpdateMode)
	_views.clear()


func _on_node_added(node: Node) -> void:
	if node is SubViewport:
		_views.append(weakref(node))


# The server draws once what is to be drawn once, and then no more.
func _on_frame() -> void:
	var now: int = Time.get_ticks_msec()
	if not suspended and now < _next:
		return
	_next = now + _PAUSE
	_draw(_tree().root, RenderingServer.VIEWPORT_UPDATE_ONCE)
	_views = _views.filter(func(view: WeakRef) -> bool: return view.get_ref() != null)
	for reference: WeakRef in _views:
		var view: SubViewport = reference.get_ref()
		var above: Control = view.get_parent() as Control
		if view.disable_3d or above == null or not above.is_visible_in_tree():
			continue
		if view.render_target_update_mode > SubViewport.UPDATE_ONCE:
			_draw(view, RenderingServer.VIEWPORT_UPDATE_ONCE)


static func _draw(view: Viewport, mode: RenderingServer.ViewportUpdateMode) -> void:
	RenderingServer.viewport_set_update_mode(view.get_viewport_rid(), mode)


static func _tree() -> SceneTree:
	return Engine.get_main_loop() as SceneTree
