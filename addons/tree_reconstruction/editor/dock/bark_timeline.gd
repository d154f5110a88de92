@tool
extends VBoxContainer
## How the bark grew, to be scrubbed through and played: a slider of steps, whose end is the tree.
## It changes nothing of the user's.

const BarkFrames := preload("../bark/bark_frames.gd")
const BarkWork := preload("../bark/bark_work.gd")
const Session := preload("../session.gd")
const Widgets := preload("widgets.gd")

const _FRAMES_PER_SECOND: float = 20.0

var slider: HSlider = HSlider.new()
var play: Button
var back: Button
var record: Button

var _session: Session
var _work: BarkWork
var _frames: BarkFrames
var _line: HBoxContainer = HBoxContainer.new()
var _step: Label
var _timer: Timer = Timer.new()
# What is scrubbed through: another recording, or another tree, ends it.
var _of: Array[Dictionary] = []


func _init(session: Session, work: BarkWork) -> void:
	_session = session
	_work = work
	_frames = BarkFrames.new(session)
	play = Widgets.button("", "Plays how the bark grew, from its first step on.", &"Play")
	play.pressed.connect(_on_play_pressed)
	_line.add_child(play)
	slider.tooltip_text = (
		"How the bark grew, step by step. Nothing of your tree changes: at the end of the slider it"
		+ " is shown again."
	)
	slider.step = 1.0
	slider.scrollable = false
	slider.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	slider.size_flags_vertical = Control.SIZE_SHRINK_CENTER
	slider.value_changed.connect(_on_value_changed)
	slider.drag_started.connect(_timer.stop)
	_line.add_child(slider)
	_step = Widgets.figure("The step that is shown, and all that the bark took.", 64.0)
	_line.add_child(_step)
	back = Widgets.button("", "Shows the tree again.", &"Close")
	back.pressed.connect(end)
	_line.add_child(back)
	add_child(_line)
	record = (
		Widgets
		. button(
			"Show How It Grew",
			(
				"Grows the bark once more in the background, to keep its steps for this slider. The tree"
				+ " stays as it is."
			),
			&"Animation"
		)
	)
	record.pressed.connect(_work.record)
	add_child(record)
	_timer.wait_time = 1.0 / _FRAMES_PER_SECOND
	_timer.timeout.connect(_on_timeout)
	add_child(_timer)
	visibility_changed.connect(_on_visibility_changed)


## Brings it up to date.
func refresh() -> void:
	var frames: Array[Dictionary] = _work.get_frames()
	if not is_same(frames, _of):
		end()
		_of = frames
		slider.max_value = maxi(frames.size() - 1, 1)
		slider.set_value_no_signal(slider.max_value)
	var tree: TreeReconstruction = _session.tree
	var grown: bool = tree != null and tree.has_grown_bark() and not tree.is_bark_stale()
	visible = grown
	_line.visible = frames.size() > 1
	record.visible = not _line.visible
	record.disabled = _work.is_growing() or _work.is_recording()
	_show_state()


## Whether a step is shown instead of the tree.
func is_open() -> bool:
	return _session.view.growing


## Shows the tree again.
func end() -> void:
	_timer.stop()
	_frames.clear()
	slider.set_value_no_signal(slider.max_value)
	_show_state()


func close() -> void:
	end()


func _show_state() -> void:
	back.disabled = not is_open()
	play.set(&"icon_name", &"Play" if _timer.is_stopped() else &"Pause")
	if _of.is_empty():
		return
	_step.text = ("%d / %d" % [_of[mini(roundi(slider.value), _of.size() - 1)].step, _of[-1].step])


func _on_play_pressed() -> void:
	if not _timer.is_stopped():
		_timer.stop()
		_show_state()
		return
	if slider.value >= slider.max_value:
		slider.value = 0.0
	_timer.start()
	_show_state()


func _on_timeout() -> void:
	slider.value += 1.0
	if slider.value >= slider.max_value:
		_timer.stop()
	_show_state()


func _on_value_changed(value: float) -> void:
	if value >= slider.max_value or _of.is_empty():
		_frames.clear()
	else:
		_frames.show(_of[roundi(value)].bark)
	_show_state()


# While its section is folded nobody could end it.
func _on_visibility_changed() -> void:
	if not is_visible_in_tree() and is_open():
		end()
