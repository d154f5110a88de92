@tool
extends RefCounted
## Hides the edited tree's bark and leaves, and stills its wind, in the rendering server alone: the
## scene knows nothing of it, and nothing of it is saved.

const Session: GDScript = preload("../session.gd")
const OwnMaterials: GDScript = preload("../../nodes/own_materials.gd")
const LeafNodes: GDScript = preload("../../nodes/tree_leaf_nodes.gd")

var _session: Session
var _node: TreeInstance3D
var _channel: int = 0
# Which instances the server was told to show, or to hide: telling it again would make the editor
# draw.
var _told: Dictionary[RID, bool] = {}


func _init(session: Session) -> void:
	_session = session


## Another node is edited, or none: the one before is shown as its scene says again.
func take(node: TreeInstance3D) -> void:
	if node != _node:
		if is_instance_valid(_node):
			_apply(true, true, _node.wind)
			_show_channel(0)
			_node.visibility_changed.disconnect(_forget)
			_node.tree_entered.disconnect(_forget)
		_forget()
		_node = node
		if node != null:
			node.visibility_changed.connect(_forget)
			node.tree_entered.connect(_forget)
	update()


## To be called once a frame, since the node sets its instances anew on many occasions.
func update() -> void:
	if is_instance_valid(_node):
		_apply(_session.view.mesh, _session.view.leaves, _session.view.wind and _node.wind)
		_show_channel(_session.view.channel)


# Each frame while there is one, since the node sets its materials anew when it was built.
func _show_channel(channel: int) -> void:
	if channel != 0 or _channel != 0:
		TreeWind.show_channel(_node, channel as TreeWind.Channel)
	_channel = channel


# The engine has told the server itself.
func _forget() -> void:
	_told.clear()


func _apply(bark: bool, leaves: bool, wind: bool) -> void:
	if not _node.is_inside_tree():
		return
	var seen: bool = _node.is_visible_in_tree()
	_set_up(_node, seen and bark, wind)
	var foliage: LeafNodes = _node.get(&"_foliage")
	for bearer: GeometryInstance3D in foliage.nodes:
		_set_up(bearer, seen and leaves, wind)


func _set_up(instance: GeometryInstance3D, seen: bool, wind: bool) -> void:
	if _told.get(instance.get_instance()) != seen:
		_told[instance.get_instance()] = seen
		RenderingServer.instance_set_visible(instance.get_instance(), seen)
	OwnMaterials.tell(instance, &"tree_wind", 1.0 if wind else 0.0)
