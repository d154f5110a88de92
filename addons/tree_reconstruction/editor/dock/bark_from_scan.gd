@tool
extends RefCounted
## Lumps and dents that the scan of the edited tree shows, found on a thread, as lines of a recipe.

## What the scan shows; empty where that is nothing.
signal proposed(lines: String)

const Session := preload("../session.gd")
const Widgets := preload("widgets.gd")

var button: Button

var _session: Session
# Tells the recipe that is edited, as text.
var _recipe: Callable
var _job: Session.Jobs.Job
# The tree whose scan is being read for this, by its instance id; 0: none.
var _waiting: int = 0


func _init(session: Session, recipe: Callable) -> void:
	_session = session
	_recipe = recipe
	button = (
		Widgets
		. button(
			"From the Scan",
			(
				"Adds burls and hollows where the scan shows lumps and deep dents, to be changed or removed."
				+ " Nothing grows before you press Grow."
			),
			&"Search"
		)
	)
	button.pressed.connect(_on_pressed)
	_session.scan_changed.connect(_on_scan_changed)
	_session.jobs.changed.connect(_on_jobs_changed)


func close() -> void:
	_session.scan_changed.disconnect(_on_scan_changed)
	_session.jobs.changed.disconnect(_on_jobs_changed)
	if _job != null:
		_session.jobs.cancel(_job)


## To be called as often as the section is refreshed.
func refresh() -> void:
	var scanned: bool = not Session.ScanData.source_of(_session.tree).is_empty()
	button.disabled = not scanned or _session.tree.is_empty() or _job != null


func _on_pressed() -> void:
	if _session.tree == null or _job != null:
		return
	if _session.scan.wood.is_empty():
		_waiting = _session.tree.get_instance_id()
		_session.scan.request()
	else:
		_start()


func _start() -> void:
	_waiting = 0
	var worker: TreeReconstructor = TreeReconstructor.new()
	# The tree may be edited meanwhile: trees are replaced, never changed, so this takes no time.
	var of: TreeReconstruction = TreeReconstruction.new()
	of.take_tree_of(_session.tree)
	var recipe: String = _recipe.call()
	var points: PackedVector3Array = _session.scan.wood
	_job = _session.jobs.start(
		tr("Lumps of %s") % _session.node.name,
		func(_running: Session.Jobs.Job) -> String:
			return worker.propose_growth(of, points, recipe),
		_on_found.bind(worker, _session.tree.get_instance_id()),
		worker
	)
	refresh()


func _on_found(
	lines: String, _ended: Session.Jobs.Job, worker: TreeReconstructor, tree: int
) -> void:
	_job = null
	refresh()
	if not worker.get_error_message().is_empty():
		_session.say(worker.get_error_message(), Session.Kind.ERROR)
		return
	if _session.tree == null or _session.tree.get_instance_id() != tree:
		_session.say(
			tr("Another tree is selected now, so what its scan shows is left out."),
			Session.Kind.WARNING
		)
		return
	var report: Dictionary = worker.get_report()
	for warning: String in report.warnings:
		_session.say(warning, Session.Kind.WARNING)
	if not lines.is_empty():
		_session.say(
			(
				tr("From the scan: %d burls and %d hollows are in the list. Grow shows them.")
				% [report.burls, report.hollows]
			),
			Session.Kind.INFO
		)
		if report.sections > 0:
			_session.say(
				(
					tr("Where the wood is not round, it takes the scan's outline: at %d places.")
					% report.sections
				),
				Session.Kind.INFO
			)
	elif report.warnings.is_empty():
		_session.say(tr("The scan shows no lumps on this tree's bark."), Session.Kind.INFO)
	proposed.emit(lines)


func _on_scan_changed() -> void:
	if _waiting == 0:
		return
	if _session.tree == null or _session.tree.get_instance_id() != _waiting:
		_waiting = 0
	elif not _session.scan.wood.is_empty() and _job == null:
		_start()


# One that was cancelled ends without a word.
func _on_jobs_changed() -> void:
	if _job != null and _job.cancelled and not _job in _session.jobs.get_running():
		_job = null
		refresh()
