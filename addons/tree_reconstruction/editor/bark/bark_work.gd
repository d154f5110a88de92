@tool
extends RefCounted
## The recipe of the edited tree's bark while it is written in the dock and painted in the view, and
## the growth itself on a thread: coarsely at first, so that something is seen soon.

## Another feature is selected, the recipe is another, or a growth began or ended.
signal changed

const Session := preload("../session.gd")
const Recipe := preload("../dock/growth_recipe.gd")
const BarkScene := preload("bark_scene.gd")

## The tool that paints.
const TOOL: StringName = &"paint_bark"
const NONE: int = -1
# The first growth has edges that are so many times as long, but not longer than this share of the
# trunk's radius at its base.
const _COARSE: float = 3.5
const _LONGEST: float = 0.65
# It isn't worth it below.
const _WORTH: float = 1.3

# Always the same one, so that it is known again.
static var _no_frames: Array[Dictionary] = []

var session: Session
## The obstacles that are nodes of the scene.
var scene: BarkScene
## Which of the recipe's features is selected, or NONE.
var selected: int = NONE:
	set(value):
		if selected != value:
			selected = value
			changed.emit()
## Whether bark grows by itself after each change while it is painted.
var automatic: bool = true:
	set(value):
		automatic = value
		follow()

var _job: Session.Jobs.Job
# What grows of itself: the tree's instance id, its recipe, and whether coarsely. Empty if the user
# has asked for it.
var _grows: Array = []
# The recipe whose growth the user has cancelled, or that can't be grown.
var _given_up: String = "\n"
# What the last step gave the tree: growth is added to it, so that it stays one step.
var _step: TreeReconstruction
# The recipe that is seen on the tree, though as yet coarsely.
var _seen: String = "\n"
# Recipes that were edited and not grown yet, by the tree's instance id: what is edited, and the
# tree's own recipe that it began with.
var _drafts: Dictionary[int, Recipe] = {}
var _begun: Dictionary[int, String] = {}
var _defaults: Dictionary[String, String] = {}
# How the bark grew that was grown last, and which it is.
var _frames: Array[Dictionary] = []
var _frames_of: PackedByteArray = []
# What get_frames() was asked about last, and whether it was the same.
var _asked: Array = []
var _same: bool = false
# What grows once more, for its frames alone.
var _recording: Session.Jobs.Job


## That of a session, which has one.
static func of(session_of: Session) -> RefCounted:
	if session_of.bark == null:
		var made: RefCounted = (
			(load("res://addons/tree_reconstruction/editor/bark/bark_work.gd") as GDScript).new()
		)
		made.call(&"begin", session_of)
		session_of.bark = made
	return session_of.bark


func begin(of_session: Session) -> void:
	session = of_session
	set_translation_domain(session.get_translation_domain())
	for command: Dictionary in TreeReconstructor.get_growth_commands():
		for parameter: Dictionary in command.parameters:
			_defaults["%s %s" % [command.name, parameter.name]] = parameter.default
	scene = BarkScene.new(self, session)
	session.tree_changed.connect(_on_tree_changed)
	session.tool_changed.connect(follow)
	session.jobs.changed.connect(_on_jobs_changed)
	(Engine.get_main_loop() as SceneTree).process_frame.connect(_on_frame)


## Ends what runs.
func close() -> void:
	if session == null:
		return
	_cancel()
	(Engine.get_main_loop() as SceneTree).process_frame.disconnect(_on_frame)
	session.tree_changed.disconnect(_on_tree_changed)
	session.tool_changed.disconnect(follow)
	session.jobs.changed.disconnect(_on_jobs_changed)
	session = null


## The default of a command's parameter, as it is written.
func get_default(command: String, name: String) -> String:
	return _defaults.get("%s %s" % [command, name], "")


## The recipe that is written now; the tree's own, unless it was changed here.
func get_recipe() -> Recipe:
	var tree: TreeReconstruction = session.tree
	if tree == null:
		return Recipe.new()
	var id: int = tree.get_instance_id()
	# What the tree has now was edited or undone elsewhere: it counts, not the draft.
	if not _drafts.has(id) or _begun[id] != tree.growth_recipe:
		_drafts[id] = Recipe.new(tree.growth_recipe)
		_begun[id] = tree.growth_recipe
	return _drafts[id]


## The line that is selected, or [code]null[/code].
func get_selected() -> Recipe.Line:
	var features: Array[Recipe.Line] = get_recipe().get_features()
	return features[selected] if selected >= 0 and selected < features.size() else null


func is_growing() -> bool:
	return _job != null


## Whether the tool is at hand that paints bark.
func is_painting() -> bool:
	return session.tool != null and session.tool.call(&"get_id") == TOOL


## Whether the tree's bark shows the recipe that it has, be it coarsely.
func is_seen() -> bool:
	var tree: TreeReconstruction = session.tree
	return tree == null or not tree.growth_pending or _seen == tree.growth_recipe


## Makes what was written in the recipe one step of the history. Steps with the same [param merged]
## that follow each other quickly become one.
func commit(title: String, merged: Array = []) -> void:
	var tree: TreeReconstruction = session.tree
	if tree == null:
		return
	var text: String = get_recipe().get_text()
	_drafts.erase(tree.get_instance_id())
	if text == tree.growth_recipe:
		changed.emit()
		return
	_step = TreeReconstruction.new()
	_step.take_bark_of(tree)
	_step.growth_recipe = text
	_step.growth_meshes = scene.get_meshes(text)
	_step.growth_pending = not text.is_empty() or tree.has_grown_bark()
	session.set_bark(title, _step, merged)
	changed.emit()
	follow()


## Grows the bark of the recipe as a step of its own, on a thread.
func grow() -> void:
	if session.tree == null or session.tree.is_empty() or is_growing():
		return
	_grows = []
	scene.follow(get_recipe())
	_start(get_recipe().get_text())
	changed.emit()


## How the bark of the edited tree grew (see [method TreeReconstructor.get_growth_frames]), its
## result last; nothing where that is not known.
func get_frames() -> Array[Dictionary]:
	var tree: TreeReconstruction = session.tree
	if tree == null or _frames.is_empty():
		return _no_frames
	# Comparing takes a while.
	var asked: Array = [tree, tree.get_bark_revision(), _frames_of.size()]
	if asked != _asked:
		_asked = asked
		_same = tree.grown_bark == _frames_of
	return _frames if _same else _no_frames


func is_recording() -> bool:
	return _recording != null


## Grows the tree's bark once more for [method get_frames], on a thread. The tree stays as it is.
func record() -> void:
	var tree: TreeReconstruction = session.tree
	if tree == null or is_recording() or tree.is_bark_stale() or not tree.has_grown_bark():
		return
	var worker: TreeReconstructor = TreeReconstructor.new()
	var copy: TreeReconstruction = TreeReconstruction.new()
	copy.take_tree_of(tree)
	copy.growth_meshes = tree.growth_meshes
	_recording = session.jobs.start(
		tr("Growth of %s") % session.node.name,
		_run.bind(worker, copy, tree.growth_recipe, true),
		_on_recorded.bind(worker, tree.grown_bark),
		worker
	)
	changed.emit()


## Grows of itself what was painted, unless that grows already. The newest change counts.
func follow() -> void:
	if session == null or session.tree == null:
		return
	var tree: TreeReconstruction = session.tree
	var text: String = tree.growth_recipe
	var wanted: bool = automatic and is_painting() and tree.growth_pending and not tree.is_empty()
	if _job != null:
		if _grows.is_empty():
			return
		if wanted and _grows[0] == tree.get_instance_id() and _grows[1] == text:
			return
		_cancel()
	if not wanted or text == _given_up:
		return
	var coarse: String = _coarse_of(text)
	_grows = [tree.get_instance_id(), text, not coarse.is_empty()]
	_start(text if coarse.is_empty() else coarse)
	changed.emit()


# The recipe with longer edges; empty if that is not worth it.
func _coarse_of(text: String) -> String:
	var recipe: Recipe = Recipe.new(text)
	var edges: Recipe.Line = recipe.find("edges", true)
	var longest: float = edges.values.get("longest", get_default("edges", "longest")).to_float()
	var tree: TreeReconstruction = session.tree
	var longer: float = minf(_COARSE * longest, _LONGEST * tree.get_node_radius(tree.get_root()))
	if longer < _WORTH * longest:
		return ""
	edges.values["longest"] = Recipe.written(longer)
	edges.values.erase("shortest")
	return recipe.get_text()


func _start(recipe: String) -> void:
	var worker: TreeReconstructor = TreeReconstructor.new()
	# The tree may be edited meanwhile: trees are replaced, never changed, so this takes no time.
	var copy: TreeReconstruction = TreeReconstruction.new()
	copy.take_tree_of(session.tree)
	copy.growth_meshes = scene.get_meshes(recipe)
	# What is coarse is seen for a moment only.
	var recorded: bool = _grows.is_empty() or not _grows[2]
	_job = session.jobs.start(
		tr("Bark of %s") % session.node.name,
		_run.bind(worker, copy, recipe, recorded),
		_on_grown.bind(worker, session.node.get_instance_id()),
		worker
	)


func _cancel() -> void:
	if _job != null:
		var job: Session.Jobs.Job = _job
		# First, so that it isn't taken for the user's.
		_job = null
		session.jobs.cancel(job)


static func _run(
	_running: Session.Jobs.Job,
	worker: TreeReconstructor,
	copy: TreeReconstruction,
	recipe: String,
	recorded: bool
) -> TreeReconstruction:
	return worker.grow_bark(copy, recipe, recorded)


func _on_grown(
	made: TreeReconstruction, ended: Session.Jobs.Job, worker: TreeReconstructor, node: int
) -> void:
	if session == null or ended != _job:
		return
	_job = null
	var itself: Array = _grows
	_take_frames(made, worker)
	if not itself.is_empty():
		_take_grown(made, worker, itself)
		changed.emit()
		return
	if made == null:
		session.say(worker.get_error_message(), session.Kind.ERROR)
	# The node may be gone, so it is known by its instance id.
	elif not is_instance_valid(session.node) or session.node.get_instance_id() != node:
		session.say(
			tr("Another tree is selected now, so the bark that grew is left out."),
			session.Kind.WARNING
		)
	else:
		session.set_bark(tr("Grow Bark"), made)
		_tell(worker)
	changed.emit()


func _take_frames(made: TreeReconstruction, worker: TreeReconstructor) -> void:
	if made != null and not worker.get_growth_frames().is_empty():
		_frames = worker.get_growth_frames()
		_frames_of = made.grown_bark
		_asked = []


func _on_recorded(
	made: TreeReconstruction,
	_ended: Session.Jobs.Job,
	worker: TreeReconstructor,
	bark: PackedByteArray
) -> void:
	_recording = null
	if session == null:
		return
	if made == null:
		session.say(worker.get_error_message(), session.Kind.ERROR)
	else:
		_take_frames(made, worker)
		# As it was asked for, though another version of the addon may have grown it.
		_frames_of = bark
	changed.emit()


# What grew of itself belongs to the step that painted it.
func _take_grown(made: TreeReconstruction, worker: TreeReconstructor, itself: Array) -> void:
	var tree: TreeReconstruction = session.tree
	var text: String = itself[1]
	var coarse: bool = itself[2]
	if tree == null or tree.get_instance_id() != itself[0] or tree.growth_recipe != text:
		follow()
		return
	if made == null and not coarse:
		_given_up = text
		session.say(worker.get_error_message(), session.Kind.ERROR)
		return
	if made != null:
		if coarse:
			made.growth_recipe = text
			made.growth_pending = true
		if _step != null and _step.growth_recipe == text:
			_step.take_bark_of(made)
		_seen = made.growth_recipe
		tree.take_bark_of(made)
		if Engine.is_editor_hint():
			EditorInterface.mark_scene_as_unsaved()
	if coarse:
		# Too coarse for some of it is no error.
		_grows = [itself[0], text, false]
		_start(text)
	else:
		_tell(worker)


func _tell(worker: TreeReconstructor) -> void:
	var report: Dictionary = worker.get_report()
	for warning: String in report.warnings:
		session.say(warning, session.Kind.WARNING)
	if session.tree.is_bark_stale():
		session.say(
			tr("The tree was edited while its bark grew, so it shows tubes. Grow the bark again."),
			session.Kind.WARNING
		)


func _on_tree_changed() -> void:
	if session.tree != null:
		get_recipe()
		var count: int = get_recipe().get_features().size()
		selected = mini(selected, count - 1)
	follow()


func _on_frame() -> void:
	scene.update((Engine.get_main_loop() as SceneTree).root.get_process_delta_time())


# One that was cancelled ends without a word.
func _on_jobs_changed() -> void:
	if _recording != null and _recording.cancelled:
		if not _recording in session.jobs.get_running():
			_recording = null
			changed.emit()
	if _job != null and _job.cancelled and not _job in session.jobs.get_running():
		_job = null
		if not _grows.is_empty():
			_given_up = _grows[1]
		changed.emit()
