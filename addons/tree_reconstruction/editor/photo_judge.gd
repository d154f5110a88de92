@tool
extends RefCounted
## The photos that the edited tree was made of, as judges of it: by masks of its outline, or by
## their sky. They follow what measures the tree against its scan, on threads.

## Figures came, went, or are out of date.
signal changed

const Jobs := preload("jobs.gd")
const ScanData := preload("scan_data.gd")
const PhotoSource := preload("compare/photo_source.gd")
const Sentences := preload("translations/sentences.gd")
const _SECTION: String = "tree_reconstruction"
const _KEY: String = "mask_folders"
const _MASKS: String = "masks"
const _MASK_ENDINGS: PackedStringArray = ["png", "jpg", "jpeg", "bmp", "tga"]

## What the photos say of the cloud, as [method TreeReconstructor.load_outlines] gives it; empty
## where there are none, or nothing can judge.
var cloud: Dictionary
## What they say of the tree, as [method TreeReconstructor.measure_outline] gives it, and what they
## said before the last edit.
var outline: Dictionary
var before: Dictionary
## The tree was edited since then.
var stale: bool = false
## Why nothing judges, in the editor's language.
var sentence: String = ""
## Whether the node shows leaves: they are a part of the outline.
var leaves: bool = true:
	set(value):
		if value != leaves:
			leaves = value
			note_edit()
			_follow()

var _jobs: Jobs
var _scan: ScanData
var _tree: TreeReconstruction
var _has_photos: bool = false
var _worker: TreeReconstructor
var _loading: Jobs.Job
var _measuring: Jobs.Job
# What the photos were read for: the cloud's points and where the tree stands in the scan.
var _read_for: Array = []
# Where what judges is, as save_html_report() takes it.
var _folders: Dictionary = {}
# By what a tree was made of, as the user chose them.
var _chosen: Dictionary = {}


func _init(jobs: Jobs, scan: ScanData) -> void:
	_jobs = jobs
	_scan = scan
	_scan.fidelity_changed.connect(_follow)
	if Engine.is_editor_hint():
		_chosen = EditorInterface.get_editor_settings().get_project_metadata(_SECTION, _KEY, {})


## Another tree is edited, or none.
func set_tree(tree: TreeReconstruction) -> void:
	if tree == _tree:
		return
	var same: bool = tree != null and _tree != null and _read_for == _need_of(tree)
	_tree = tree
	_look_for_photos()
	if same:
		note_edit()
		return
	_drop()


## The tree was edited.
func note_edit() -> void:
	if (not outline.is_empty() or _measuring != null) and not stale:
		stale = true
		changed.emit()


## Whether the tree has photos that could judge it, as far as was known when it was measured last.
func has_photos() -> bool:
	return _has_photos


func is_reading() -> bool:
	return _loading != null


## The masks of the photos are in this folder.
func take_masks(folder: String) -> void:
	_chosen[_get_source()] = folder
	if Engine.is_editor_hint():
		var settings: EditorSettings = EditorInterface.get_editor_settings()
		settings.set_project_metadata(_SECTION, _KEY, _chosen)
	_drop()
	_follow()


## Where the user begins to look for masks: beside the tree's cloud.
func get_folder_to_begin() -> String:
	var folder: String = ProjectSettings.globalize_path(_get_source()).get_base_dir()
	return folder if DirAccess.dir_exists_absolute(folder) else ""


## For [method TreeReconstructor.save_html_report]; empty where nothing judges.
func get_folders() -> Dictionary:
	return _folders


## Q and its parts, with what the scan says: [param measured] is [method TreeFidelity.get_current]
## or [method TreeFidelity.get_previous], [param of_outline] what belongs to it.
func get_figures(measured: Dictionary, of_outline: Dictionary) -> Dictionary:
	var figures: Dictionary = {}
	if measured.is_empty() or cloud.is_empty():
		return figures
	figures[&"information"] = cloud["information"]
	figures[&"reconstruction"] = cloud["reconstruction"]
	figures[&"quality"] = (
		cloud["information"] * cloud["reconstruction"] * measured["skeleton"] as float
	)
	for part: String in ["precision", "recall", "iou"]:
		if of_outline.has(part):
			figures[StringName(part)] = of_outline[part]
	return figures


## Whether the figures are upper bounds.
func is_by_sky() -> bool:
	return cloud.get("judged_by", "") == "sky"


## To be called once a frame: forgets work that was cancelled.
func update() -> void:
	if _loading != null and not _loading in _jobs.get_running():
		_loading = null
		changed.emit()
	if _measuring != null and not _measuring in _jobs.get_running():
		_measuring = null
		changed.emit()


func _drop() -> void:
	for job: Jobs.Job in [_loading, _measuring]:
		if job != null:
			_jobs.cancel(job)
	_loading = null
	_measuring = null
	_worker = null
	_read_for = []
	_folders = {}
	cloud = {}
	outline = {}
	before = {}
	stale = false
	sentence = ""
	changed.emit()


# The scan has been measured.
func _follow() -> void:
	_look_for_photos()
	if not _scan.is_following() or _scan.fidelity == null or not _has_photos:
		return
	if _loading != null or _measuring != null:
		return
	var need: Array = _need_of(_tree)
	if _read_for != need:
		_read(need)
	elif not cloud.is_empty() and (outline.is_empty() or stale):
		_measure()


func _read(need: Array) -> void:
	_drop()
	_read_for = need
	var worker: TreeReconstructor = TreeReconstructor.new()
	var chosen: PackedStringArray = [_get_model(), _get_photos(), _chosen.get(_get_source(), "")]
	_loading = _jobs.start(
		tr("Reading the outlines in the photos"),
		_load.bind(worker, _tree, _scan.points, chosen),
		_on_loaded.bind(worker),
		worker
	)
	changed.emit()


# On a thread: [what the photos say of the cloud, the folders].
static func _load(
	_job: Jobs.Job,
	worker: TreeReconstructor,
	tree: TreeReconstruction,
	points: PackedVector3Array,
	chosen: PackedStringArray
) -> Array:
	var views: Array[Dictionary] = worker.load_photo_views(tree, chosen[0])
	if views.is_empty():
		return [{}, {}]
	var folders: PackedStringArray = PhotoSource.list_folders(tree.provenance, chosen.slice(0, 2))
	var photos: String = PhotoSource.find_folder(views, folders)
	var masks: String = chosen[2]
	if masks.is_empty():
		masks = find_masks(views, photos, tree.provenance.get("source", ""))
	var found: Dictionary = {"model": chosen[0], "photos": photos, "masks": masks}
	return [worker.load_outlines(tree, points, found), found]


## A folder "masks" beside the photos or the cloud that has a mask of each photo; empty where there
## is none.
static func find_masks(views: Array[Dictionary], photos: String, source: String) -> String:
	var beside: PackedStringArray = []
	if not photos.is_empty():
		beside.append(photos.path_join(_MASKS))
		beside.append(photos.path_join("..").path_join(_MASKS))
	if not source.is_empty():
		beside.append(source.get_base_dir().path_join(_MASKS))
		beside.append(source.get_base_dir().path_join("..").path_join(_MASKS))
	for folder: String in beside:
		if DirAccess.dir_exists_absolute(folder) and _has_all_masks(views, folder):
			return folder
	return ""


static func _has_all_masks(views: Array[Dictionary], folder: String) -> bool:
	for view: Dictionary in views:
		var name: String = view["name"]
		var there: bool = FileAccess.file_exists(folder.path_join(name + ".png"))
		for ending: String in _MASK_ENDINGS:
			var path: String = folder.path_join(name.get_basename() + "." + ending)
			there = there or FileAccess.file_exists(path)
		if not there:
			return false
	return true


func _on_loaded(loaded: Array, job: Jobs.Job, worker: TreeReconstructor) -> void:
	if job != _loading:
		return
	_loading = null
	cloud = loaded[0]
	if cloud.is_empty():
		sentence = Sentences.translate(worker.get_error_message(), get_translation_domain())
	else:
		_folders = loaded[1]
		_worker = worker
	changed.emit()
	_follow()


func _measure() -> void:
	var worker: TreeReconstructor = _worker
	var tree: TreeReconstruction = _tree
	var shown: bool = leaves
	stale = false
	_measuring = _jobs.start(
		tr("Comparing the tree with its photos"),
		func(_job: Jobs.Job) -> Dictionary: return worker.measure_outline(tree, shown),
		_on_measured.bind(worker),
		worker
	)
	changed.emit()


func is_measuring() -> bool:
	return _measuring != null


func _on_measured(measured: Dictionary, job: Jobs.Job, worker: TreeReconstructor) -> void:
	if job != _measuring:
		return
	_measuring = null
	if measured.is_empty():
		sentence = Sentences.translate(worker.get_error_message(), get_translation_domain())
		outline = {}
	else:
		sentence = ""
		before = outline
		outline = measured
	changed.emit()
	if stale:
		_follow()


func _look_for_photos() -> void:
	_has_photos = _tree != null and _has_model(_get_source(), _get_model())


func _get_source() -> String:
	return "" if _tree == null else _tree.provenance.get("source", "")


# The folders that the user has chosen when the tree was compared with its photos.
func _get_shown() -> PackedStringArray:
	var none: PackedStringArray = ["", ""]
	if not Engine.is_editor_hint():
		return none
	var settings: EditorSettings = EditorInterface.get_editor_settings()
	var shown: Dictionary = settings.get_project_metadata(_SECTION, PhotoSource.KEY, {})
	return shown.get(_get_source(), none)


func _get_model() -> String:
	return _get_shown()[0]


func _get_photos() -> String:
	return _get_shown()[1]


# What the photos have to be read for again.
func _need_of(tree: TreeReconstruction) -> Array:
	var skeleton: Dictionary = tree.skeleton
	return [
		tree.provenance.get("source"),
		skeleton.get("frame"),
		skeleton.get("up_axis"),
		_scan.points.size(),
		_chosen.get(tree.provenance.get("source"), "")
	]


# As TreeReconstructor looks for it.
static func _has_model(source: String, chosen: String) -> bool:
	if not chosen.is_empty():
		return true
	if source.is_empty():
		return false
	var folder: String = source.get_base_dir()
	for place: String in ["", "sparse", "sparse/0", "../sparse", "../sparse/0"]:
		for ending: String in ["bin", "txt"]:
			if FileAccess.file_exists(folder.path_join(place).path_join("images." + ending)):
				return true
	return false
