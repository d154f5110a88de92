@tool
extends RefCounted
## Looks for a branch in the scan that the tree lacks, on a thread, and grows it as one step.

## It ended: with the branch's nodes, or with none.
signal ended(added: PackedInt32Array)

const Session := preload("../session.gd")

var _session: Session
var _title: String
# Waits for the scan: the node, the direction and the options.
var _waiting: Array = []
var _job: Session.Jobs.Job


func _init(session: Session) -> void:
	set_translation_domain(session.get_translation_domain())
	_session = session


## Whether it looks, or waits for the scan's points.
func is_busy() -> bool:
	return not _waiting.is_empty() or _job != null


## Looks from node [param id] in a direction of the tree's space. Options are those of [method
## TreeReconstruction.complete_branch].
func find(title: String, id: int, direction: Vector3, options: Dictionary) -> void:
	cancel()
	_title = title
	if _session.scan.points.is_empty():
		_waiting = [id, direction, options]
		_session.scan_changed.connect(_on_scan_changed)
		_session.scan.request()
		if not _session.scan.is_loading():
			cancel()
		return
	var tree: TreeReconstruction = _session.tree
	_job = _session.jobs.start(
		tr("Looking for the missing branch"),
		_search.bind(tree, _session.scan.wood, id, direction, options),
		_on_found.bind(tree, tree.get_bark_revision())
	)


## Forgets what was asked for.
func cancel() -> void:
	_waiting = []
	if _session.scan_changed.is_connected(_on_scan_changed):
		_session.scan_changed.disconnect(_on_scan_changed)
	if _job != null:
		_session.jobs.cancel(_job)
		_job = null


static func _search(
	_of: Session.Jobs.Job,
	tree: TreeReconstruction,
	points: PackedVector3Array,
	id: int,
	direction: Vector3,
	options: Dictionary
) -> Dictionary:
	return tree.preview_completion(points, id, direction, options)


func _on_scan_changed() -> void:
	var asked: Array = _waiting
	cancel()
	if not asked.is_empty() and not _session.scan.points.is_empty():
		find(_title, asked[0], asked[1], asked[2])


func _on_found(
	found: Dictionary, job: Session.Jobs.Job, tree: TreeReconstruction, revision: int
) -> void:
	if job != _job:
		return
	_job = null
	var added: PackedInt32Array = []
	var error: String = found["error"]
	if _session.tree != tree or tree.get_bark_revision() != revision:
		error = tr("The tree was changed while the scan was searched. Draw the arrow again.")
	if error.is_empty():
		var script: String = found["script"]
		var edit: TreeEdit = _session.run_edit(
			_title, func(of: TreeReconstruction) -> TreeEdit: return of.run_script(script)
		)
		if edit != null:
			added = edit.get_added_nodes()
			_session.say(found["message"])
	else:
		_session.say(error, _session.Kind.WARNING)
	ended.emit(added)
