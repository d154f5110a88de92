@tool
extends ItemList
## The photos of a folder as small pictures, and what is known of each: how many features it has,
## and whether its camera was found.

const Jobs := preload("../jobs.gd")
const Widgets := preload("../dock/widgets.gd")
const PhotoFolder := preload("photo_folder.gd")

const _EDGE: float = 96.0
# So many pictures may be wide open at once in memory before they are small.
const _MOST: int = 400

var _jobs: Jobs
var _job: Jobs.Job
var _folder: String = ""
var _names: PackedStringArray = []
# What they are called where COLMAP reads them.
var _read_names: PackedStringArray = []
var _lock: Mutex = Mutex.new()
# What the worker has made and nobody has shown yet.
var _made: Array[Array] = []
var _features: Dictionary[String, int] = {}
var _missing: PackedStringArray = []
var _is_placed: bool = false
var _shows_converted: bool = false


func _init(jobs: Jobs) -> void:
	_jobs = jobs
	icon_mode = ItemList.ICON_MODE_TOP
	fixed_icon_size = Vector2i.ONE * Widgets.px(_EDGE)
	fixed_column_width = Widgets.px(_EDGE + 8.0)
	max_columns = 0
	max_text_lines = 2
	same_column_width = true
	auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	tooltip_text = tr("The photos. They are only read.")
	size_flags_vertical = Control.SIZE_EXPAND_FILL
	custom_minimum_size = Vector2(Widgets.px(320), Widgets.px(150))


## Shows the photos of [param names] in [param folder]; their pictures come one after another. Those
## that the engine can't read are shown as they lie in [param converted], if they do.
func show_photos(folder: String, names: PackedStringArray, converted: String = "") -> void:
	stop()
	clear()
	_folder = folder
	_names = names.slice(0, _MOST)
	_read_names = PhotoFolder.read_names(names).slice(0, _MOST)
	_features = {}
	_missing = []
	_is_placed = false
	_shows_converted = false
	for name: String in _names:
		add_item(name)
	_draw_photos(converted)
	_tell_all()


## Shows the pictures of the HEIC photos, which lie in [param converted] now, unless it does so.
func show_converted(converted: String) -> void:
	if _read_names != _names and not _shows_converted:
		_shows_converted = true
		stop()
		_draw_photos(converted)


func _draw_photos(converted: String) -> void:
	if _names.is_empty():
		return
	var paths: PackedStringArray = []
	for i: int in _names.size():
		paths.append(
			(
				converted.path_join(_read_names[i])
				if PhotoFolder.is_heic(_names[i])
				else _folder.path_join(_names[i])
			)
		)
	_job = _jobs.start(tr("Looking at photos"), _draw_all.bind(paths, fixed_icon_size.x), _on_drawn)


## Ends its work.
func stop() -> void:
	if _job != null:
		_jobs.cancel(_job)
	_job = null
	_lock.lock()
	_made.clear()
	_lock.unlock()


## Shows what has come of the pictures. To be called once a frame.
func update() -> void:
	_lock.lock()
	var made: Array[Array] = _made
	_made = []
	_lock.unlock()
	for one: Array in made:
		var image: Image = one[1]
		if one[0] < item_count and image != null:
			set_item_icon(one[0], ImageTexture.create_from_image(image))


## Shows how many features each photo has.
func set_features(features: Dictionary[String, int]) -> void:
	if features.size() == _features.size():
		return
	_features = features.duplicate()
	_tell_all()


## Shows which photos' cameras could not be found; all others were.
func set_missing(missing: PackedStringArray) -> void:
	_missing = missing
	_is_placed = true
	_tell_all()


func _tell_all() -> void:
	var warning: Color = (
		get_theme_color(&"warning_color", &"Editor") if is_inside_tree() else Color.ORANGE
	)
	for i: int in item_count:
		var name: String = _names[i]
		var told: PackedStringArray = [name]
		# That is the theme's.
		set_item_custom_fg_color(i, Color())
		set_item_icon_modulate(i, Color.WHITE)
		var read: String = _read_names[i]
		if _features.has(read):
			told.append(tr("%s features") % Widgets.grouped(_features[read]))
		if read in _missing:
			told.append(tr("Its camera's place was not found."))
			set_item_custom_fg_color(i, warning)
			set_item_icon_modulate(i, Color(1, 1, 1, 0.35))
		elif _is_placed:
			told.append(tr("Its camera's place is known."))
		set_item_tooltip(i, "\n".join(told))
		set_item_text(i, name if not _features.has(read) else "%s\n%s" % [name, told[1]])


func _draw_all(job: Jobs.Job, paths: PackedStringArray, edge: int) -> void:
	for i: int in paths.size():
		if job.cancelled:
			return
		var image: Image = _small(paths[i], edge)
		_lock.lock()
		if not job.cancelled:
			_made.append([i, image])
		_lock.unlock()


func _on_drawn(_nothing: Variant, job: Jobs.Job) -> void:
	if job == _job:
		_job = null


# A picture that fits into a square; nothing for what the engine can't read, as TIFF, and for what
# is not converted yet.
static func _small(path: String, edge: int) -> Image:
	if path.get_extension().to_lower() in ["tif", "tiff"] or not FileAccess.file_exists(path):
		return null
	var image: Image = Image.load_from_file(ProjectSettings.globalize_path(path))
	if image == null or image.is_empty():
		return null
	var scale: float = float(edge) / maxi(image.get_width(), image.get_height())
	# First fast, then well.
	if scale < 0.25:
		image.resize(
			ceili(image.get_width() * scale * 2.0),
			ceili(image.get_height() * scale * 2.0),
			Image.INTERPOLATE_BILINEAR
		)
		scale = 0.5
	image.resize(
		maxi(roundi(image.get_width() * scale), 1),
		maxi(roundi(image.get_height() * scale), 1),
		Image.INTERPOLATE_LANCZOS
	)
	return image
