@tool
extends RefCounted
## The scan of the edited tree, in the tree's space, and how true the tree is to it. Read again
## from its file, on a thread, when somebody asks.

## The points came, or went.
signal changed
## [member fidelity] measured the tree.
signal fidelity_changed

const Jobs := preload("jobs.gd")

## At most so many points are shown and measured against.
const MAXIMUM_POINTS: int = 1_000_000

var points: PackedVector3Array
## As many as points, or none.
var colors: PackedColorArray
## Measured, or [code]null[/code].
var fidelity: TreeFidelity

var _jobs: Jobs
var _say: Callable
var _tree: TreeReconstruction
var _source: String
var _loading: Jobs.Job
var _measuring: Jobs.Job
var _wanted: bool = false
var _watching: bool = false
var _outdated: bool = false


func _init(jobs: Jobs, say: Callable) -> void:
	_jobs = jobs
	_say = say


## Another tree is edited, or none. One of the same scan keeps its points.
func set_tree(tree: TreeReconstruction) -> void:
	if tree == _tree:
		return
	var source: String = "" if tree == null else tree.provenance.get("source", "")
	var same: bool = (
		not source.is_empty()
		and source == _source
		and _tree != null
		and _tree.skeleton.get("frame") == tree.skeleton.get("frame")
		and _tree.skeleton.get("up_axis") == tree.skeleton.get("up_axis")
	)
	_tree = tree
	_source = source
	if same:
		note_edit()
		return
	_drop()


## Loads the points if they aren't there.
func request() -> void:
	if _tree == null or not points.is_empty() or _loading != null:
		return
	if _source.is_empty():
		_say.call(tr("This tree wasn't made of a scan, so there are no points to show."))
		return
	var reader: TreeReconstructor = TreeReconstructor.new()
	var tree: TreeReconstruction = _tree
	_loading = _jobs.start(
		tr("Reading the scan"),
		func(_job: Jobs.Job) -> bool: return reader.load_cloud(tree, MAXIMUM_POINTS),
		_on_loaded.bind(reader),
		reader
	)


## Whether the points are on their way.
func is_loading() -> bool:
	return _loading != null


## Measures the tree against its scan, now and after every edit until [method stop_measuring].
func measure() -> void:
	_watching = true
	_outdated = true
	request()
	_measure()


## Measures no more.
func stop_measuring() -> void:
	_watching = false


## The tree was edited.
func note_edit() -> void:
	_outdated = true
	if _watching:
		_measure()


## To be called once a frame: forgets work that was cancelled.
func update() -> void:
	if _loading != null and not _loading in _jobs.get_running():
		_loading = null
	if _measuring != null and not _measuring in _jobs.get_running():
		_measuring = null


func _drop() -> void:
	if _loading != null:
		_jobs.cancel(_loading)
		_loading = null
	_measuring = null
	var had: bool = not points.is_empty()
	points = PackedVector3Array()
	colors = PackedColorArray()
	fidelity = null
	_outdated = true
	if had:
		changed.emit()


func _on_loaded(success: bool, job: Jobs.Job, reader: TreeReconstructor) -> void:
	if job != _loading:
		return
	_loading = null
	if not success:
		_say.call(reader.get_error_message())
		return
	points = reader.get_cloud_points()
	colors = reader.get_cloud_colors()
	changed.emit()
	if _watching:
		_measure()


func _measure() -> void:
	if not _outdated or points.is_empty() or _measuring != null or _tree == null:
		return
	_outdated = false
	var measured: TreeFidelity = fidelity
	var tree: TreeReconstruction = _tree
	var cloud: PackedVector3Array = points
	var work: Callable = func(_job: Jobs.Job) -> TreeFidelity:
		if measured == null:
			measured = TreeFidelity.new()
			if not measured.set_cloud(tree, cloud, 0.02):
				return null
		return null if measured.update(tree).is_empty() else measured
	_measuring = _jobs.start(tr("Comparing the tree with its scan"), work, _on_measured)


func _on_measured(measured: TreeFidelity, job: Jobs.Job) -> void:
	if job != _measuring:
		return
	_measuring = null
	if measured != null:
		fidelity = measured
		fidelity_changed.emit()
	if _watching and _outdated:
		_measure()
