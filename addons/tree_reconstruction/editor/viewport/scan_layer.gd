@tool
extends RefCounted
## What layers of the gizmo that show the edited tree's scan have in common: they ask for it.

const Session: GDScript = preload("../session.gd")
const Gizmo: GDScript = preload("skeleton_gizmo.gd")

var layer: Gizmo.Layer = Gizmo.Layer.new()

var _session: Session
# The tree whose scan was asked for.
var _asked_of: TreeReconstruction


func _init(session: Session) -> void:
	set_translation_domain(session.get_translation_domain())
	_session = session
	layer.shown = false


# Shows the layer if the user [param asks] for it and the scan is there; asks for the scan where it
# isn't there yet. Returns whether it is shown.
func _show_if(asks: bool) -> bool:
	var wanted: bool = _session.tree != null and asks
	if not wanted:
		_asked_of = null
	elif _session.scan.points.is_empty() and _asked_of != _session.tree:
		# Once: what can't be read is not tried again after every edit.
		_asked_of = _session.tree
		_session.scan.request()
	layer.shown = wanted and not _session.scan.points.is_empty()
	return layer.shown
