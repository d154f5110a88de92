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
const ViewPlane := preload("view_plane.gd")
# In metres, of a tree that is made to see how high it would be.
const _TRIED_HEIGHT: float = 10.0
# A tree whose base is drawn by less off where it was, in pixels of the canvas, stays there.
const _LEAST_MOVE: float = 0.05


## One sketch to be made.
class Order:
	extends RefCounted

	var kind: Kind = Kind.STEP
	## Of the step of the history.
	var title: String = ""
	var sketch: TreeSketch
	## The edits that the user did by hand, which are done again.
	var log: String = ""
	## The sheet that it was drawn on in the 3D view, whose scale decides the tree's height, or
	## [code]null[/code].
	var plane: ViewPlane
	## What became of these.
	var replayed: Dictionary = {}
	## What was understood of the strokes.
	var report: Dictionary = {}
	## Why no tree came of them.
	var sentence: String = ""

	## Where the tree stands that was drawn on a sheet, in the world.
	func get_place() -> Transform3D:
		var at: Array = report.get("base", [plane.stem_base.x, plane.stem_base.y])
		return (plane.moved_to(Vector2(at[0], at[1])) as ViewPlane).frame

	## The same as a transform of [param node]; [code]null[/code] where that stands there already.
	func get_place_of(node: TreeInstance3D) -> Variant:
		var parent: Node3D = node.get_parent_node_3d()
		var wanted: Transform3D = get_place()
		if parent != null:
			wanted = parent.global_transform.affine_inverse() * wanted
		var off: float = wanted.origin.distance_to(node.transform.origin)
		var same: bool = off < _LEAST_MOVE * plane.pixel
		return null if same and wanted.basis.is_equal_approx(node.transform.basis) else wanted


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


## Makes a finished sketch, whose tree was edited by [param log]. With a [param plane] it becomes as
## large as it was drawn there.
func make(title: String, sketch: TreeSketch, log: String, plane: ViewPlane = null) -> void:
	var order: Order = _order(Kind.STEP, sketch, log)
	order.plane = plane
	order.title = title
	_steps.append(order)
	_follow = null
	_begin()


## Makes a sketch under way, unless another one comes first.
func follow(sketch: TreeSketch, log: String, plane: ViewPlane = null) -> void:
	_follow = _order(Kind.FOLLOW, sketch, log)
	_follow.plane = plane
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
	var sketch: TreeSketch = order.sketch if order.plane == null else _sized(worker, order)
	var made: TreeReconstruction = null if sketch == null else worker.sketch_tree(sketch)
	if made == null:
		order.sentence = worker.get_error_message()
		return null
	order.report = worker.get_report()
	if order.log.is_empty() or order.kind == Kind.READ:
		return made
	var again: Array = Rerun.edit_again(running, made, order.log)
	order.replayed = again[1]
	return again[0]


# The sketch with the height by which a pixel of its canvas is as long as on its sheet: how many of
# them the tree is high is only known once the strokes are understood. Without twigs, that is quick.
static func _sized(worker: TreeReconstructor, order: Order) -> TreeSketch:
	var tried: TreeSketch = order.sketch.duplicate() as TreeSketch
	tried.height = _TRIED_HEIGHT
	tried.density = 0.0
	tried.trunk_radius = 0.0
	if worker.sketch_tree(tried) == null:
		return null
	var sized: TreeSketch = order.sketch.duplicate() as TreeSketch
	sized.height = (
		_TRIED_HEIGHT * order.plane.pixel / (worker.get_report()["metres_per_pixel"] as float)
	)
	return sized


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
