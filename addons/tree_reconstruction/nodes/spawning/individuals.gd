@tool
extends RefCounted
## Builds the individuals of a forest, on worker threads or a slice per frame, and hands their
## meshes to the engine little by little.

const BuildJob := preload("../tree_build_job.gd")
const Individual := preload("individual.gd")
const Leftovers := preload("leftovers.gd")
# So much of meshes is handed over in one frame, or one surface.
const _BYTES_PER_FRAME: int = 1_000_000
# What is built and not handed over yet stays below so many surfaces.
const _BACKLOG: int = 64

# What there is by now, of all forests, by key; an individual goes when the last forest lets it go.
static var _known: Dictionary[String, WeakRef] = {}

## Whether individuals are built on worker threads.
var threaded: bool = true
## The bytes that the meshes of all may take. The first one is made in any case.
var budget: int = 0
## Those that are ready, by their place in the plans; [code]null[/code] where one is not (yet).
var ready: Array[Individual] = []
## How many there are to be: fewer than planned where the budget ends.
var accepted: int = 0
## The bytes of those that are accepted.
var bytes: int = 0

var _plans: Array[Individual] = []
var _next: int = 0
var _decided: int = 0
var _tasks: Dictionary[int, int] = {}
var _built: Dictionary[int, bool] = {}
var _uploads: Array[int] = []
var _upload_task: int = -1


## None is known any longer: a tree that they were made of has changed.
static func forget() -> void:
	_known = {}


## Begins with other plans; what was under way is dropped.
func start(plans: Array[Individual]) -> void:
	stop()
	_plans = plans
	ready = []
	ready.resize(plans.size())
	accepted = plans.size()
	_next = 0
	_decided = 0
	bytes = 0
	for i: int in plans.size():
		var known: Individual = null
		if _known.has(plans[i].key):
			known = _known[plans[i].key].get_ref() as Individual
		if known != null:
			_plans[i] = known
			_built[i] = true


## Ends what is under way. What workers are at ends by itself.
func stop() -> void:
	for plan: Individual in _plans:
		if not plan.is_given():
			plan.stale = true
	for place: int in _tasks:
		Leftovers.leave(_tasks[place], _plans[place])
	if _upload_task >= 0:
		Leftovers.leave(_upload_task, _plans[_uploads[0]])
	_upload_task = -1
	_tasks = {}
	_built = {}
	_uploads = []
	_plans = []
	ready = []
	accepted = 0


## All that are ready or to be.
func get_all() -> Array[Individual]:
	return _plans


## Whether all are ready.
func is_done() -> bool:
	return _decided >= accepted and _uploads.is_empty()


## The share that is ready.
func progress() -> float:
	var count: int = 0
	for one: Individual in ready:
		count += 1 if one != null else 0
	return 0.0 if accepted == 0 else float(count) / accepted


## Goes on until [param deadline] (see [method Time.get_ticks_usec]); returns the places of those
## that have become ready.
func poll(deadline: int) -> PackedInt32Array:
	if is_done():
		return []
	if threaded:
		_poll_tasks()
	else:
		_build_here(deadline)
	_decide()
	return _upload()


func _poll_tasks() -> void:
	for place: int in _tasks.keys():
		if WorkerThreadPool.is_task_completed(_tasks[place]):
			WorkerThreadPool.wait_for_task_completion(_tasks[place])
			_tasks.erase(place)
			_built[place] = true
	var most: int = maxi(OS.get_processor_count() - 1, 1)
	while _next < accepted and _tasks.size() < most and _backlog() < _BACKLOG:
		if not _built.has(_next):
			_tasks[_next] = WorkerThreadPool.add_task(
				_plans[_next].build, false, "Build a tree of a forest"
			)
		_next += 1


func _build_here(deadline: int) -> void:
	while _next < accepted and _backlog() < _BACKLOG and Time.get_ticks_usec() < deadline:
		if _built.has(_next):
			_next += 1
		elif not _plans[_next].step():
			_built[_next] = true
			_next += 1


func _backlog() -> int:
	var count: int = 0
	for place: int in _uploads:
		count += _plans[place].surfaces.size()
	return count


# In their order, so that the budget ends at the same one whichever thread was the fastest.
func _decide() -> void:
	while _decided < accepted and _built.has(_decided):
		var one: Individual = _plans[_decided]
		if _decided > 0 and bytes + one.bytes > budget:
			accepted = _decided
			for place: int in range(_decided, _plans.size()):
				if not _plans[place].is_given():
					_plans[place].stale = true
			return
		bytes += one.bytes
		if not one.is_given():
			one.prepare()
		_uploads.append(_decided)
		_decided += 1
		if not one.is_given():
			# Its materials have taken enough of this frame.
			return


func _upload() -> PackedInt32Array:
	var done: PackedInt32Array = []
	if _upload_task >= 0:
		if not WorkerThreadPool.is_task_completed(_upload_task):
			return done
		WorkerThreadPool.wait_for_task_completion(_upload_task)
		_upload_task = -1
	while not _uploads.is_empty() and _plans[_uploads[0]].is_given():
		var place: int = _uploads.pop_front()
		ready[place] = _plans[place]
		_known[_plans[place].key] = weakref(_plans[place])
		done.append(place)
	if not _uploads.is_empty():
		var next: Individual = _plans[_uploads[0]]
		if threaded and BuildJob.may_workers_draw():
			_upload_task = WorkerThreadPool.add_task(
				_give.bind(next), true, "Hand over a tree of a forest"
			)
		else:
			_give(next)
	return done


static func _give(one: Individual) -> void:
	var left: int = _BYTES_PER_FRAME - one.next_bytes()
	while one.give_surface():
		left -= one.next_bytes()
		if left < 0:
			break
