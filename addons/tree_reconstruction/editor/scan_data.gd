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
## Of leaves in the heat map.
const LEAF_COLOR: Color = Color(0.5, 0.5, 0.5)
## What [member fidelity] takes for true, in metres.
const TOLERANCE: float = 0.02

var points: PackedVector3Array
## As many as points, or none.
var colors: PackedColorArray
## The points that are wood: what [member fidelity] measures, and its indices count.
var wood: PackedVector3Array
## Measured, or [code]null[/code].
var fidelity: TreeFidelity

var _jobs: Jobs
var _say: Callable
var _tree: TreeReconstruction
var _source: String
# What it was made by, and where in the scan it stands: a new reconstruction has others.
var _provenance: Dictionary
var _frame: Array
var _loading: Jobs.Job
var _measuring: Jobs.Job
var _watching: bool = false
var _outdated: bool = false
# Indices of wood in points; empty where all are.
var _wood_indices: PackedInt32Array


func _init(jobs: Jobs, say: Callable) -> void:
	_jobs = jobs
	_say = say


## Where the scan of a tree lies, or nothing where the tree was not made of one.
static func source_of(tree: TreeReconstruction) -> String:
	if tree == null or tree.provenance.get("sketch") is TreeSketch:
		return ""
	return tree.provenance.get("source", "")


## Another tree is edited, or none, or it was reconstructed again. One of the same scan, in the same
## place, keeps its points.
func set_tree(tree: TreeReconstruction) -> void:
	var provenance: Dictionary = {} if tree == null else tree.provenance
	if tree == _tree and is_same(provenance, _provenance):
		return
	var source: String = source_of(tree)
	var skeleton: Dictionary = {} if tree == null else tree.skeleton
	var frame: Array = [skeleton.get("frame"), skeleton.get("up_axis")]
	var same: bool = not source.is_empty() and source == _source and frame == _frame
	_tree = tree
	_provenance = provenance
	_source = source
	_frame = frame
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
		func(_job: Jobs.Job) -> Variant: return _load(reader, tree),
		_on_loaded.bind(reader),
		reader
	)


## Whether the points are on their way.
func is_loading() -> bool:
	return _loading != null


## Colours for all points: the heat map of [member fidelity], and grey for leaves. Empty while it
## isn't measured.
func get_heat_colors() -> PackedColorArray:
	if fidelity == null:
		return []
	var heat: PackedColorArray = fidelity.get_point_colors()
	if _wood_indices.is_empty():
		return heat
	var all: PackedColorArray = []
	all.resize(points.size())
	all.fill(LEAF_COLOR)
	for i: int in _wood_indices.size():
		all[_wood_indices[i]] = heat[i]
	return all


## Measures the tree against its scan, now and after every edit until [method stop_measuring].
func measure() -> void:
	_watching = true
	_outdated = true
	request()
	_measure()


## Measures no more.
func stop_measuring() -> void:
	_watching = false


## Whether it is measured after every edit.
func is_following() -> bool:
	return _watching


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
	wood = PackedVector3Array()
	_wood_indices = PackedInt32Array()
	fidelity = null
	_outdated = true
	if had:
		changed.emit()


# On a thread: the indices of the wood in the points, or null.
static func _load(reader: TreeReconstructor, tree: TreeReconstruction) -> Variant:
	if not reader.load_cloud(tree, MAXIMUM_POINTS):
		return null
	return tree.find_wood_points(reader.get_cloud_points())


func _on_loaded(wooden: Variant, job: Jobs.Job, reader: TreeReconstructor) -> void:
	if job != _loading:
		return
	_loading = null
	if wooden == null:
		_say.call(reader.get_error_message())
		return
	points = reader.get_cloud_points()
	colors = reader.get_cloud_colors()
	wood = points
	var indices: PackedInt32Array = wooden
	# Where leaves are everywhere they can't be left out.
	if not indices.is_empty() and indices.size() < points.size():
		_wood_indices = indices
		wood = PackedVector3Array()
		for i: int in indices:
			wood.append(points[i])
	changed.emit()
	if _watching:
		_measure()


func _measure() -> void:
	if not _outdated or points.is_empty() or _measuring != null or _tree == null:
		return
	_outdated = false
	var measured: TreeFidelity = fidelity
	var tree: TreeReconstruction = _tree
	var cloud: PackedVector3Array = wood
	var work: Callable = func(_job: Jobs.Job) -> TreeFidelity:
		if measured == null:
			measured = TreeFidelity.new()
			if not measured.set_cloud(tree, cloud, TOLERANCE):
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
