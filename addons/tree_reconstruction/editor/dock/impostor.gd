@tool
extends RefCounted
## The button that bakes an impostor: what is shown of the tree from very far away.

const Session := preload("../session.gd")
const Jobs := preload("../jobs.gd")
const Files := preload("files.gd")
const Widgets := preload("widgets.gd")

var button: Button
## How wide the pictures are together.
var size: OptionButton
## How many there are in a row.
var views: int = 12

var _session: Session
var _files: Files


func _init(session: Session, files: Files) -> void:
	_session = session
	_files = files
	button = (
		Widgets
		. button(
			"Bake impostor…",
			"Takes pictures of the tree from all sides: one card with them is shown from very far away.",
			&"QuadMesh"
		)
	)
	button.pressed.connect(_on_pressed)
	var pixels: Array = [1024, 2048, 4096]
	size = Widgets.choice(PackedStringArray(["1024", "2048", "4096"]), pixels)
	Widgets.choose(size, 2048)


## Writes the impostor of the edited tree and lets the edited node show it, as one step of the
## history. The pictures are taken over many frames.
func bake_to(path: String) -> void:
	var node: TreeInstance3D = _session.node
	var baker: TreeImpostorBaker = TreeImpostorBaker.new()
	baker.resolution = size.get_selected_metadata()
	baker.views = views
	baker.leaves = node.leaves
	baker.bark_material = node.bark_material
	baker.leaf_material = node.leaf_material
	await _bake(_session, baker, path)


# Without the dock, which may go meanwhile: what waits goes with what it belongs to.
static func _bake(session: Session, baker: TreeImpostorBaker, path: String) -> void:
	var tree: TreeReconstruction = session.tree
	var node: TreeInstance3D = session.node
	var job: Jobs.Job = session.jobs.begin(session.tr("Baking %s") % path.get_file())
	_follow(session.jobs, baker, job)
	var made: TreeImpostor = await baker.bake(tree)
	session.jobs.finish(job)
	if made == null:
		# Nothing, where the user cancelled it.
		session.say(baker.get_error_message(), session.Kind.ERROR)
		return
	var error: Error = ResourceSaver.save(made, path, ResourceSaver.FLAG_COMPRESS)
	if error != OK:
		session.say(
			session.tr("%s can't be written: %s.") % [path, error_string(error)], session.Kind.ERROR
		)
		return
	made.take_over_path(path)
	Files.tell_editor(path)
	session.say(session.tr("The impostor is in %s.") % path)
	# The user may have gone on to another tree meanwhile.
	if is_instance_valid(node) and &"impostor" in node and session.node == node:
		session.set_value(session.tr("Bake Impostor"), node, &"impostor", made)


# Shows how far it is, and ends it when the user asks for that, or when the plugin goes.
static func _follow(jobs: Jobs, baker: TreeImpostorBaker, job: Jobs.Job) -> void:
	var frames: SceneTree = Engine.get_main_loop() as SceneTree
	await frames.process_frame
	while job in jobs.get_running() and not job.cancelled:
		job.progress = baker.get_progress()
		job.stage = baker.get_stage()
		await frames.process_frame
	baker.cancel()


func _on_pressed() -> void:
	_files.ask(
		button.tr("Bake Impostor"),
		Files.beside(_session.tree, "impostor.res"),
		PackedStringArray(["*.res;" + button.tr("Impostor")]),
		bake_to
	)
