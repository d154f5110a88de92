@tool
extends RefCounted
## The photos that the edited tree was made of: from where they were taken, and their pictures,
## which are read on threads.

## Views, picture or sentence are other ones now.
signal changed

## What the user has to show the way to.
enum Lack { NOTHING, MODEL, PHOTOS }

const Session: GDScript = preload("../session.gd")
const Jobs: GDScript = preload("../jobs.gd")
const PhotoFolder: GDScript = preload("../photos/photo_folder.gd")
## Where the project keeps which folders the user chose.
const KEY: String = "photo_folders"
## Pixels of the longer side of a picture that is shown.
const LONGEST: int = 2560
# Where photos lie beside a tree's cloud, or a COLMAP model: the names of folders.
const _BESIDE: PackedStringArray = ["photos", "frames", "images"]
# So many names tell whether a folder has the photos.
const _ASKED: int = 60
const _SECTION: String = "tree_reconstruction"

## As [method TreeReconstructor.load_photo_views] gives them.
var views: Array[Dictionary] = []
## Which photo is looked at; -1 for none.
var index: int = -1
## The photo without its lens's distortion; [code]null[/code] while it is read, or can't be.
var picture: ImageTexture
## Pixels of the picture to one of the photo.
var picture_scale: float = 1.0
## What went wrong, in the editor's language.
var sentence: String = ""
var lack: Lack = Lack.NOTHING

var _session: Session
var _tree: TreeReconstruction
var _folder: String = ""
var _job: Jobs.Job
# By what a tree was made of: [the model's folder, the photos' folder], as the user chose them.
var _chosen: Dictionary = {}
# Where the tree stood in its scan when the views were read.
var _placed: Array = []


func _init(session: Session) -> void:
	set_translation_domain(session.get_translation_domain())
	_session = session
	if Engine.is_editor_hint():
		_chosen = EditorInterface.get_editor_settings().get_project_metadata(_SECTION, KEY, {})


## Reads from where the tree was photographed.
func open(tree: TreeReconstruction) -> void:
	close()
	_tree = tree
	_read_views()


## The tree was edited, or a copy of it took its place: where its size or place in the scan changed,
## the photos stand elsewhere.
func follow(tree: TreeReconstruction) -> void:
	_tree = tree
	if _place_of(tree) != _placed:
		_read_views()


## Lets all of it go.
func close() -> void:
	_end_job()
	_tree = null
	views = []
	index = -1
	picture = null
	sentence = ""
	lack = Lack.NOTHING
	_folder = ""


func is_reading() -> bool:
	return _job != null


## Looks at another photo.
func choose(which: int) -> void:
	if views.is_empty():
		return
	index = posmod(which, views.size())
	picture = null
	_read_picture()
	changed.emit()


## The user has shown where the model or the photos are, whichever is lacking.
func take_folder(folder: String) -> void:
	if _tree == null:
		return
	var chosen: PackedStringArray = _get_chosen()
	chosen[0 if lack == Lack.MODEL else 1] = folder
	_chosen[_get_source()] = chosen
	if Engine.is_editor_hint():
		var settings: EditorSettings = EditorInterface.get_editor_settings()
		settings.set_project_metadata(_SECTION, KEY, _chosen)
	if lack == Lack.MODEL:
		_read_views()
		return
	_folder = folder
	sentence = ""
	choose(index)


## Where the user begins to look for what is lacking: beside the tree's cloud; nothing where that
## isn't known.
func get_folder_to_begin() -> String:
	var folder: String = ProjectSettings.globalize_path(_get_source()).get_base_dir()
	return folder if DirAccess.dir_exists_absolute(folder) else ""


## To be called once a frame: notes work that the user ended in the dock.
func update() -> void:
	if _job != null and not _job in _session.jobs.get_running():
		_job = null
		sentence = tr("Reading the photos was ended.")
		changed.emit()


func _read_views() -> void:
	_end_job()
	sentence = ""
	lack = Lack.NOTHING
	_placed = _place_of(_tree)
	var worker: TreeReconstructor = TreeReconstructor.new()
	_job = _session.jobs.start(
		tr("Reading from where the tree was photographed"),
		_load_views.bind(worker, _tree, _get_chosen()),
		_on_views.bind(worker),
		worker
	)
	changed.emit()


func _read_picture() -> void:
	_end_job()
	if _folder.is_empty():
		return
	sentence = ""
	lack = Lack.NOTHING
	var worker: TreeReconstructor = TreeReconstructor.new()
	_job = _session.jobs.start(
		tr("Reading %s") % views[index]["name"],
		_load_picture.bind(worker, views[index], _folder),
		_on_picture.bind(worker),
		worker
	)


func _end_job() -> void:
	if _job != null:
		_session.jobs.cancel(_job)
		_job = null


# On a thread: [views, folder of the photos].
static func _load_views(
	_running: Jobs.Job,
	worker: TreeReconstructor,
	tree: TreeReconstruction,
	chosen: PackedStringArray
) -> Array:
	var found: Array[Dictionary] = worker.load_photo_views(tree, chosen[0])
	return [found, find_folder(found, list_folders(tree.provenance, chosen))]


## Where the photos may lie, the likeliest folder first. [param chosen] is what the user said: the
## folders of model and photos, or nothing.
static func list_folders(provenance: Dictionary, chosen: PackedStringArray) -> PackedStringArray:
	var folders: PackedStringArray = []
	for folder: String in [chosen[1], provenance.get("photos", "")]:
		if not folder.is_empty():
			folders.append(folder)
	var source: String = provenance.get("source", "")
	var above: PackedStringArray = []
	if not source.is_empty():
		above = [source.get_base_dir(), source.get_base_dir().path_join("..")]
	if not chosen[0].is_empty():
		for up: String in ["", "..", "../.."]:
			above.append(chosen[0].path_join(up))
	for folder: String in above:
		for name: String in _BESIDE:
			folders.append(folder.path_join(name))
		folders.append(folder)
	return folders


## The first of the folders that has more of the photos than the others; empty where none has any.
static func find_folder(found: Array[Dictionary], folders: PackedStringArray) -> String:
	var best: String = ""
	var most: int = 0
	var step: int = maxi(1, ceili(float(found.size()) / _ASKED))
	for folder: String in folders:
		var count: int = 0
		for i: int in range(0, found.size(), step):
			count += int(FileAccess.file_exists(folder.path_join(found[i]["name"])))
		if count > most:
			most = count
			best = folder
	return best


func _on_views(loaded: Array, job: Jobs.Job, worker: TreeReconstructor) -> void:
	if job != _job:
		return
	_job = null
	views = loaded[0]
	_folder = loaded[1]
	if views.is_empty():
		index = -1
		picture = null
		sentence = Session.Sentences.translate(worker.get_error_message(), get_translation_domain())
		lack = Lack.MODEL
	else:
		index = clampi(index, -1, views.size() - 1)
		if _folder.is_empty():
			sentence = (
				tr("The photos themselves aren't where they were. Choose the folder that has %s.")
				% views[0]["name"]
			)
			lack = Lack.PHOTOS
		elif index >= 0 and picture == null:
			_read_picture()
	changed.emit()


# On a thread: the picture with mipmaps and its scale; nothing where it can't be read.
static func _load_picture(
	_running: Jobs.Job, worker: TreeReconstructor, view: Dictionary, folder: String
) -> Array:
	var read: Dictionary = worker.load_photo(view, folder, LONGEST)
	if read.is_empty():
		return []
	var size: Vector2i = read["size"]
	var pixels: PackedByteArray = read["pixels"]
	var image: Image = Image.create_from_data(size.x, size.y, false, Image.FORMAT_RGBA8, pixels)
	# So that it doesn't glitter where it is shown smaller.
	image.generate_mipmaps()
	return [image, read["scale"]]


func _on_picture(loaded: Array, job: Jobs.Job, worker: TreeReconstructor) -> void:
	if job != _job:
		return
	_job = null
	if loaded.is_empty():
		sentence = Session.Sentences.translate(worker.get_error_message(), get_translation_domain())
		lack = Lack.PHOTOS
	else:
		picture = ImageTexture.create_from_image(loaded[0] as Image)
		picture_scale = loaded[1]
	changed.emit()


func _get_source() -> String:
	return _tree.provenance.get("source", "")


func _get_chosen() -> PackedStringArray:
	return _chosen.get(_get_source(), PackedStringArray(["", ""]))


static func _place_of(tree: TreeReconstruction) -> Array:
	var skeleton: Dictionary = tree.skeleton
	return [tree.provenance.get("source"), skeleton.get("frame"), skeleton.get("up_axis")]
