@tool
extends RefCounted
## Hides the edited tree's bark and leaves, and stills its wind, in the rendering server alone: the
## scene knows nothing of it, and nothing of it is saved.

const Session: GDScript = preload("../session.gd")
const OwnMaterials: GDScript = preload("../../nodes/own_materials.gd")
const LeafNodes: GDScript = preload("../../nodes/tree_leaf_nodes.gd")
const LevelNodes: GDScript = preload("../../nodes/tree_level_nodes.gd")

var _session: Session
var _node: TreeInstance3D
var _channel: int = 0
# Whether the further levels of detail are hidden, too.
var _levels_gone: bool = false
# Which instances the server was told to show, or to hide: telling it again would make the editor
# draw.
var _told: Dictionary[RID, bool] = {}


func _init(session: Session) -> void:
	_session = session


## Another node is edited, or none: the one before is shown as its scene says again.
func take(node: TreeInstance3D) -> void:
	if node != _node:
		if is_instance_valid(_node):
			_apply(true, true, _node.wind, false)
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
		var view: Session.ViewState = _session.view
		var tree: bool = not view.growing
		_apply(view.mesh and tree, view.leaves and tree, view.wind and _node.wind, view.growing)
		_show_channel(_session.view.channel)


# Each frame while there is one, since the node sets its materials anew when it was built.
func _show_channel(channel: int) -> void:
	if channel != 0 or _channel != 0:
		TreeWind.show_channel(_node, channel as TreeWind.Channel)
	_channel = channel


# The engine has told the server itself.
func _forget() -> void:
	_told.clear()


func _apply(bark: bool, leaves: bool, wind: bool, growing: bool) -> void:
	if not _node.is_inside_tree():
		return
	var seen: bool = _node.is_visible_in_tree()
	_set_up(_node, seen and bark, wind)
	var foliage: LeafNodes = _node.get(&"_foliage")
	for bearer: GeometryInstance3D in foliage.nodes:
		_set_up(bearer, seen and leaves, wind)
	if growing or _levels_gone:
		_levels_gone = growing
		var levels: LevelNodes = _node.get(&"_levels")
		var parts: Array[GeometryInstance3D] = levels.get_barks()
		for of_level: LeafNodes in levels.get_foliage():
			parts.append_array(of_level.nodes)
		for part: GeometryInstance3D in parts:
			_tell(part, seen and not _levels_gone)


func _set_up(instance: GeometryInstance3D, seen: bool, wind: bool) -> void:
	_tell(instance, seen)
	OwnMaterials.tell(instance, &"tree_wind", 1.0 if wind else 0.0)


func _tell(instance: GeometryInstance3D, seen: bool) -> void:
	if _told.get(instance.get_instance()) != seen:
		_told[instance.get_instance()] = seen
		RenderingServer.instance_set_visible(instance.get_instance(), seen)
