@tool
extends RefCounted
## Makes trees of sketches, one after another, on a worker: those that the user finished in their
## order, each a step of its own, and, where nothing else waits, the latest of a stroke under way.

## A finished sketch became [param made], with the user's edits, or [code]null[/code].
signal finished(order: Order, made: TreeReconstruction)
## The same of a sketch under way.
signal followed(order: Order, made: TreeReconstruction)
## A sketch was read again, without need of its tree.
signal understood(order: Order)

enum Kind { STEP, FOLLOW, READ }

const Session := preload("../session.gd")
const Jobs := preload("../jobs.gd")
const Rerun := preload("../dock/rerun.gd")


## One sketch to be made.
class Order:
	extends RefCounted

	var kind: Kind = Kind.STEP
	## Of the step of the history.
	var title: String = ""
	var sketch: TreeSketch
	## The edits that the user did by hand, which are done again.
	var log: String = ""
	## What became of these.
	var replayed: Dictionary = {}
	## What was understood of the strokes.
	var report: Dictionary = {}
	## Why no tree came of them.
	var sentence: String = ""


var _session: Session
var _worker: TreeReconstructor = TreeReconstructor.new()
var _steps: Array[Order] = []
var _follow: Order
var _read: Order
var _job: Jobs.Job
var _at_work: Order


func _init(session: Session) -> void:
	set_translation_domain(session.get_translation_domain())
	_session = session
	_session.jobs.changed.connect(_on_jobs_changed)


## Ends its part in the session. What runs is ended by the session.
func close() -> void:
	_session.jobs.changed.disconnect(_on_jobs_changed)
	forget()
	if _job != null:
		_session.jobs.cancel(_job)
	_at_work = null


## Whether a finished sketch waits or is made.
func is_busy() -> bool:
	return not _steps.is_empty() or (_at_work != null and _at_work.kind == Kind.STEP)


## Whether a sketch under way is made or waits.
func is_following() -> bool:
	return _follow != null or (_at_work != null and _at_work.kind == Kind.FOLLOW)


## Makes a finished sketch, whose tree was edited by [param log].
func make(title: String, sketch: TreeSketch, log: String) -> void:
	var order: Order = _order(Kind.STEP, sketch, log)
	order.title = title
	_steps.append(order)
	_follow = null
	_begin()


## Makes a sketch under way, unless another one comes first.
func follow(sketch: TreeSketch, log: String) -> void:
	_follow = _order(Kind.FOLLOW, sketch, log)
	_begin()


## Reads a sketch for what is understood of it.
func read(sketch: TreeSketch) -> void:
	_read = _order(Kind.READ, sketch, "")
	_begin()


## Drops what is under way, so that no more of it comes.
func stop_following() -> void:
	_follow = null


## Drops all that waits.
func forget() -> void:
	_steps.clear()
	_follow = null
	_read = null


func _order(kind: Kind, sketch: TreeSketch, log: String) -> Order:
	var order: Order = Order.new()
	order.kind = kind
	order.sketch = sketch
	order.log = log
	return order


func _begin() -> void:
	if _at_work != null:
		return
	if not _steps.is_empty():
		_at_work = _steps.pop_front()
	elif _follow != null:
		_at_work = _follow
		_follow = null
	elif _read != null:
		_at_work = _read
		_read = null
	else:
		return
	_job = _session.jobs.start(
		tr("A tree of strokes"), _make.bind(_worker, _at_work), _on_made.bind(_at_work), _worker
	)


static func _make(running: Jobs.Job, worker: TreeReconstructor, order: Order) -> TreeReconstruction:
	if order.sketch.strokes.is_empty():
		return null
	var made: TreeReconstruction = worker.sketch_tree(order.sketch)
	if made == null:
		order.sentence = worker.get_error_message()
		return null
	order.report = worker.get_report()
	if order.log.is_empty() or order.kind == Kind.READ:
		return made
	var again: Array = Rerun.edit_again(running, made, order.log)
	order.replayed = again[1]
	return again[0]


func _on_made(made: TreeReconstruction, _ended: Jobs.Job, order: Order) -> void:
	_job = null
	_at_work = null
	match order.kind:
		Kind.STEP:
			finished.emit(order, made)
		Kind.FOLLOW:
			if made != null:
				followed.emit(order, made)
		Kind.READ:
			understood.emit(order)
	_begin()


func _on_jobs_changed() -> void:
	# One that was cancelled, as in the dock, ends without a word.
	if _job == null or not _job.cancelled or _job in _session.jobs.get_running():
		return
	var order: Order = _at_work
	_job = null
	_at_work = null
	if order.kind == Kind.STEP:
		finished.emit(order, null)
	_begin()
