@tool
extends RefCounted
## Reconstructs the edited tree's scan again, with other options: on a thread, and then with all the
## user's edits done on the new tree too.

## It ended: [param sentence] says what went wrong, or is empty.
signal ended(sentence: String)

const Session := preload("../session.gd")
const Jobs := preload("../jobs.gd")
const History := preload("../history.gd")
# What else is not the user's, or no property of the tree.
const _NOT_KEPT: Array[StringName] = [&"script", &"leaf_preset"]
# Workers keep what stays valid of their last run, so that the next one is quick.
const _KEPT_WORKERS: int = 2

var _session: Session
var _workers: Dictionary[String, TreeReconstructor] = {}
var _job: Jobs.Job


func _init(session: Session) -> void:
	set_translation_domain(session.get_translation_domain())
	_session = session
	_session.jobs.changed.connect(_on_jobs_changed)


## Ends its part in the session.
func close() -> void:
	_session.jobs.changed.disconnect(_on_jobs_changed)
	_workers.clear()


## Whether one is under way.
func is_running() -> bool:
	return _job != null


## The options that [param tree] was made with, those included that were left at their defaults.
static func options_of(tree: TreeReconstruction) -> Dictionary:
	var options: Dictionary = {}
	var given: Dictionary = {} if tree == null else tree.provenance.get("options", {})
	for option: Dictionary in TreeReconstructor.get_option_list():
		options[option.name] = given.get(option.name, option.default)
	return options


## What reads the scan at [param source]: the same one each time, as long as it is remembered.
func get_worker(source: String) -> TreeReconstructor:
	var worker: TreeReconstructor = _workers.get(source)
	_workers.erase(source)
	if worker == null:
		worker = TreeReconstructor.new()
	_workers[source] = worker
	while _workers.size() > _KEPT_WORKERS:
		_workers.erase(_workers.keys()[0])
	return worker


## Begins.
func start(options: Dictionary) -> void:
	var source: String = _session.tree.provenance.get("source", "")
	var worker: TreeReconstructor = get_worker(source)
	_job = _session.jobs.start(
		tr("Reconstructing %s") % source.get_file(),
		_reconstruct.bind(worker, source, options),
		_on_reconstructed.bind(worker, _session.node.get_instance_id(), _session.tree),
		worker
	)


static func _reconstruct(
	_running: Jobs.Job, worker: TreeReconstructor, source: String, options: Dictionary
) -> TreeReconstruction:
	return worker.reconstruct_file(source, options)


func _on_reconstructed(
	raw: TreeReconstruction,
	_ended: Jobs.Job,
	worker: TreeReconstructor,
	node: int,
	old: TreeReconstruction
) -> void:
	_job = null
	if raw == null:
		_end(worker.get_error_message())
		return
	_replay(raw, node, old)


# The edits are done on the thread too: there may be many.
func _replay(raw: TreeReconstruction, node: int, old: TreeReconstruction) -> void:
	var log: String = old.edit_log
	if log.is_empty():
		_take(raw, {}, node, old)
		return
	_job = _session.jobs.start(
		tr("Doing your edits again"),
		edit_again.bind(raw, log),
		_on_edited_again.bind(raw, log, node, old)
	)


## Does the edits of a log again on a copy of [param raw]: that, and what
## [method TreeReconstruction.replay] says of it. May run on a thread.
static func edit_again(_running: Jobs.Job, raw: TreeReconstruction, log: String) -> Array:
	var made: TreeReconstruction = raw.duplicate() as TreeReconstruction
	return [made, made.replay(log)]


func _on_edited_again(
	result: Array,
	_ended: Jobs.Job,
	raw: TreeReconstruction,
	log: String,
	node: int,
	old: TreeReconstruction
) -> void:
	_job = null
	# The user went on meanwhile.
	var now: TreeReconstruction = _session.tree if _is_edited(node) else old
	if now != null and now.edit_log != log and _is_same_tree(now, old):
		_replay(raw, node, now)
		return
	_take(result[0], result[1], node, old)


func _take(
	made: TreeReconstruction, replayed: Dictionary, node: int, old: TreeReconstruction
) -> void:
	if not _is_edited(node):
		_end(tr("Another tree is selected now, so the new reconstruction is left out."))
		return
	_keep_rules(made, old)
	_session.replace_tree(tr("Reconstruct Again"), made)
	say_left_out(_session, replayed)
	_end("")


## Says which edits did not fit when they were done again.
static func say_left_out(session: Session, replayed: Dictionary) -> void:
	var left_out: Array = replayed.get("left_out", [])
	if not left_out.is_empty():
		var sentence: String = (
			session.tr("%d of your edits don't fit the new tree and wait in its log. The first: %s")
			% [left_out.size(), left_out[0].reason]
		)
		session.say(sentence, Session.Kind.WARNING)


# The node may be gone, so it is known by its instance id.
func _is_edited(node: int) -> bool:
	return is_instance_valid(_session.node) and _session.node.get_instance_id() == node


# An imported tree may have become one of the user's own.
static func _is_same_tree(now: TreeReconstruction, old: TreeReconstruction) -> bool:
	return now == old or now.provenance.get("source", "") == old.provenance.get("source", "")


# The leaves are as the user has set them.
static func _keep_rules(made: TreeReconstruction, old: TreeReconstruction) -> void:
	made.leaf_preset = old.leaf_preset
	for property: Dictionary in old.get_property_list():
		var name: StringName = property.name
		if (
			property.usage & PROPERTY_USAGE_STORAGE
			and not name in History.MADE
			and not name in _NOT_KEPT
			and not name.begins_with("resource_")
			and not name.begins_with("metadata/")
		):
			made.set(name, old.get(name))


func _end(sentence: String) -> void:
	_session.say(sentence, _session.Kind.ERROR)
	ended.emit(sentence)


func _on_jobs_changed() -> void:
	# One that was cancelled ends without a word.
	if _job != null and not _job in _session.jobs.get_running():
		var cancelled: bool = _job.cancelled
		if cancelled:
			_job = null
			ended.emit("")
