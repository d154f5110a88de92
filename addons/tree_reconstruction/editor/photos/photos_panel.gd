@tool
extends VBoxContainer
## A tree from photos: which photos, what to do with them, how far it is, and what came of it.
##
## It is made of a session alone, so that tests need no editor.

## The user wants to choose the folder of photos.
signal folder_wanted
## The user wants to choose a file for a marker to print.
signal marker_wanted
## The work is about to begin: what it needs to know besides is set now.
signal begins
## A tree was made, and lies in a file.
signal made(tree: TreeReconstruction)

const Session := preload("../session.gd")
const Widgets := preload("../dock/widgets.gd")
const PhotoFolder := preload("photo_folder.gd")
const PhotoGrid := preload("photo_grid.gd")
const PhotoLog := preload("photo_log.gd")
const Circle := preload("circle.gd")
const Making := preload("making.gd")
const PhotoBark := preload("photo_bark.gd")
const PhotoLeaves := preload("photo_leaves.gd")

## Of a marker to print whose side the user has not told: as large as A4 has room for with a white
## border as wide as one of its cells.
const MARKER_MILLIMETRES: float = 150.0

const _LOG_SECONDS: float = 0.5

## The program COLMAP, where the user has said which.
var colmap: String = ""
var making: Making
var grid: PhotoGrid
var circle: Circle = Circle.new()
## What begins the work, and what ends it.
var begin: Button
var end: Button
var message: Label = Widgets.sentence()

var _session: Session
var _folder: String = ""
var _names: PackedStringArray = []
# Where the photos come out of one.
var _film: String = ""
var _stage_seen: String = ""
var _place: LineEdit = LineEdit.new()
var _browse: Button
var _time: OptionButton
var _order: OptionButton
var _matcher: OptionButton
var _bark: OptionButton
var _leaf_colors: OptionButton
var _height: SpinBox
var _marker: SpinBox
var _print_marker: Button
var _target: LineEdit = LineEdit.new()
var _options: GridContainer = GridContainer.new()
var _bar: ProgressBar = ProgressBar.new()
var _stage: Label
var _running: VBoxContainer = VBoxContainer.new()
var _show_log: CheckButton = CheckButton.new()
var _log_text: TextEdit = TextEdit.new()
var _log: PhotoLog
var _log_read: float = 0.0
var _started: int = 0


func _init(session: Session) -> void:
	_session = session
	set_translation_domain(session.get_translation_domain())
	making = Making.new(session)
	making.ended.connect(_on_ended)
	_add_folder()
	grid = PhotoGrid.new(session.jobs)
	grid.set_translation_domain(session.get_translation_domain())
	add_child(grid)
	_add_options()
	_add_progress()
	_add_message()
	_add_log()
	show_folder("")


## Ends its part in the session. What runs goes on until the session ends it.
func close() -> void:
	grid.stop()
	making.close()


## Shows another folder of photos, unless one is being worked on.
func show_folder(folder: String) -> void:
	if making.is_running():
		return
	_folder = folder.trim_suffix("/") if folder.length() > 1 else folder
	_place.text = _folder
	_names = PhotoFolder.list(_folder)
	_film = PhotoFolder.film_of(_folder)
	_log = null
	_log_text.text = ""
	circle.visible = false
	if not _folder.is_empty():
		_target.text = PhotoFolder.free_tree_path(_folder)
	grid.show_photos(_folder, _names, _converted_in(_work_folder()))
	_tell_folder()
	_update_buttons()


## To be called once a frame.
func update() -> void:
	grid.update()
	if not making.is_running():
		return
	_bar.value = making.job.progress
	if making.job.stage == "Features" and _stage_seen != "Features":
		grid.show_converted(_converted_in(making.work))
	_stage_seen = making.job.stage
	var words: String = making.get_stage()
	if making.job.cancelled:
		words = tr("Ending…")
	var seconds: float = float(Time.get_ticks_msec() - _started)
	_stage.text = "%s (%s)" % [words, Widgets.duration(maxf(seconds, 1000.0))]
	var now: float = Time.get_ticks_msec() / 1000.0
	if now - _log_read >= _LOG_SECONDS:
		_log_read = now
		_update_log()


# Where the photos that were HEIC lie as JPEGs.
static func _converted_in(work: String) -> String:
	return "" if work.is_empty() else work.path_join("photos")


func _work_folder() -> String:
	return "" if _folder.is_empty() else PhotoFolder.work_folder(_folder, _target.text)


func _add_folder() -> void:
	var line: HBoxContainer = HBoxContainer.new()
	_place.editable = false
	_place.placeholder_text = tr("Choose a folder of photos or a film, or drop it here")
	_place.tooltip_text = tr("The folder of the photos, from all around one tree.")
	_place.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	_browse = (
		Widgets
		. button(
			"Choose Photos…",
			"Chooses the folder of the photos, or a film of a walk around the tree. They are only read.",
			&"Folder"
		)
	)
	_browse.pressed.connect(folder_wanted.emit)
	line.add_child(_place)
	line.add_child(_browse)
	add_child(line)


func _add_options() -> void:
	var tips: Dictionary[String, String] = {}
	for option: Dictionary in TreeReconstructor.get_photo_option_list():
		tips[option.name] = option.description
	# Two options a line: the window fits a small screen, and photos and messages have room.
	_options.columns = 4
	_time = Widgets.choice(["Quick", "Normal", "Best"], ["quick", "normal", "best"])
	Widgets.choose(_time, "normal")
	_order = Widgets.choice(
		["By their number", "Neighbours by name", "All with all"],
		["auto", "sequence", "exhaustive"]
	)
	Widgets.choose(_order, "auto")
	_matcher = Widgets.choice(
		["As needed", "Features", "Tracked corners", "Both"], ["auto", "sift", "pyrlk", "both"]
	)
	Widgets.choose(_matcher, "auto")
	_bark = Widgets.choice(["From the photos", "Drawn"], [true, false])
	Widgets.choose(_bark, true)
	_leaf_colors = Widgets.choice(["From the photos", "Drawn"], [true, false])
	Widgets.choose(_leaf_colors, true)
	_height = Widgets.number(0.0, 100.0, 0.01, "m")
	_height.allow_greater = true
	_marker = Widgets.number(0.0, 600.0, 0.1, "mm")
	_marker.allow_greater = true
	_print_marker = (
		Widgets
		. button(
			"Save Marker to Print…",
			(
				"Saves a page with a marker of this side, or of 150 mm, to be printed at 100 %. Put it beside"
				+ " the tree before you take the photos: two of them must show all of it, from"
				+ " different sides."
			),
			&"Save"
		)
	)
	_print_marker.pressed.connect(marker_wanted.emit)
	_target.text_changed.connect(_update_buttons.unbind(1))
	_add_option("Time", tips["time"], _time)
	_add_option("Bark", tips["bark"], _bark)
	_add_option("Compare", tips["order"], _order)
	_add_option("Leaf colors", tips["leaf_colors"], _leaf_colors)
	_add_option("Compare by", tips["matcher"], _matcher)
	_add_option(
		"Height of the tree",
		(
			"Photos don't tell how large things are. The tree's height sets its size; 0 is not known:"
			+ " then it gets a usual one, which can be changed in the dock later."
		),
		_height
	)
	_add_option("Marker's side", tips["marker_side"], _marker_line())
	_add_option("Save as", "The tree's file in the project. What is there already stays.", _target)
	add_child(_options)


func _marker_line() -> Control:
	var line: HBoxContainer = HBoxContainer.new()
	_marker.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	for option: Dictionary in TreeReconstructor.get_photo_option_list():
		if option.name == "marker_side":
			_marker.tooltip_text = option.description
	line.add_child(_marker)
	line.add_child(_print_marker)
	return line


## Writes the marker to print, and says so.
func save_marker(path: String) -> void:
	var side: float = _marker.value if _marker.value > 0.0 else MARKER_MILLIMETRES
	var worker: TreeReconstructor = TreeReconstructor.new()
	if worker.save_marker(path, 0, side / 1000.0) != OK:
		var sentence: String = Session.Sentences.translate(
			worker.get_error_message(), get_translation_domain()
		)
		_say(sentence, &"error_color")
		_session.say(sentence, Session.Kind.ERROR)
		return
	_say(
		(
			tr(
				(
					"The marker was saved as %s. Print it at 100 %%, measure its black square, and set"
					+ " Marker's side to that."
				)
			)
			% path
		),
		&"font_color"
	)


func _add_option(title: String, tip: String, control: Control) -> void:
	var label: Label = Widgets.words(title, tip)
	label.clip_text = false
	label.text_overrun_behavior = TextServer.OVERRUN_NO_TRIMMING
	label.size_flags_horizontal = Control.SIZE_FILL
	control.tooltip_text = tip
	control.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	_options.add_child(label)
	_options.add_child(control)


func _add_progress() -> void:
	var line: HBoxContainer = HBoxContainer.new()
	begin = Widgets.button("Make Tree", _tip(), &"Play")
	begin.pressed.connect(_on_begin)
	end = Widgets.button(
		"Cancel",
		"Ends this work. What is done is kept: it goes on from there the next time.",
		&"Close"
	)
	end.pressed.connect(making.cancel)
	_stage = Widgets.words("", "What the work is at, and for how long it has run.")
	_stage.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	_bar.max_value = 1.0
	_bar.step = 0.0
	_bar.tooltip_text = tr("How far the work is.")
	_running.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	_running.add_child(_stage)
	_running.add_child(_bar)
	line.add_child(_running)
	line.add_child(end)
	line.add_child(begin)
	line.alignment = BoxContainer.ALIGNMENT_END
	add_child(line)


# Of any length: there may be many warnings.
func _add_message() -> void:
	var below: HBoxContainer = HBoxContainer.new()
	var scroll: ScrollContainer = ScrollContainer.new()
	scroll.horizontal_scroll_mode = ScrollContainer.SCROLL_MODE_DISABLED
	scroll.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	scroll.custom_minimum_size = Vector2(Widgets.px(300), Widgets.px(72))
	message.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	scroll.add_child(message)
	below.add_child(circle)
	below.add_child(scroll)
	add_child(below)


func _add_log() -> void:
	_show_log.text = "What COLMAP says"
	_show_log.tooltip_text = "Shows all that the program COLMAP says about the photos."
	_show_log.toggled.connect(_on_log_toggled)
	_log_text.editable = false
	_log_text.visible = false
	_log_text.tooltip_text = tr("What the program COLMAP says; it is kept in photos.log.")
	_log_text.custom_minimum_size.y = Widgets.px(140)
	_log_text.size_flags_vertical = Control.SIZE_EXPAND_FILL
	_log_text.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	add_child(_show_log)
	add_child(_log_text)


func _on_begin() -> void:
	begins.emit()
	var options: Dictionary = {
		"time": _time.get_selected_metadata(),
		"order": _order.get_selected_metadata(),
		"matcher": _matcher.get_selected_metadata(),
		"bark": _bark.get_selected_metadata(),
		"leaf_colors": _leaf_colors.get_selected_metadata(),
	}
	if not colmap.is_empty():
		options["colmap"] = colmap
	if _height.value > 0.0:
		options["known_height"] = _height.value
	if _marker.value > 0.0:
		options["marker_side"] = _marker.value / 1000.0
	_started = Time.get_ticks_msec()
	message.text = ""
	circle.visible = false
	making.start(_folder, _target.text, options)
	_log = PhotoLog.new(making.work.path_join("photos.log"))
	_update_buttons()


func _on_ended(tree: TreeReconstruction, sentence: String) -> void:
	_update_log()
	_show_report()
	# Between two frames the stage that shows them may have gone by.
	if tree != null:
		grid.show_converted(_converted_in(making.work))
		made.emit(tree)
	elif not sentence.is_empty():
		_say(sentence, &"error_color")
		_session.say(sentence, Session.Kind.ERROR)
	else:
		_say(tr("Ended. The next time it goes on from there."), &"font_color")
	_update_buttons()


## Says where the tree is, and what should be known of it.
func say_where(tree: TreeReconstruction, is_in_scene: bool) -> void:
	var photos: Dictionary = making.get_photos()
	var sentences: PackedStringArray = [
		(
			tr("%d of %d photos were used. The tree is %s.")
			% [photos.get("placed", 0), photos.get("photos", 0), tree.resource_path]
		)
	]
	var bark: Material = PhotoBark.of(tree)
	if bark != null:
		sentences.append(tr("Its bark is that of the photos: %s.") % bark.resource_path)
	var leaves: Material = PhotoLeaves.of(tree)
	if leaves != null:
		sentences.append(tr("Its leaves have the colors of the photos: %s.") % leaves.resource_path)
	if not is_in_scene:
		sentences.append(tr("Drag it from the FileSystem dock into a scene."))
	sentences.append(
		tr("Compare with Photos in the Tree menu above the 3D view lays it over its photos.")
	)
	sentences.append_array(making.get_warnings())
	_say("\n".join(sentences), &"font_color")


func _show_report() -> void:
	var photos: Dictionary = making.get_photos()
	if not photos.is_empty():
		grid.set_missing(photos["missing"])
		circle.show_report(photos)


func _update_log() -> void:
	if _log == null or not _log.update():
		return
	grid.set_features(_log.features)
	if _log_text.visible:
		_log_text.text = "\n".join(_log.lines)
		_log_text.scroll_vertical = _log_text.get_line_count()


func _on_log_toggled(on: bool) -> void:
	_log_text.visible = on
	if on and _log != null:
		_log.update()
		_log_text.text = "\n".join(_log.lines)
		_log_text.scroll_vertical = _log_text.get_line_count()


func _tell_folder() -> void:
	if _folder.is_empty():
		_say(
			tr(
				(
					"Walk around a tree and take 30 to 50 photos, one every 10 to 15 degrees, with the"
					+ " whole tree in them. The program COLMAP, which is installed apart, finds where"
					+ " they were taken from."
				)
			),
			&"font_color"
		)
	elif not _film.is_empty():
		_say(
			tr(
				(
					"A film: photos are taken out of it, one for each step of the walk. The program ffmpeg,"
					+ " which is installed apart, does that."
				)
			),
			&"font_color"
		)
	elif _names.is_empty():
		_say(
			tr("There are no photos in this folder (JPEG, HEIC, PNG, TIFF or BMP)."),
			&"warning_color"
		)
	elif _names.size() < PhotoFolder.LEAST:
		_say(
			(
				tr("There are only %d photos in this folder: 8 are the least, 30 are better.")
				% _names.size()
			),
			&"warning_color"
		)
	elif PhotoFolder.is_begun(_folder, _target.text):
		_say(
			tr("%d photos. Work on them was begun, and goes on from there.") % _names.size(),
			&"font_color"
		)
	else:
		_say(tr("%d photos.") % _names.size(), &"font_color")


func _say(sentence: String, color: StringName) -> void:
	message.text = sentence
	if color == &"font_color":
		message.remove_theme_color_override(&"font_color")
	else:
		message.add_theme_color_override(
			&"font_color", get_theme_color(color, &"Editor") if is_inside_tree() else Color.ORANGE
		)


func _update_buttons() -> void:
	var running: bool = making.is_running()
	var problem: String = _problem()
	begin.visible = not running
	begin.disabled = not problem.is_empty()
	begin.tooltip_text = _tip() if problem.is_empty() else problem
	end.visible = running
	_running.visible = running
	_browse.disabled = running
	_marker.editable = not running
	for control: Node in _options.get_children():
		if control is OptionButton:
			(control as OptionButton).disabled = running
		elif control is LineEdit:
			(control as LineEdit).editable = not running
		elif control is SpinBox:
			(control as SpinBox).editable = not running


func _tip() -> String:
	return tr(
		(
			"Finds where the photos were taken from, and the tree in them."
			+ " You can go on working meanwhile."
		)
	)


# Why it can't begin; nothing if it can.
func _problem() -> String:
	if _film.is_empty() and _names.size() < PhotoFolder.LEAST:
		return tr("Choose a folder with 8 photos or more first.")
	var path: String = _target.text
	if not path.begins_with("res://") or path.get_extension() not in ["res", "tres"]:
		return tr("The tree's file is one of the project: res://….res.")
	if FileAccess.file_exists(path):
		return tr("%s is there already. Name another file.") % path
	return ""
