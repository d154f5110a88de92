@tool
extends RefCounted
## Makes a tree of photos: on a thread, then saved as a file of the project.

## It ended: [param tree] lies in its file, or [param sentence] says what went wrong; neither where
## the user ended it.
signal ended(tree: TreeReconstruction, sentence: String)

const Session := preload("../session.gd")
const Jobs := preload("../jobs.gd")
const PhotoFolder := preload("photo_folder.gd")
const PhotoBark := preload("photo_bark.gd")
const PhotoLeaves := preload("photo_leaves.gd")

## The folder that is worked in, while it runs and after.
var work: String = ""
## The job under way, or [code]null[/code].
var job: Jobs.Job

var _session: Session
var _worker: TreeReconstructor
# What there is to be said besides what the worker says.
var _warnings: PackedStringArray = []


func _init(session: Session) -> void:
	set_translation_domain(session.get_translation_domain())
	_session = session
	_session.jobs.changed.connect(_on_jobs_changed)


## Ends its part in the session.
func close() -> void:
	_session.jobs.changed.disconnect(_on_jobs_changed)


func is_running() -> bool:
	return job != null


## Begins. What was done before with the same photos is taken up.
func start(photos: String, tree_path: String, options: Dictionary) -> void:
	work = PhotoFolder.work_folder(photos, tree_path)
	var error: Error = PhotoFolder.begin_work(work, photos, tree_path)
	if error != OK:
		_end(null, tr("%s can't be written: %s.") % [work, error_string(error)])
		return
	_worker = TreeReconstructor.new()
	_warnings.clear()
	job = _session.jobs.start(
		tr("A tree from %s") % photos.trim_suffix("/").get_file(),
		_make.bind(_worker, photos, work, tree_path, options),
		_on_made.bind(tree_path),
		_worker
	)


## Ends it. What was done is kept for the next time.
func cancel() -> void:
	if job != null:
		_session.jobs.cancel(job)


## What is known of the photos, from the report of the last run.
func get_photos() -> Dictionary:
	return {} if _worker == null else _worker.get_report().get("photos", {})


## The sentences that the last run gave along.
func get_warnings() -> PackedStringArray:
	var warnings: PackedStringArray = []
	if _worker != null:
		for warning: String in _worker.get_report().get("warnings", []):
			warnings.append(Session.Sentences.translate(warning, get_translation_domain()))
	return warnings + _warnings


## "Matching: 12 of 71".
func get_stage() -> String:
	if job == null or job.stage.is_empty():
		return ""
	var stages: Dictionary[String, String] = {
		"Film": tr("Taking photos out of the film"),
		"HEIC": tr("Converting HEIC photos"),
		"Features": tr("Looking for features"),
		"Matching": tr("Comparing photos"),
		"Cameras": tr("Finding the cameras"),
		"Markers": tr("Looking for printed markers"),
		"Dense points": tr("Matching pixels"),
		"Sky": tr("Looking for the sky"),
		"Thin wood": tr("Matching twigs"),
		"Bark": tr("Taking the bark out of the photos"),
		"Leaf colors": tr("Taking the leaves' colors out of the photos"),
	}
	# What comes before them is quick, and what comes after makes the tree.
	var stage: String = tr("Making the tree")
	if stages.has(job.stage):
		stage = stages[job.stage]
	elif job.stage in ["Photos", "Cloud"]:
		stage = tr("Reading photos")
	var count: Vector2i = _worker.get_stage_count()
	return stage if count.y == 0 else stage + ": " + tr("%d of %d") % [count.x, count.y]


# The bark is made here too, since its pictures take seconds to be compressed.
static func _make(
	running: Jobs.Job,
	worker: TreeReconstructor,
	photos: String,
	folder: String,
	tree_path: String,
	options: Dictionary
) -> TreeReconstruction:
	var made: TreeReconstruction = worker.reconstruct_photos(photos, folder, options)
	if made != null:
		made.resource_name = tree_path.get_file().get_basename()
		if not running.cancelled and _has_bark(worker):
			PhotoBark.give(made, PhotoBark.make(folder.path_join("bark"), made.get_leaf_look()))
		if not running.cancelled and _has_leaf_colors(worker):
			PhotoLeaves.give(made, PhotoLeaves.make(worker.get_report()["leaf_colors"], made))
	return made


static func _has_bark(worker: TreeReconstructor) -> bool:
	var bark: Dictionary = worker.get_report().get("bark", {})
	return bark.get("from", "") == "photos"


static func _has_leaf_colors(worker: TreeReconstructor) -> bool:
	var colors: Dictionary = worker.get_report().get("leaf_colors", {})
	return colors.get("from", "") == "photos"


func _on_made(made: TreeReconstruction, _ended: Jobs.Job, tree_path: String) -> void:
	job = null
	if made == null:
		_end(
			null, Session.Sentences.translate(_worker.get_error_message(), get_translation_domain())
		)
		return
	var beside: PackedStringArray = []
	var error: Error = ERR_ALREADY_EXISTS
	if not FileAccess.file_exists(tree_path):
		# First, so that the tree's file can name them.
		beside = [_save_bark(made, tree_path), _save_leaves(made, tree_path)]
		error = ResourceSaver.save(made, tree_path, ResourceSaver.FLAG_COMPRESS)
	if error != OK:
		for path: String in beside:
			if not path.is_empty():
				DirAccess.remove_absolute(path)
		_end(null, tr("%s can't be written: %s.") % [tree_path, error_string(error)])
		return
	made.take_over_path(tree_path)
	if Engine.is_editor_hint():
		for path: String in beside + PackedStringArray([tree_path]):
			if not path.is_empty():
				EditorInterface.get_resource_filesystem().update_file(path)
	_end(made, "")


# The file of its bark. None is no reason to have no tree: nothing then, and it has drawn bark.
func _save_bark(made: TreeReconstruction, tree_path: String) -> String:
	if not _has_bark(_worker):
		return ""
	var material: ShaderMaterial = PhotoBark.of(made) as ShaderMaterial
	if material == null:
		_warnings.append(
			(
				tr("The tree has drawn bark: the pictures in %s can't be read.")
				% work.path_join("bark")
			)
		)
		return ""
	var error: Error = PhotoBark.save(material, tree_path)
	if error != OK:
		PhotoBark.give(made, null)
		_warnings.append(
			(
				tr("The tree has drawn bark: %s can't be written: %s.")
				% [PhotoBark.free_path(tree_path), error_string(error)]
			)
		)
		return ""
	return material.resource_path


# The file of its leaves' material, likewise.
func _save_leaves(made: TreeReconstruction, tree_path: String) -> String:
	if not _has_leaf_colors(_worker):
		return ""
	var material: ShaderMaterial = PhotoLeaves.of(made) as ShaderMaterial
	if material == null:
		_warnings.append(tr("The leaves have drawn colors: their picture can't be read."))
		return ""
	var error: Error = PhotoLeaves.save(material, tree_path)
	if error != OK:
		PhotoLeaves.give(made, null)
		_warnings.append(
			(
				tr("The leaves have drawn colors: %s can't be written: %s.")
				% [PhotoLeaves.free_path(tree_path), error_string(error)]
			)
		)
		return ""
	return material.resource_path


func _end(made: TreeReconstruction, sentence: String) -> void:
	job = null
	ended.emit(made, sentence)


func _on_jobs_changed() -> void:
	# One that was cancelled ends without a word.
	if job != null and job.cancelled and not job in _session.jobs.get_running():
		_end(null, "")
