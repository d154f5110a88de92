@tool
extends RefCounted
## Whose twigs a sketched tree can have beside those of a species: of the trees in the scene, and of
## the user's libraries.

## A sketch has other twigs now. [param told] are the properties of [TreeSketch] that it tells.
signal taken(sketch: TreeSketch, told: PackedStringArray, title: String)

const Session := preload("../session.gd")
const Jobs := preload("../jobs.gd")
const Twigs := preload("../dock/twigs.gd")

const _OF_TREE: PackedStringArray = ["twigs", "species", "leaf_rule"]

## Tells the scene whose trees there are; tests have another one than the editor's.
var find_scene: Callable = func() -> Node: return EditorInterface.get_edited_scene_root()

var _session: Session
# What is read of a sketch's twigs, and of which.
var _read: Dictionary = {}
var _read_of: String = ""


func _init(session: Session) -> void:
	set_translation_domain(session.get_translation_domain())
	_session = session


## What there is to choose from: a [TreeReconstruction], or the path of a [TwigLibrary], by name.
## The tree of [param sketch] itself is left out.
func get_sources(sketch: TreeSketch) -> Dictionary[String, Variant]:
	var sources: Dictionary[String, Variant] = {}
	var scene: Node = find_scene.call()
	if scene != null:
		var nodes: Array[Node] = scene.find_children("*", "MeshInstance3D", true, false)
		for node: Node in [scene] + nodes:
			var shown: TreeInstance3D = node as TreeInstance3D
			if shown == null or shown.reconstruction == null or shown.reconstruction.is_empty():
				continue
			var is_own: bool = is_same(shown.reconstruction.provenance.get("sketch"), sketch)
			if not is_own and not shown.reconstruction in sources.values():
				sources[_free_name(String(shown.name), sources)] = shown.reconstruction
	for path: String in Twigs.get_kept_paths():
		sources[_free_name(path.get_file().get_basename().capitalize(), sources)] = path
	return sources


## Takes the twigs of a source, on a worker: a scanned tree is large.
func take(sketch: TreeSketch, name: String, source: Variant) -> void:
	var from: Resource = null
	if source is TreeReconstruction:
		from = source
	elif ResourceLoader.exists(source as String):
		from = load(source as String) as TwigLibrary
	if from == null:
		_session.say(tr("%s is no library of twigs.") % source, Session.Kind.ERROR)
		return
	var worker: TreeReconstructor = TreeReconstructor.new()
	_session.jobs.start(
		tr("Taking the twigs of %s") % name,
		func(_job: Jobs.Job) -> TreeSketch: return worker.sketch_with_twigs(sketch, from, name),
		_on_taken.bind(worker, from is TreeReconstruction),
		worker
	)


## A species' own twigs and leaves again.
func take_species(species: String) -> void:
	var sketch: TreeSketch = TreeSketch.new()
	sketch.species = species
	taken.emit(sketch, _OF_TREE, tr("Change Sketch Species"))


## Whose the own twigs of a sketch are; "" where it has none.
func get_title_of(sketch: TreeSketch) -> String:
	return tr("Twigs of %s") % _told_of(sketch).get("title", "") if sketch.twigs != "" else ""


## The height of the tree that the own twigs are of, in metres, or 0.
func get_height_of(sketch: TreeSketch) -> float:
	return _told_of(sketch).get("height", 0.0)


func _told_of(sketch: TreeSketch) -> Dictionary:
	if sketch.twigs != _read_of:
		_read_of = sketch.twigs
		var told: Variant = JSON.parse_string(_read_of) if _read_of != "" else {}
		_read = told if told is Dictionary else {}
	return _read


func _on_taken(
	sketch: TreeSketch, _ended: Jobs.Job, worker: TreeReconstructor, of_tree: bool
) -> void:
	if sketch == null:
		_session.say(worker.get_error_message(), Session.Kind.ERROR)
		return
	# A library tells nothing of leaves.
	var told: PackedStringArray = _OF_TREE if of_tree else PackedStringArray(["twigs"])
	taken.emit(sketch, told, tr("Change Sketch Twigs"))


static func _free_name(name: String, taken_names: Dictionary[String, Variant]) -> String:
	var free: String = name
	var number: int = 2
	while taken_names.has(free):
		free = "%s (%d)" % [name, number]
		number += 1
	return free
