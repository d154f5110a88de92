extends "./suite.gd"
## The editor's session on a plain undo history.

const Session := preload("res://addons/tree_reconstruction/editor/session.gd")

var _undo: UndoRedo
var _said: PackedStringArray = []


func _session_with(made: TreeReconstruction) -> Session:
	_undo = UndoRedo.new()
	var node: TreeInstance3D = TreeInstance3D.new()
	node.reconstruction = made
	tree.root.add_child(node)
	var session: Session = Session.new(_undo)
	session.said.connect(func(sentence: String, _kind: int) -> void: _said.append(sentence))
	session.edit_node(node)
	return session


func _end(session: Session) -> void:
	var node: TreeInstance3D = session.node
	session.shut_down()
	_undo.clear_history()
	_undo.free()
	node.free()
