@tool
extends VBoxContainer
## A tree from strokes: the paper they are drawn on, what else decides the tree, and what was
## understood.
##
## The strokes live in the tree, in [code]provenance["sketch"][/code], and every finished change is
## a step of the editor's history: so undoing brings back strokes and tree together. It is made of a
## session alone, so that tests need no editor.

## A tree came of the first strokes: whoever hears it puts it into the scene, and tells its node by
## [method set_node].
signal made(tree: TreeReconstruction)
## Another node's tree is drawn on, and should be selected.
signal node_wanted(node: TreeInstance3D)
## A step of the editor's own history should be undone or done again.
signal history_wanted(redo: bool)
## The user wants to choose a file to read strokes from, or to write them to.
signal load_wanted
signal save_wanted
## The user has had enough.
signal close_wanted

const Session := preload("../session.gd")
const Rerun := preload("../dock/rerun.gd")
const Widgets := preload("../dock/widgets.gd")
const Canvas := preload("sketch_canvas.gd")
const Options := preload("sketch_options.gd")
const Maker := preload("sketch_maker.gd")
const Draft := preload("sketch_draft.gd")
const Follow := preload("sketch_follow.gd")
const Bar := preload("sketch_bar.gd")
const Files := preload("sketch_files.gd")
const Known := preload("sketch_known.gd")
const Message := preload("sketch_message.gd")
const ViewStrokes := preload("view_strokes.gd")

# A number that is turned has its tree once it rests for so long.
const _REST_MSEC: int = 250

var canvas: Canvas = Canvas.new()
var options: Options
var bar: Bar = Bar.new()
var message: Message = Message.new()
## Strokes that are drawn right in the 3D view.
var view: ViewStrokes
var maker: Maker
var files: Files

var _session: Session
var _draft: Draft = Draft.new()
var _follow: Follow = Follow.new()
var _known: Known = Known.new()
# Whose tree is drawn on.
var _node: WeakRef = weakref(null)
# What the session edited when it was looked at last.
var _edited: WeakRef = weakref(null)
# The sketch of that tree when it was looked at last, and whether the node stood in the scene.
var _seen: TreeSketch
var _was_there: bool = false
# How many edits did not fit the last tree.
var _left_out: int = 0
# As it is on the paper, with what is being made.
var _current: TreeSketch = TreeSketch.new()
# What is under way on the paper and was not followed yet.
var _under_way: Callable
var _may_follow: bool = false
# The title of a step that begins when a number rests, and when.
var _due_title: String = ""
var _due: int = 0
var _due_height: bool = false
# Undo and redo that wait until what is finished is made: whether each is a redo.
var _held: Array[bool] = []


func _init(session: Session) -> void:
	_session = session
	set_translation_domain(session.get_translation_domain())
	options = Options.new(session)
	maker = Maker.new(session)
	maker.finished.connect(_on_finished)
	maker.followed.connect(_on_followed)
	maker.understood.connect(_on_understood)
	view = ViewStrokes.new(session)
	files = Files.new(session)
	files.loaded.connect(_on_told.bind(tr("Load Sketch")))
	files.said.connect(message.say)
	add_child(bar)
	var split: HBoxContainer = HBoxContainer.new()
	split.size_flags_vertical = Control.SIZE_EXPAND_FILL
	canvas.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	canvas.size_flags_vertical = Control.SIZE_EXPAND_FILL
	options.custom_minimum_size.x = Widgets.px(190)
	split.add_child(canvas)
	split.add_child(options)
	add_child(split)
	message.set_translation_domain(session.get_translation_domain())
	add_child(message.framed())
	_connect_all()
	_draft.begin(null)
	_show()


## Ends its part in the session.
func close() -> void:
	canvas.cancel()
	view.enabled = false
	_follow.restore()
	maker.close()


## Whether something is under way that [method update] has to end.
func is_busy() -> bool:
	return is_drawing() or maker.is_busy() or _due > 0 or not _held.is_empty()


## Whether a stroke is being drawn, bent or rubbed out, on the paper or in the 3D view.
func is_drawing() -> bool:
	return canvas.is_busy() or view.is_busy()


## The strokes on the paper, with what is being made of them. Not to be changed.
func get_sketch() -> TreeSketch:
	return _current


## The node whose tree is drawn on, if it stands in the scene; else [code]null[/code].
func get_node_drawn_on() -> TreeInstance3D:
	var node: TreeInstance3D = _node.get_ref() as TreeInstance3D
	var there: bool = node != null and node.is_inside_tree() and not node.is_queued_for_deletion()
	return node if there and sketch_of(node.reconstruction) != null else null


## Draws on at the tree of [param node], or, without one, begins a new tree.
func set_node(node: TreeInstance3D) -> void:
	_node = weakref(node)
	_was_there = node != null
	if node == null:
		_draft.begin(null)
	# Other strokes have the same ids.
	canvas.understood = {}
	canvas.selected = 0
	if not maker.is_busy():
		_show()


## The strokes that a tree was made of, or [code]null[/code].
static func sketch_of(tree: TreeReconstruction) -> TreeSketch:
	return null if tree == null else tree.provenance.get("sketch") as TreeSketch


## To be called once a frame.
func update() -> void:
	if is_drawing():
		_follow_pen()
		return
	if _due > 0 and Time.get_ticks_msec() >= _due:
		settle()
	if maker.is_busy() or _due > 0:
		return
	if not _held.is_empty():
		_go(_held.pop_front())
		return
	_take_edited()
	var node: TreeInstance3D = get_node_drawn_on()
	if node != null and not _was_there and _session.node == null:
		# It was undone, and is back.
		node_wanted.emit(node)
	_was_there = node != null
	if not is_same(_base(), _seen):
		_show()


## Begins the step of a number that was turned, without waiting for its rest.
func settle() -> void:
	if _due > 0:
		_due = 0
		# A height that was told is the tree's from now on.
		var plane: ViewStrokes.ViewPlane = null if _due_height else view.wanted_plane(_current)
		maker.make(_due_title, _current, _log(), plane)


## Undoes the last stroke or another step, or does it again.
func step(redo: bool) -> void:
	if is_drawing():
		return
	settle()
	if maker.is_busy() or not _held.is_empty():
		_held.append(redo)
	else:
		_go(redo)


func _connect_all() -> void:
	canvas.drawing.connect(_on_drawing)
	canvas.bending.connect(_on_bending)
	canvas.drawn.connect(_on_drawn)
	canvas.bent.connect(_on_bent)
	canvas.erased.connect(_on_erased)
	canvas.cancelled.connect(_on_cancelled)
	canvas.chosen.connect(_on_chosen)
	view.drawing.connect(_on_drawing)
	view.drawn.connect(_on_drawn_in_view)
	view.cancelled.connect(_on_cancelled)
	view.chosen.connect(_on_chosen_in_view)
	view.said.connect(message.say.bind(&"warning_color"))
	options.value_chosen.connect(_on_value)
	options.role_chosen.connect(_on_role)
	options.twigs.taken.connect(_on_told)
	bar.tool_chosen.connect(_on_tool)
	bar.in_view_chosen.connect(func(on: bool) -> void: view.enabled = on)
	bar.begin.pressed.connect(set_node.bind(null))
	bar.load_file.pressed.connect(load_wanted.emit)
	bar.save_file.pressed.connect(save_wanted.emit)
	bar.clear.pressed.connect(_on_clear)


func _shortcut_input(event: InputEvent) -> void:
	if not event.is_pressed():
		return
	if event.is_action_pressed(&"ui_undo", true, true):
		step(false)
	elif event.is_action_pressed(&"ui_redo", true, true):
		step(true)
	elif event.is_action_pressed(&"ui_graph_delete", false, true) and canvas.selected != 0:
		_on_erased([canvas.selected])
	elif event.is_action_pressed(&"ui_cancel"):
		if is_drawing():
			canvas.cancel()
			view.cancel()
		else:
			close_wanted.emit()
	else:
		return
	get_viewport().set_input_as_handled()


# Another tree of strokes is edited now: that is drawn on.
func _take_edited() -> void:
	var node: TreeInstance3D = _session.node
	if node == _edited.get_ref():
		return
	_edited = weakref(node)
	if node != null and node != _node.get_ref() and sketch_of(node.reconstruction) != null:
		set_node(node)


# What is drawn on: the sketch of the tree that stands, if any does.
func _base() -> TreeSketch:
	var node: TreeInstance3D = get_node_drawn_on()
	return null if node == null else sketch_of(node.reconstruction)


func _log() -> String:
	var node: TreeInstance3D = get_node_drawn_on()
	return "" if node == null else node.reconstruction.edit_log


func _go(redo: bool) -> void:
	var is_own: bool = _draft.goes_on_from(_base())
	if is_own and not redo and _draft.has_undo():
		_draft.undo()
		_show()
	elif is_own and redo and _draft.has_redo():
		_draft.redo()
		_show()
	else:
		history_wanted.emit(redo)


# Shows what there is.
func _show() -> void:
	_seen = _base()
	if _draft.goes_on_from(_seen):
		_current = _draft.get_sketch()
	elif _seen != null:
		_current = _seen
	else:
		_draft.begin(null)
		_current = _draft.get_sketch()
	_put_on_paper()
	if not _known.has(_current) and not _current.strokes.is_empty():
		maker.read(_current)


func _put_on_paper() -> void:
	canvas.sketch = _current
	var known: Dictionary[int, Dictionary] = _known.get_strokes(_current)
	# Where no tree came of it, they keep the colors that they had.
	if not known.is_empty():
		canvas.understood = known
	options.show_sketch(_current, canvas.selected)
	view.show_sketch(_current, canvas.understood, get_node_drawn_on(), _base())
	view.selected = canvas.selected
	view.set_scale_of_base(_known.get_stem_base(_base()), _known.get_pixel(_base()))
	bar.update(not _current.strokes.is_empty())
	message.tell(_known, _current)


# A finished change: its tree follows, as a step.
func _change(title: String, sketch: TreeSketch) -> void:
	_due = 0
	view.carry(_current, sketch)
	_current = sketch
	_put_on_paper()
	maker.make(title, sketch, _log(), view.wanted_plane(sketch))


func _on_finished(order: Maker.Order, tree: TreeReconstruction) -> void:
	_follow.restore()
	if tree == null:
		_keep(order)
	else:
		var own: TreeSketch = sketch_of(tree)
		_known.add(own, order.report, _session)
		var node: TreeInstance3D = get_node_drawn_on()
		if node == null:
			_add(order, tree)
		elif node.reconstruction.edit_log != order.log:
			# The user edited it meanwhile.
			maker.make(order.title, order.sketch, node.reconstruction.edit_log, order.plane)
			return
		else:
			_replace(order, node, tree)
		if not is_same(_base(), own):
			# There was no scene, or the user is asked first.
			_keep(order)
	if not maker.is_busy():
		_show()


# The first of the strokes that make a tree.
func _add(order: Maker.Order, tree: TreeReconstruction) -> void:
	if not _draft.goes_on_from(null):
		_draft.begin(null)
	_draft.end()
	tree.resource_name = tr(options.get_title_of(order.sketch))
	view.place = null if order.plane == null else order.get_place()
	made.emit(tree)


func _replace(order: Maker.Order, node: TreeInstance3D, tree: TreeReconstruction) -> void:
	if _draft.goes_on_from(_base()):
		_draft.end()
	if _session.node != node:
		_session.edit_node(node)
		node_wanted.emit(node)
	var is_same_rule: bool = _base().leaf_rule == order.sketch.leaf_rule
	var other: bool = _base().species != order.sketch.species or not is_same_rule
	var place: Variant = null if order.plane == null else order.get_place_of(node)
	var preset: String = tree.leaf_preset if other else ""
	_session.replace_tree(order.title, tree, preset, tree.leaf_rule, place)
	var left_out: int = (order.replayed.get("left_out", []) as Array).size()
	if left_out != _left_out:
		# Not with every stroke.
		Rerun.say_left_out(_session, order.replayed)
	_left_out = left_out


# What makes no tree stays on the paper.
func _keep(order: Maker.Order) -> void:
	var base: TreeSketch = _base()
	if not _draft.goes_on_from(base):
		_draft.begin(base)
	_draft.push(order.sketch)
	_known.add(order.sketch, order.report, _session, order.sentence)


func _on_understood(order: Maker.Order) -> void:
	_known.add(order.sketch, order.report, _session, order.sentence)
	if is_same(order.sketch, _current):
		_put_on_paper()


# --- the tree follows the pen ---------------------------------------------------------------------


# The latest of it, at most one at a time, and no faster than the tree is built.
func _follow_pen() -> void:
	var node: TreeInstance3D = get_node_drawn_on()
	if not _under_way.is_valid() or not _may_follow or node == null:
		return
	if maker.is_busy() or maker.is_following() or node.is_rebuilding():
		return
	var sketch: TreeSketch = _current.duplicate() as TreeSketch
	_under_way.call(sketch)
	_under_way = Callable()
	maker.follow(sketch, _log(), view.wanted_plane(_current))


func _on_followed(order: Maker.Order, tree: TreeReconstruction) -> void:
	var node: TreeInstance3D = get_node_drawn_on()
	# With another base it would stand elsewhere, which it does once the stroke is finished.
	var is_there: bool = order.plane == null or order.get_place_of(node) == null
	if is_drawing() and _may_follow and node != null and is_there:
		_follow.show(node.reconstruction, tree)


func _on_drawing(points: PackedVector2Array, pressure: PackedFloat32Array) -> void:
	_ask_whether_to_follow()
	var line: PackedVector2Array = points.duplicate()
	_under_way = func(sketch: TreeSketch) -> void: sketch.add_stroke(line, pressure)


func _on_bending(id: int, points: PackedVector2Array) -> void:
	_ask_whether_to_follow()
	_under_way = func(sketch: TreeSketch) -> void: sketch.reshape_stroke(id, points)


# Once for each stroke.
func _ask_whether_to_follow() -> void:
	if not _under_way.is_valid() and not _follow.is_at_work() and not maker.is_following():
		_may_follow = Follow.can_follow(get_node_drawn_on())


func _on_cancelled() -> void:
	_end_following()
	_follow.restore()


func _end_following() -> void:
	_under_way = Callable()
	maker.stop_following()


# --- what the user does ---------------------------------------------------------------------------


func _on_drawn(points: PackedVector2Array, pressure: PackedFloat32Array) -> void:
	var sketch: TreeSketch = _current.duplicate() as TreeSketch
	sketch.add_stroke(points, pressure)
	_on_drawn_in_view(sketch)


func _on_drawn_in_view(sketch: TreeSketch) -> void:
	_end_following()
	_change(tr("Draw Stroke"), sketch)


func _on_chosen_in_view(id: int) -> void:
	canvas.selected = id
	view.selected = id
	_on_chosen(id)


func _on_bent(id: int, points: PackedVector2Array) -> void:
	_end_following()
	var sketch: TreeSketch = _current.duplicate() as TreeSketch
	sketch.reshape_stroke(id, points)
	_change(tr("Reshape Stroke"), sketch)


func _on_erased(ids: PackedInt32Array) -> void:
	var sketch: TreeSketch = _current.duplicate() as TreeSketch
	for id: int in ids:
		sketch.remove_stroke(id)
	_change(tr("Erase Stroke") if ids.size() == 1 else tr("Erase Strokes"), sketch)


func _on_clear() -> void:
	var sketch: TreeSketch = _current.duplicate() as TreeSketch
	var none: Array[Dictionary] = []
	sketch.strokes = none
	_change(tr("Clear Sketch"), sketch)


func _on_told(sketch: TreeSketch, told: PackedStringArray, title: String) -> void:
	canvas.cancel()
	var changed: TreeSketch = _current.duplicate() as TreeSketch
	for property: String in told:
		changed.set(property, sketch.get(property))
	_change(title, changed)


func _on_chosen(id: int) -> void:
	options.show_sketch(_current, id)


func _on_tool(tool: int) -> void:
	canvas.tool = tool as Canvas.Tool
	view.tool = canvas.tool


func _on_role(role: int) -> void:
	var sketch: TreeSketch = _current.duplicate() as TreeSketch
	if sketch.set_stroke_role(canvas.selected, role as TreeSketch.Role):
		_change(tr("Change Stroke Role"), sketch)


func _on_value(title: String, property: StringName, value: Variant, merged: bool) -> void:
	var sketch: TreeSketch = _current.duplicate() as TreeSketch
	sketch.set(property, value)
	if not merged:
		_change(title, sketch)
		return
	view.carry(_current, sketch)
	_current = sketch
	_put_on_paper()
	_due_height = property == &"height"
	_due_title = title
	_due = Time.get_ticks_msec() + _REST_MSEC
