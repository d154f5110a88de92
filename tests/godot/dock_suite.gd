extends "./suite.gd"
## The dock "Tree" on a session with a plain undo history, for tests that press its buttons as a
## user would.

const Session := preload("res://addons/tree_reconstruction/editor/session.gd")
const Dock := preload("res://addons/tree_reconstruction/editor/dock/dock.gd")

var _undo: UndoRedo
var _session: Session
var _dock: Dock
var _said: PackedStringArray = []


func _begin(made: TreeReconstruction) -> void:
	_undo = UndoRedo.new()
	var node: TreeInstance3D = TreeInstance3D.new()
	node.reconstruction = made
	tree.root.add_child(node)
	_session = Session.new(_undo)
	_session.said.connect(_on_said)
	_session.edit_node(node)
	_dock = Dock.new(_session)
	_dock.progress.patience = 0
	tree.root.add_child(_dock)
	_dock.set_folded([])
	_frame()


func _on_said(sentence: String, _kind: int) -> void:
	_said.append(sentence)


func _frame() -> void:
	_session.update()
	_dock.update()


func _finish() -> void:
	while not _session.jobs.get_running().is_empty():
		await tree.process_frame
		_frame()


func _end() -> void:
	var node: TreeInstance3D = _session.node
	_dock.close()
	_dock.free()
	_session.shut_down()
	_undo.clear_history()
	_undo.free()
	if node != null:
		node.free()


func _scanned() -> TreeReconstruction:
	return TreeReconstructor.new().reconstruct_file(write_scan("small.xyz"))
