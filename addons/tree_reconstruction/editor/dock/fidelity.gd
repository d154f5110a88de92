@tool
extends "section.gd"
## How true the tree is to its scan, now and before the last edit; and where it is not.

const Files := preload("files.gd")

var follow: CheckBox
var heat: CheckBox
var next: Button
var report: Button
var doubtful: Label

var _figures: Dictionary[StringName, Label] = {}
var _before: Dictionary[StringName, Label] = {}
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
	follow.tooltip_text = "Reads the scan and measures the tree against it, now and after every edit."
	follow.toggled.connect(_on_follow_toggled)
	body.add_child(follow)
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
	_show(&"explained", now, before, true, _percent)
	_show(&"mean", now, before, false, _length)
	_show(&"p95", now, before, false, _length)
	_show(&"coverage", now, before, true, _percent)


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
		_write_report.bind(worker, source, tree.provenance.get("options", {}), path),
		_on_report_written.bind(worker, path),
		worker
	)


static func _write_report(
	job: Session.Jobs.Job,
	worker: TreeReconstructor,
	source: String,
	options: Dictionary,
	path: String
) -> bool:
	if worker.reconstruct_file(source, options) == null or job.cancelled:
		return false
	return worker.save_html_report(path) == OK


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


func _add(id: StringName, title: String, tip: String) -> void:
	var value: Label = Widgets.figure(tip, 76)
	var old: Label = Widgets.figure(tip)
	old.modulate.a = 0.7
	_figures[id] = value
	_before[id] = old
	var line: HBoxContainer = HBoxContainer.new()
	line.add_child(Widgets.words(title, tip))
	line.add_child(old)
	line.add_child(value)
	body.add_child(line)


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
	return session.tree != null and not session.tree.provenance.get("source", "").is_empty()


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


static func _length(metres: float) -> String:
	return "%.1f mm" % (1000.0 * metres)
