@tool
extends VBoxContainer
## The dock "Tree": all about the tree that is edited, in sections that can be folded.
##
## It is made of a session alone, so that tests need no editor.

const Session := preload("../session.gd")
const Widgets := preload("widgets.gd")
const Section := preload("section.gd")
const Progress := preload("progress.gd")
const Stages := preload("stages.gd")
const Measurements := preload("measurements.gd")
const Fidelity := preload("fidelity.gd")
const LString := preload("lstring.gd")
const Twigs := preload("twigs.gd")
const Leaves := preload("leaf_rule.gd")
const Bark := preload("bark.gd")
const Variants := preload("variants.gd")
const Export := preload("export.gd")

# While a tree is dragged or a slider moves, what is shown follows so often, and less often where
# that would take more than a share of the time.
const _SECONDS: float = 0.1
const _SHARE: float = 0.1

var progress: Progress
## The sections by their ids, from top to bottom.
var sections: Dictionary[StringName, Section] = {}

var _session: Session
var _hint: Label
var _no_tree: Label
var _photos: Button
var _sketch: Button
var _welcome: ScrollContainer
var _scroll: ScrollContainer
var _timer: Timer = Timer.new()


func _init(session: Session) -> void:
	_session = session
	name = &"TreeDock"
	custom_minimum_size.x = Widgets.px(220)
	progress = Progress.new(session)
	add_child(progress)
	_hint = (
		Widgets
		. sentence(
			(
				"Select a TreeInstance3D in the scene to shape its tree here. A point cloud that you drop"
				+ " into the project becomes a tree by itself; drag it from the FileSystem dock into the scene."
			)
		)
	)
	_hint.tooltip_text = "No tree is selected."
	# A tab that is not shown has no width yet, and asks for height all the same.
	_hint.custom_minimum_size.x = Widgets.px(200)
	_hint.mouse_filter = Control.MOUSE_FILTER_PASS
	_hint.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	# While it has no width yet it would be as high as it has words, and the editor with it.
	_welcome = ScrollContainer.new()
	_welcome.size_flags_vertical = Control.SIZE_EXPAND_FILL
	_welcome.horizontal_scroll_mode = ScrollContainer.SCROLL_MODE_DISABLED
	_no_tree = (
		Widgets
		. sentence(
			"This node shows no tree yet. Drag a tree or a scan onto its Reconstruction in the inspector."
		)
	)
	_no_tree.tooltip_text = "The selected node has no tree."
	_no_tree.mouse_filter = Control.MOUSE_FILTER_PASS
	var hints: VBoxContainer = VBoxContainer.new()
	hints.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	hints.add_child(_hint)
	hints.add_child(_no_tree)
	_photos = Widgets.button(
		"New Tree from Photos…",
		"Opens a window that makes a tree of photos from all around it.",
		&"Image"
	)
	_photos.pressed.connect(session.photos_wanted.emit)
	hints.add_child(_photos)
	_sketch = Widgets.button(
		"Sketch a Tree…",
		"Opens a window where a crown, a trunk and branches that you draw become a tree.",
		&"Edit"
	)
	_sketch.pressed.connect(session.sketch_wanted.emit)
	hints.add_child(_sketch)
	_welcome.add_child(hints)
	add_child(_welcome)
	_scroll = ScrollContainer.new()
	_scroll.size_flags_vertical = Control.SIZE_EXPAND_FILL
	_scroll.horizontal_scroll_mode = ScrollContainer.SCROLL_MODE_DISABLED
	add_child(_scroll)
	var list: VBoxContainer = VBoxContainer.new()
	list.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	_scroll.add_child(list)
	for section: Section in [
		Stages.new(session),
		Measurements.new(session),
		Fidelity.new(session),
		Leaves.new(session),
		Bark.new(session),
		Twigs.new(session),
		LString.new(session),
		Variants.new(session),
		Export.new(session),
	]:
		sections[section.get_id()] = section
		list.add_child(section)
	_timer.one_shot = true
	_timer.wait_time = _SECONDS
	_timer.timeout.connect(update)
	add_child(_timer)
	_session.node_changed.connect(_on_changed)
	_session.tree_changed.connect(_on_changed)
	_session.selection_changed.connect(_on_changed)
	_session.view_changed.connect(_on_changed)
	_session.scan_changed.connect(_on_changed)
	_session.scan.fidelity_changed.connect(_on_changed)
	_session.photos.changed.connect(_on_changed)
	# Its children become visible after it.
	visibility_changed.connect(update, CONNECT_DEFERRED)
	_on_changed()


## Ends its part in the session.
func close() -> void:
	for section: Section in sections.values():
		section.close()
	progress.close()
	_session.node_changed.disconnect(_on_changed)
	_session.tree_changed.disconnect(_on_changed)
	_session.selection_changed.disconnect(_on_changed)
	_session.view_changed.disconnect(_on_changed)
	_session.scan_changed.disconnect(_on_changed)
	_session.scan.fidelity_changed.disconnect(_on_changed)
	_session.photos.changed.disconnect(_on_changed)


## Brings what is seen up to date. That happens by itself, some times a second.
func update() -> void:
	var edited: bool = _session.node != null
	var with_tree: bool = edited and _session.tree != null
	_hint.visible = not edited
	_no_tree.visible = edited
	_welcome.visible = not with_tree
	_scroll.visible = with_tree
	var started: int = Time.get_ticks_usec()
	for section: Section in sections.values():
		section.update()
	_timer.wait_time = maxf(_SECONDS, (Time.get_ticks_usec() - started) / 1e6 / _SHARE)


## The ids of the sections that are folded.
func get_folded() -> PackedStringArray:
	var folded: PackedStringArray = []
	for id: StringName in sections:
		if sections[id].folded:
			folded.append(id)
	return folded


## Folds these sections and opens all others.
func set_folded(ids: PackedStringArray) -> void:
	for id: StringName in sections:
		sections[id].folded = String(id) in ids
	update()


func _on_changed() -> void:
	for section: Section in sections.values():
		section.invalidate()
	if is_inside_tree() and _timer.is_stopped():
		_timer.start()
