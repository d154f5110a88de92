@tool
extends "section.gd"
## How true the tree is to its scan, now and before the last edit; and where it is not.

const Files := preload("files.gd")
# Of Q: what is called good, and what fair.
const _GOOD: float = 0.75
const _FAIR: float = 0.5

var follow: CheckBox
var heat: CheckBox
var next: Button
var report: Button
var doubtful: Label
## Chooses the folder of the photos' masks.
var masks: Button
## By what the photos judge, or why they don't.
var judged: Label

var _figures: Dictionary[StringName, Label] = {}
var _before: Dictionary[StringName, Label] = {}
var _lines: Dictionary[StringName, Control] = {}
var _photos: VBoxContainer = VBoxContainer.new()
var _places: Array[Dictionary] = []
var _place: int = -1
var _of: TreeReconstruction
var _files: Files = Files.new()


func get_id() -> StringName:
	return &"fidelity"


func close() -> void:
	_files.close()


func _build() -> void:
	title = "Fidelity"
	tooltip_text = "How true the tree is to its scan, before and after your edits."
	follow = CheckBox.new()
	follow.text = "Compare with the scan"
	follow.tooltip_text = (
		"Reads the scan, and the photos if the tree was made of some, and measures the tree against them,"
		+ " now and after every edit."
	)
	follow.toggled.connect(_on_follow_toggled)
	body.add_child(follow)
	_build_photos()
	_add(
		&"skeleton",
		"Wood R_s",
		(
			"The share of the scan's points that lie in the wood, or at most 2 cm beside it: how well the"
			+ " branches follow the scan. 0.9 or more is good."
		)
	)
	_add(
		&"explained",
		"Explained",
		"The share of the scan's points that lie within 2 cm of the tree's bark. More is better."
	)
	_add(&"mean", "Mean distance", "How far the scan's points lie from the bark. Less is better.")
	_add(
		&"p95", "Most within", "95 of 100 points lie nearer to the bark than this. Less is better."
	)
	_add(
		&"coverage",
		"Bark seen",
		"The share of the bark that the scan's points lie on. The rest was not seen, or is guessed."
	)
	heat = CheckBox.new()
	heat.text = "Heat map"
	heat.tooltip_text = "Colours the scan's points: blue on the bark, red where the tree misses them."
	heat.toggled.connect(_on_heat_toggled)
	next = Widgets.button(
		"Next doubtful branch",
		"Shows the next branch that the scan hardly supports, and says why it is doubtful.",
		&"MoveDown"
	)
	next.pressed.connect(show_next)
	report = Widgets.button(
		"Save report…",
		"Writes a page with pictures and figures about the reconstruction, without your edits.",
		&"Save"
	)
	report.pressed.connect(_on_report_pressed)
	body.add_child(heat)
	body.add_child(buttons([next, report]))
	doubtful = Widgets.sentence()
	doubtful.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	doubtful.visible = false
	body.add_child(doubtful)


func _build_photos() -> void:
	body.add_child(_photos)
	_add(
		&"quality",
		"Fidelity Q",
		(
			"How true the tree is to its photos as a whole, 0 to 1: the product of the three figures I,"
			+ " R_3d and R_s. 0.75 or more is good, less than 0.5 poor."
		),
		_photos
	)
	_add(
		&"information",
		"Photos I",
		(
			"How much so many photos can tell of a tree: 0.83 for 8 of them, 0.99 for 20. Your edits don't"
			+ " change it; more photos do."
		),
		_photos
	)
	_add(
		&"reconstruction",
		"Points R_3d",
		(
			"The share of the scan's points that fall on the tree in the photos, on average over all photos."
			+ " 0.9 or more is good; less where points are beside the tree, or where photos show only a part"
			+ " of it. Your edits don't change it."
		),
		_photos
	)
	_add(
		&"precision",
		"Precision",
		(
			"Of the tree's outline as it is drawn, with its leaves if they are shown, the share that covers"
			+ " the tree in the photos. Less means wood or leaves that the photos don't have."
		),
		_photos
	)
	_add(
		&"recall",
		"Recall",
		(
			"Of the tree's outline in the photos, the share that the drawn tree covers. Less means that wood"
			+ " or leaves are missing. Only masks of the photos tell it."
		),
		_photos
	)
	_add(
		&"iou",
		"Overlap (IoU)",
		(
			"What the drawn tree and the tree in the photos both cover, of what either of them covers. 1 is"
			+ " a perfect outline. Only masks of the photos tell it."
		),
		_photos
	)
	judged = Widgets.sentence()
	judged.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	judged.modulate.a = 0.7
	_photos.add_child(judged)
	masks = (
		Widgets
		. button(
			"Choose Masks…",
			(
				"Chooses the folder with a mask of each photo: a picture of the photo's size, white where the"
				+ " tree is. A folder 'masks' beside the photos is found by itself."
			),
			&"Folder"
		)
	)
	masks.pressed.connect(_on_masks_pressed)
	_photos.add_child(masks)
	_photos.add_child(HSeparator.new())


func _refresh() -> void:
	var scanned: bool = _has_scan()
	follow.disabled = not scanned
	report.disabled = not scanned
	follow.set_pressed_no_signal(session.scan.is_following())
	if scanned and session.tree != _of and session.scan.is_following():
		# Of another tree nothing is loaded yet.
		session.scan.measure()
	var measured: TreeFidelity = session.scan.fidelity if scanned else null
	if measured == null or session.tree != _of:
		_places.clear()
		_place = -1
		doubtful.visible = false
	_of = session.tree
	next.disabled = measured == null
	heat.disabled = measured == null
	var coloured: bool = session.view.points and session.view.point_colors == 2
	heat.set_pressed_no_signal(coloured)
	var now: Dictionary = {} if measured == null else measured.get_current()
	var before: Dictionary = {} if measured == null else measured.get_previous()
	_refresh_photos(now, before)
	_show(&"skeleton", now, before, true, _share)
	_show(&"explained", now, before, true, _percent)
	_show(&"mean", now, before, false, _length)
	_show(&"p95", now, before, false, _length)
	_show(&"coverage", now, before, true, _percent)


func _refresh_photos(measured: Dictionary, measured_before: Dictionary) -> void:
	var photos: Session.PhotoJudge = session.photos
	_photos.visible = session.tree != null and photos.has_photos() and session.scan.is_following()
	if not _photos.visible:
		return
	var sky: bool = photos.is_by_sky()
	var now: Dictionary = photos.get_figures(measured, photos.outline)
	var before: Dictionary = photos.get_figures(measured_before, photos.before)
	var bound: Callable = _at_most if sky else _share
	_show(&"quality", now, before, true, bound)
	_show(&"information", now, {}, true, _share)
	_show(&"reconstruction", now, {}, true, bound)
	_show(&"precision", now, before, true, bound)
	_show(&"recall", now, before, true, _share)
	_show(&"iou", now, before, true, _share)
	for id: StringName in [&"recall", &"iou"]:
		_lines[id].visible = not sky
	# What is shown is of the tree before the last edit until the photos have been looked at again.
	var old: bool = photos.stale or photos.is_measuring()
	for id: StringName in [&"precision", &"recall", &"iou"]:
		_figures[id].modulate.a = 0.4 if old else 1.0
	_judge(now.get(&"quality", -1.0) as float)
	judged.text = _tell_judges()
	judged.visible = not judged.text.is_empty()
	masks.visible = sky or not photos.sentence.is_empty()


# A word with Q: the paper's own trees have 0.67 to 0.88.
func _judge(quality: float) -> void:
	var words: Label = _lines[&"quality"].get_child(0) as Label
	words.remove_theme_color_override(&"font_color")
	if quality < 0.0:
		words.text = "Fidelity Q"
		return
	var color: StringName = &"success_color"
	var verdict: String = tr("good")
	if quality < _FAIR:
		color = &"error_color"
		verdict = tr("poor")
	elif quality < _GOOD:
		color = &"warning_color"
		verdict = tr("fair")
	words.text = "Q · " + verdict
	if has_theme_color(color, &"Editor"):
		words.add_theme_color_override(&"font_color", get_theme_color(color, &"Editor"))


func _tell_judges() -> String:
	var photos: Session.PhotoJudge = session.photos
	if not photos.sentence.is_empty():
		return photos.sentence
	if photos.is_reading():
		return tr("The photos are being read.")
	if photos.cloud.is_empty():
		return ""
	var count: int = (photos.cloud["photos"] as Array).size()
	if photos.is_by_sky():
		return (
			tr(
				(
					"Judged by the sky of %d photos: precision only. What is missing is not seen without"
					+ " masks."
				)
			)
			% count
		)
	return tr("Judged by the masks of %d photos.") % count


func _on_masks_pressed() -> void:
	_files.ask_folder(
		tr("Choose Masks"), session.photos.get_folder_to_begin(), session.photos.take_masks
	)


## Selects and shows the next branch that is doubtful, and tells why it is.
func show_next() -> void:
	if session.scan.fidelity == null:
		return
	if _place + 1 >= _places.size():
		_places = session.scan.fidelity.get_doubtful()
		_place = -1
	while _place + 1 < _places.size():
		_place += 1
		var place: Dictionary = _places[_place]
		# It may have been cut since.
		if session.tree.has_node(place.node):
			session.select([place.node])
			session.select_subtree()
			session.view_wanted.emit(session.get_box_of(session.selection))
			doubtful.text = (
				tr("%d of %d: %.2f m, %s")
				% [
					_place + 1,
					_places.size(),
					place.length,
					Session.Sentences.translate_list(
						place.reasons, session.get_translation_domain()
					)
				]
			)
			doubtful.visible = true
			return
	doubtful.text = tr("The scan supports every branch.")
	doubtful.visible = true


## Writes a page about the reconstruction. It is done again first, since only what has just been
## reconstructed can be told of.
func save_report(path: String) -> void:
	var tree: TreeReconstruction = session.tree
	var worker: TreeReconstructor = TreeReconstructor.new()
	var source: String = tree.provenance.get("source", "")
	session.jobs.start(
		tr("Writing the report"),
		_write_report.bind(
			worker, source, tree.provenance.get("options", {}), path, session.photos.get_folders()
		),
		_on_report_written.bind(worker, path),
		worker
	)


static func _write_report(
	job: Session.Jobs.Job,
	worker: TreeReconstructor,
	source: String,
	options: Dictionary,
	path: String,
	photos: Dictionary
) -> bool:
	if worker.reconstruct_file(source, options) == null or job.cancelled:
		return false
	return worker.save_html_report(path, photos) == OK


func _on_report_written(
	written: bool, _job: Session.Jobs.Job, worker: TreeReconstructor, path: String
) -> void:
	if not written:
		session.say(worker.get_error_message(), session.Kind.ERROR)
		return
	session.say(tr("The report is in %s.") % path)
	Files.tell_editor(path)
	if Engine.is_editor_hint():
		OS.shell_open(ProjectSettings.globalize_path(path))


func _add(id: StringName, title: String, tip: String, to: Container = body) -> void:
	var value: Label = Widgets.figure(tip, 76)
	var old: Label = Widgets.figure(tip)
	old.modulate.a = 0.7
	_figures[id] = value
	_before[id] = old
	var line: HBoxContainer = HBoxContainer.new()
	line.add_child(Widgets.words(title, tip))
	line.add_child(old)
	line.add_child(value)
	_lines[id] = line
	to.add_child(line)


func _show(
	id: StringName, now: Dictionary, before: Dictionary, more_is_better: bool, words: Callable
) -> void:
	var value: Label = _figures[id]
	value.remove_theme_color_override(&"font_color")
	_before[id].text = ""
	if not now.has(id):
		value.text = "-"
		return
	value.text = words.call(now[id])
	if not before.has(id) or words.call(before[id]) == value.text:
		return
	_before[id].text = words.call(before[id])
	var rose: bool = now[id] > before[id]
	value.text = ("▲ " if rose else "▼ ") + value.text
	var color: StringName = &"success_color" if rose == more_is_better else &"error_color"
	if has_theme_color(color, &"Editor"):
		value.add_theme_color_override(&"font_color", get_theme_color(color, &"Editor"))


func _has_scan() -> bool:
	return not Session.ScanData.source_of(session.tree).is_empty()


func _on_follow_toggled(on: bool) -> void:
	if on:
		session.scan.measure()
	else:
		session.scan.stop_measuring()


func _on_heat_toggled(on: bool) -> void:
	if on:
		session.view.point_colors = session.view.PointColors.FIDELITY
		session.view.points = true
	else:
		session.view.point_colors = session.view.PointColors.SCAN


func _on_report_pressed() -> void:
	_files.ask(
		tr("Save Report"),
		Files.beside(session.tree, "html"),
		PackedStringArray(["*.html;" + tr("Page")]),
		save_report,
		true
	)


static func _percent(share: float) -> String:
	return "%.1f %%" % (100.0 * share)


static func _share(share: float) -> String:
	return "%.3f" % share


static func _at_most(share: float) -> String:
	return "≤ %.3f" % share


static func _length(metres: float) -> String:
	return "%.1f mm" % (1000.0 * metres)
