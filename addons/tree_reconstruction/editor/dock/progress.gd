@tool
extends VBoxContainer
## The work that is under way: what it is at, how far it is, and a button that ends it.

const Session := preload("../session.gd")
const Jobs := preload("../jobs.gd")
const Widgets := preload("widgets.gd")

## Milliseconds after which work is shown: what is done at once would only flicker.
var patience: int = 300

var _session: Session
var _lines: Dictionary[Jobs.Job, Line] = {}


# What shows one job.
class Line:
	extends VBoxContainer

	var since: int = Time.get_ticks_msec()
	var title: Label
	var bar: ProgressBar = ProgressBar.new()
	var cancel: Button

	func _init(job: Jobs.Job) -> void:
		title = Widgets.words(job.title, "What the addon is working at; you can go on meanwhile.")
		cancel = Widgets.button("Cancel", "Ends this work. Nothing is changed then.", &"Close")
		bar.size_flags_horizontal = Control.SIZE_EXPAND_FILL
		bar.size_flags_vertical = Control.SIZE_SHRINK_CENTER
		bar.max_value = 1.0
		bar.step = 0.0
		bar.indeterminate = not job.measured
		bar.show_percentage = job.measured
		bar.tooltip_text = "How far the work is."
		add_child(title)
		var below: HBoxContainer = HBoxContainer.new()
		below.add_child(bar)
		below.add_child(cancel)
		add_child(below)
		visible = false


func _init(session: Session) -> void:
	_session = session
	_session.jobs.changed.connect(_on_changed)


## Ends its part in the session.
func close() -> void:
	_session.jobs.changed.disconnect(_on_changed)


func _on_changed() -> void:
	var running: Array[Jobs.Job] = _session.jobs.get_running()
	for job: Jobs.Job in _lines.keys():
		if not job in running:
			_lines[job].queue_free()
			_lines.erase(job)
	for job: Jobs.Job in running:
		if not _lines.has(job):
			var made: Line = Line.new(job)
			made.cancel.pressed.connect(_session.jobs.cancel.bind(job))
			_lines[job] = made
			add_child(made)
		var shown: Line = _lines[job]
		shown.visible = Time.get_ticks_msec() - shown.since >= patience
		shown.bar.value = job.progress
		shown.cancel.disabled = job.cancelled
		var words: String = job.title if job.stage.is_empty() else job.title + ": " + job.stage
		if job.cancelled:
			words = tr("Ending: %s") % job.title
		if shown.title.text != words:
			shown.title.text = words
