@tool
extends "section.gd"
## Takes the tree out of the addon: as a plain scene, as meshes, as a file of another program.

const Files := preload("files.gd")
const FileWriter := preload("../file_writer.gd")
const Impostor := preload("impostor.gd")
const _FORMATS: PackedStringArray = ["glb", "gltf", "obj", "ply", "txt", "csv", "lstring"]
const _CLOUD_FORMATS: PackedStringArray = ["ply", "xyz", "txt", "asc", "las"]

var levels: SpinBox
var form: OptionButton
var lightmap: CheckBox
var collision: CheckBox
var pictures: CheckBox
var bake: Button
var meshes: Button
var impostor: Impostor
var export_button: Button
var cloud_button: Button
var log_button: Button

var _files: Files = Files.new()


func get_id() -> StringName:
	return &"export"


func close() -> void:
	_files.close()


## Writes the tree as a scene that needs neither the addon nor its library.
func bake_to(path: String) -> void:
	_bake(path, _write_scene)


## Writes the mesh of each level into a file of its own, named after [param path].
func bake_meshes_to(path: String) -> void:
	_bake(path, _write_meshes)


## Writes the tree in the format that the extension of [param path] names.
func export_to(path: String) -> void:
	var worker: TreeReconstructor = TreeReconstructor.new()
	session.jobs.start(
		tr("Writing %s") % path.get_file(),
		_export.bind(worker, session.tree, path, int(levels.value), pictures.button_pressed),
		_on_exported.bind(worker, path),
		worker
	)


## Writes the scan of the tree as it is after cleaning, in the scan's own coordinates.
func save_cloud_to(path: String) -> void:
	var worker: TreeReconstructor = TreeReconstructor.new()
	session.jobs.start(
		tr("Writing %s") % path.get_file(),
		_save_cloud.bind(worker, session.tree, path),
		_on_cloud_saved.bind(worker, path),
		worker
	)


## Writes the user's edits as a script of commands.
func save_log_to(path: String) -> void:
	var file: FileAccess = FileAccess.open(path, FileAccess.WRITE)
	var written: bool = file != null and file.store_string(session.tree.edit_log)
	if file != null:
		file.close()
	_tell(path, OK if written else FileAccess.get_open_error())


func _build() -> void:
	title = "Bake and export"
	tooltip_text = "Takes the tree to games and programs that don't have this addon."
	folded = true
	levels = Widgets.number(1, 5, 1)
	levels.value = 4
	(
		body
		. add_child(
			(
				Widgets
				. line(
					"Levels of detail",
					"How many meshes take turns by distance, in GLB too. Each has a quarter of the triangles.",
					levels
				)
			)
		)
	)
	form = OptionButton.new()
	form.add_item("One mesh per level", TreeBaker.Form.JOINED)
	form.add_item("Bark and a multimesh of leaves", TreeBaker.Form.MULTIMESH)
	body.add_child(
		Widgets.line(
			"Leaves", "One mesh suits tools that scatter. A multimesh takes much less memory.", form
		)
	)
	lightmap = CheckBox.new()
	lightmap.text = "With lightmap UV2"
	lightmap.tooltip_text = "Gives the bark the second coordinates that a LightmapGI needs."
	body.add_child(lightmap)
	collision = CheckBox.new()
	collision.text = "With collision"
	collision.tooltip_text = "Adds a body along trunk and stout branches, as the node has it."
	collision.button_pressed = true
	body.add_child(collision)
	pictures = CheckBox.new()
	pictures.text = "GLB's pictures beside it"
	pictures.tooltip_text = (
		"Puts the pictures of a GLB into a folder beside it, from where programs share them."
		+ " Otherwise they are inside of it."
	)
	pictures.button_pressed = true
	body.add_child(pictures)
	bake = Widgets.button(
		"Bake to scene…",
		"Writes a plain scene with the tree's meshes and materials. It needs no addon.",
		&"PackedScene"
	)
	bake.pressed.connect(_on_bake_pressed)
	meshes = Widgets.button(
		"Bake meshes…",
		"Writes the mesh of each level, bark and leaves, for tools that scatter meshes.",
		&"ArrayMesh"
	)
	meshes.pressed.connect(_on_meshes_pressed)
	impostor = Impostor.new(session, _files)
	body.add_child(
		Widgets.line(
			"Impostor size",
			"How wide its pictures are together, in pixels. 1024 will do for a forest.",
			impostor.size
		)
	)
	export_button = Widgets.button(
		"Export…",
		"Writes a model (GLB, glTF, OBJ) or the skeleton (PLY, treefile, CSV, L-string).",
		&"ExternalLink"
	)
	export_button.pressed.connect(_on_export_pressed)
	cloud_button = Widgets.button(
		"Save cleaned cloud…",
		(
			"Writes the scan without ground, neighbours and stray points, in its own coordinates,"
			+ " to be laid over it in CloudCompare or MeshLab."
		),
		&"PointMesh"
	)
	cloud_button.pressed.connect(_on_cloud_pressed)
	log_button = Widgets.button(
		"Save edits…", "Writes all edits as text. It can be done again on another tree.", &"Script"
	)
	log_button.pressed.connect(_on_log_pressed)
	body.add_child(
		buttons([bake, meshes, impostor.button, export_button, cloud_button, log_button])
	)


func _refresh() -> void:
	var empty: bool = session.tree == null or session.tree.is_empty()
	for button: Button in [bake, meshes, impostor.button, export_button]:
		button.disabled = empty
	cloud_button.disabled = empty or Session.ScanData.source_of(session.tree) == ""
	log_button.disabled = empty or session.tree.edit_log.is_empty()


# Builds and writes it on a worker: packing and writing alone would hold the editor for some frames.
func _bake(path: String, write: Callable) -> void:
	var baker: TreeBaker = TreeBaker.new()
	baker.levels = int(levels.value)
	baker.form = form.get_selected_id() as TreeBaker.Form
	baker.lightmap_uv2 = lightmap.button_pressed
	baker.collision = collision.button_pressed
	baker.collision_kind = session.node.collision_kind
	baker.collision_shapes = session.node.collision_shapes
	baker.collision_minimum_radius = session.node.collision_minimum_radius
	baker.leaves = session.node.leaves
	baker.wind = session.node.wind
	baker.bark_material = session.node.bark_material
	baker.leaf_material = session.node.leaf_material
	baker.impostor = session.node.impostor
	baker.load_materials(session.tree)
	session.jobs.start(
		tr("Baking %s") % path.get_file(),
		_bake_and_write.bind(baker, session.tree, path, write),
		_on_baked
	)


static func _bake_and_write(
	job: Session.Jobs.Job, baker: TreeBaker, tree: TreeReconstruction, path: String, write: Callable
) -> Dictionary[String, Error]:
	var parts: TreeBaker.Parts = baker.build(tree, func() -> bool: return job.cancelled)
	if parts == null or job.cancelled:
		return {}
	return write.call(baker, tree, parts, path)


# What was written, and how that ended.
static func _write_scene(
	baker: TreeBaker, tree: TreeReconstruction, parts: TreeBaker.Parts, path: String
) -> Dictionary[String, Error]:
	var scene: PackedScene = baker.make_scene(tree, parts)
	return {path: FileWriter.write(scene, path)}


static func _write_meshes(
	baker: TreeBaker, tree: TreeReconstruction, parts: TreeBaker.Parts, path: String
) -> Dictionary[String, Error]:
	var written: Dictionary[String, Error] = {}
	var made: Array[ArrayMesh] = baker.make_meshes(tree, parts)
	for level: int in made.size():
		var each: String = "%s_LOD%d.%s" % [path.get_basename(), level, path.get_extension()]
		written[each] = FileWriter.write(made[level], each)
	return written


func _on_baked(written: Dictionary[String, Error], _job: Session.Jobs.Job) -> void:
	for path: String in written:
		_tell(path, written[path])


static func _export(
	_job: Session.Jobs.Job,
	worker: TreeReconstructor,
	tree: TreeReconstruction,
	path: String,
	model_levels: int,
	pictures_beside: bool
) -> Error:
	return worker.export_file(tree, path, model_levels, pictures_beside)


func _on_exported(
	error: Error, _job: Session.Jobs.Job, worker: TreeReconstructor, path: String
) -> void:
	if error == OK:
		_tell(path, OK)
	else:
		session.say(worker.get_error_message(), session.Kind.ERROR)


static func _save_cloud(
	_job: Session.Jobs.Job, worker: TreeReconstructor, tree: TreeReconstruction, path: String
) -> Error:
	return worker.save_cloud(tree, path)


func _on_cloud_saved(
	error: Error, _job: Session.Jobs.Job, worker: TreeReconstructor, path: String
) -> void:
	if error == OK:
		session.say(tr("The cleaned cloud is in %s.") % path)
		Files.tell_editor(path)
	else:
		session.say(worker.get_error_message(), session.Kind.ERROR)


func _tell(path: String, error: Error) -> void:
	if error == OK:
		session.say(tr("The tree is in %s.") % path)
		Files.tell_editor(path)
	else:
		session.say(
			tr("%s can't be written: %s.") % [path, error_string(error)], session.Kind.ERROR
		)


func _on_bake_pressed() -> void:
	_files.ask(
		tr("Bake to Scene"),
		Files.beside(session.tree, "scn").get_basename() + "_baked.scn",
		PackedStringArray(["*.scn;" + tr("Scene"), "*.tscn;" + tr("Scene as text")]),
		bake_to
	)


func _on_meshes_pressed() -> void:
	_files.ask(
		tr("Bake Meshes"),
		Files.beside(session.tree, "res").get_basename() + "_mesh.res",
		PackedStringArray(["*.res;" + tr("Mesh")]),
		bake_meshes_to
	)


func _on_export_pressed() -> void:
	var filters: PackedStringArray = []
	for extension: String in _FORMATS:
		filters.append("*.%s" % extension)
	_files.ask(tr("Export Tree"), Files.beside(session.tree, "glb"), filters, export_to, true)


# Beside the project: inside of it the cloud would be imported as one more scan.
func _on_cloud_pressed() -> void:
	var filters: PackedStringArray = []
	for extension: String in _CLOUD_FORMATS:
		filters.append("*.%s" % extension)
	var source: String = session.tree.provenance.get("source", "")
	_files.ask(
		tr("Save Cleaned Cloud"),
		Files.outside(source.get_file().get_basename() + "_cleaned.ply"),
		filters,
		save_cloud_to,
		true
	)


func _on_log_pressed() -> void:
	_files.ask(
		tr("Save Edits"),
		Files.beside(session.tree, "edits.txt"),
		PackedStringArray(["*.txt;" + tr("Text")]),
		save_log_to,
		true
	)
