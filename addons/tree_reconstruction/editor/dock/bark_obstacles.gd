@tool
extends RefCounted
## Nodes of the scene that are chosen, or dragged from the Scene dock, as obstacles of bark.

const BarkWork := preload("../bark/bark_work.gd")
const SceneObstacles := preload("../bark/scene_obstacles.gd")
const Session := preload("../session.gd")
const Widgets := preload("widgets.gd")

var button: Button

var _session: Session


## [param target]: what nodes can be dropped on.
func _init(session: Session, target: Control) -> void:
	_session = session
	button = (Widgets.button(
		"From the Scene…",
		(
			"An obstacle that is a node of this scene, such as a fence: a mesh, a CSG shape or a"
			+ " collision shape, with all below it. You can drag nodes from the Scene dock onto the"
			+ " list as well."
		),
		&"Node3D"
	))
	button.pressed.connect(choose.bind(session))
	target.set_drag_forwarding(Callable(), _can_drop, _drop)


## Asks for a node.
static func choose(session: Session) -> void:
	if Engine.is_editor_hint() and session.node != null:
		EditorInterface.popup_node_selector(_on_chosen.bind(weakref(session)), SceneObstacles.TYPES)


## Whether a drag carries nodes.
static func are_nodes(data: Variant) -> bool:
	return data is Dictionary and (data as Dictionary).get("type", "") == "nodes"


## Makes the nodes of a drag obstacles.
static func take(session: Session, data: Dictionary) -> void:
	for path: NodePath in data.nodes as Array:
		var node: Node = session.node.get_node_or_null(path)
		if node != null:
			(BarkWork.of(session) as BarkWork).scene.add(node)


static func _on_chosen(path: NodePath, of: WeakRef) -> void:
	var session: Session = of.get_ref()
	var root: Node = EditorInterface.get_edited_scene_root()
	if path.is_empty() or session == null or session.node == null or root == null:
		return
	(BarkWork.of(session) as BarkWork).scene.add(root.get_node(path))


func _can_drop(_at: Vector2, data: Variant) -> bool:
	return _session.node != null and are_nodes(data)


func _drop(_at: Vector2, data: Variant) -> void:
	take(_session, data as Dictionary)
