@tool
extends RefCounted
## Makes branches of strokes, one after another, on threads: each waits for the scan and for the one
## before, and is one step of the history. How true the tree is to its scan is measured before and
## after each.

## A stroke came, or was done with.
signal changed
## A branch has grown; its nodes.
signal grown(added: PackedInt32Array)

const Session := preload("../session.gd")
const Pinhole := preload("pinhole.gd")


## A stroke that was drawn.
class Stroke:
	extends RefCounted
	## From where.
	var pinhole: Pinhole
	## In the pixels of the view.
	var positions: PackedVector2Array
	## Options of [method TreeReconstructor.sketch_branch].
	var options: Dictionary


## Strokes that are not branches yet, the first one drawn first.
var waiting: Array[Stroke] = []

var _session: Session
var _title: String
var _job: Session.Jobs.Job
# The scan that was asked for.
var _asked: String = ""
# Of the scan as it is; null until it is needed.
var _fidelity: TreeFidelity
var _comparing: Session.Jobs.Job


func _init(session: Session) -> void:
	set_translation_domain(session.get_translation_domain())
	_session = session


## Reads the tree's scan if it has one.
func start() -> void:
	_asked = ""
	_session.scan_changed.connect(_on_scan_changed)
	_ask_for_scan()


## Gives up what waits.
func stop() -> void:
	cancel()
	if _session.scan_changed.is_connected(_on_scan_changed):
		_session.scan_changed.disconnect(_on_scan_changed)
	if _comparing != null:
		_session.jobs.cancel(_comparing)
		_comparing = null
	_fidelity = null


## Makes a branch of a stroke. [param title] names the step.
func add(title: String, stroke: Stroke) -> void:
	_title = title
	waiting.append(stroke)
	if waiting.size() == 1:
		_get_frames().connect(_go_on)
	changed.emit()
	_go_on()


## Gives up the strokes that are not branches yet.
func cancel() -> void:
	if _job != null:
		_session.jobs.cancel(_job)
		_job = null
	if waiting.is_empty():
		return
	waiting.clear()
	_get_frames().disconnect(_go_on)
	changed.emit()


# Once a frame while strokes wait.
func _go_on() -> void:
	if _job != null:
		if _job in _session.jobs.get_running():
			return
		# It was cancelled elsewhere.
		_job = null
		_drop_first()
		return
	if _session.tree == null or _ask_for_scan():
		return
	var stroke: Stroke = waiting[0]
	var of: TreeReconstruction = _session.tree
	var maker: TreeReconstructor = TreeReconstructor.new()
	_job = _session.jobs.start(
		tr("Making a branch of the stroke"),
		_draw.bind(maker, of, stroke, _session.scan.wood),
		_on_drawn.bind(maker, of, of.get_bark_revision()),
		maker
	)


# Whether the points are on their way. They are asked for once: what can't be read was told of.
func _ask_for_scan() -> bool:
	var source: String = Session.ScanData.source_of(_session.tree)
	if source.is_empty() or not _session.scan.points.is_empty():
		return false
	if source != _asked:
		_asked = source
		_session.scan.request()
	return _session.scan.is_loading()


# On a thread.
static func _draw(
	_of: Session.Jobs.Job,
	maker: TreeReconstructor,
	of: TreeReconstruction,
	stroke: Stroke,
	wood: PackedVector3Array
) -> Dictionary:
	return maker.sketch_branch(
		of, stroke.pinhole.camera, stroke.pinhole.to_picture(stroke.positions), wood, stroke.options
	)


func _on_drawn(
	branch: Dictionary,
	job: Session.Jobs.Job,
	maker: TreeReconstructor,
	of: TreeReconstruction,
	revision: int
) -> void:
	if job != _job:
		return
	_job = null
	if branch.is_empty():
		_drop_first()
		_session.say(maker.get_error_message(), Session.Kind.WARNING)
		return
	if _session.tree != of or of.get_bark_revision() != revision:
		# Another edit came between: the next frame draws it onto the tree as it is now.
		return
	_drop_first()
	var before: TreeReconstruction = TreeReconstruction.new()
	before.take_tree_of(of)
	var edit: TreeEdit = _session.run(_title, branch["command"])
	if edit == null:
		return
	grown.emit(edit.get_added_nodes())
	_tell(branch, before)


func _drop_first() -> void:
	waiting.pop_front()
	if waiting.is_empty():
		_get_frames().disconnect(_go_on)
	changed.emit()


# Says at once what came of the stroke, and once more with how true the tree is now.
func _tell(branch: Dictionary, before: TreeReconstruction) -> void:
	var measured: float = branch["measured"]
	var words: PackedStringArray = [
		(
			tr("A branch of %.2f m with %d twigs, and the scan shows %.0f %% of it.")
			% [branch["length"], branch["twigs"], 100.0 * measured]
		)
	]
	for remark: String in branch["remarks"]:
		words.append(Session.Sentences.translate(remark, get_translation_domain()))
	var sentence: String = " ".join(words)
	var kind: Session.Kind = Session.Kind.INFO if measured > 0.0 else Session.Kind.WARNING
	_session.say(sentence, kind)
	if _session.scan.wood.is_empty():
		return
	var after: TreeReconstruction = TreeReconstruction.new()
	after.take_tree_of(_session.tree)
	_comparing = _session.jobs.start(
		tr("Comparing the tree with its scan"),
		_compare.bind(_fidelity, _session.scan.wood, before, after),
		_on_compared.bind(_session.tree, sentence, kind)
	)


# On a thread: what measured, and its figures before and after; empty where it can't.
static func _compare(
	job: Session.Jobs.Job,
	fidelity: TreeFidelity,
	wood: PackedVector3Array,
	before: TreeReconstruction,
	after: TreeReconstruction
) -> Array:
	if fidelity == null:
		fidelity = TreeFidelity.new()
		if not fidelity.set_cloud(before, wood, Session.ScanData.TOLERANCE):
			return []
	var was: Dictionary = fidelity.update(before)
	if job.cancelled:
		return []
	var now: Dictionary = fidelity.update(after)
	return [] if was.is_empty() or now.is_empty() else [fidelity, was, now]


func _on_compared(
	found: Array,
	job: Session.Jobs.Job,
	of: TreeReconstruction,
	sentence: String,
	kind: Session.Kind
) -> void:
	# A later branch's figures are on their way, or it is another tree's.
	if job != _comparing or found.is_empty() or _session.tree != of:
		return
	_comparing = null
	_fidelity = found[0]
	var was: Dictionary = found[1]
	var now: Dictionary = found[2]
	var figures: String = (
		tr("Fidelity R_s %.3f → %.3f, explained %.1f %% → %.1f %%.")
		% [was["skeleton"], now["skeleton"], 100.0 * was["explained"], 100.0 * now["explained"]]
	)
	_session.say("%s %s" % [figures, sentence], kind)


func _on_scan_changed() -> void:
	_fidelity = null
	_comparing = null


static func _get_frames() -> Signal:
	return (Engine.get_main_loop() as SceneTree).process_frame
