@tool
extends "node_selection.gd"
## What is being edited: a tree, what is selected of it, and the tool at hand. Every change of a
## tree goes through here, as one step of the undo history.
##
## One per plugin. [method update] is called once a frame; tests make one with a plain [UndoRedo].

## Another node is edited, or none.
signal node_changed
## The wood, the rules, or the resource of the edited tree changed, for whatever reason; at most
## once a frame.
signal tree_changed
signal tool_changed
signal view_changed
## The scan's points came or went.
signal scan_changed
## The Pick tool took a branch, as an L-string that begins at a node.
signal string_picked(lstring: String, id: int)
## The viewport should show what is in [param box], in the tree's space.
signal view_wanted(box: AABB)
## The scan should be reconstructed again, with these options changed.
signal reconstruction_wanted(changed: Dictionary)
## The user wants a tree of photos.
signal photos_wanted
## The user wants to draw a tree, or to draw on at the edited one.
signal sketch_wanted
## A sentence for the user.
signal said(sentence: String, kind: Kind)

enum Kind { INFO, WARNING, ERROR }

const History := preload("history.gd")
const Jobs := preload("jobs.gd")
const LocalTrees := preload("local_trees.gd")
const PhotoJudge := preload("photo_judge.gd")
const ScanData := preload("scan_data.gd")
const Sentences := preload("translations/sentences.gd")
const UndoStatus := preload("undo_status.gd")
const ViewState := preload("view_state.gd")
const Consent := preload("sharing/consent.gd")
# So many branches that were picked are remembered.
const _MOST_PICKED: int = 4

## The edited node, or [code]null[/code].
var node: TreeInstance3D
var history: History
var jobs: Jobs = Jobs.new()
var view: ViewState = ViewState.new()
var local_trees: LocalTrees = LocalTrees.new()
var scan: ScanData
var photos: PhotoJudge
## The tools by their ids (see [code]tools/tool.gd[/code]), and the chosen one.
var tools: Dictionary[StringName, RefCounted] = {}
var tool: RefCounted
## What finds nodes on the screen. The viewport's part sets it.
var picker: RefCounted
## What a graft puts on: an L-string, or the name of a twig of the library as
## [code]twig=oak[/code].
var scion: String = ""
## The L-strings that the Pick tool took last, the latest first.
var picked: PackedStringArray = []
## What the user wants where other nodes show the edited tree, too.
var consent: Consent
## What bark is to grow (see [code]bark/bark_work.gd[/code]), once something asked for it.
var bark: RefCounted

var _undo_status: UndoStatus = UndoStatus.new()
var _shown: TreeReconstruction
var _tree_moved: bool = false
# The drag under way.
var _drag: Drag


# What a drag did so far.
class Drag:
	extends RefCounted
	var title: String
	var tree: TreeReconstruction
	var imported: TreeReconstruction
	var edit: TreeEdit


func _init(undo: Object) -> void:
	history = History.new(undo)
	# Methods, since functions made here would keep this session alive.
	scan = ScanData.new(jobs, _warn)
	photos = PhotoJudge.new(jobs, scan)
	consent = Consent.new(local_trees, _warn)
	scan.changed.connect(_on_scan_changed)
	view.changed.connect(_on_view_changed)


# --- what is edited -------------------------------------------------------------------------------


## Edits another node, or none.
func edit_node(other: TreeInstance3D) -> void:
	if other == node:
		return
	cancel_drag()
	if tool != null:
		tool.call(&"stop")
	node = other
	_watch(tree)
	selection = []
	hovered = NO_NODE
	if tool != null and node != null:
		tool.call(&"start")
	node_changed.emit()
	selection_changed.emit()


## To be called once a frame.
func update() -> void:
	if node != null and (not is_instance_valid(node) or node.is_queued_for_deletion()):
		node = null
		_drag = null
		edit_node(null)
		_watch(null)
		selection = []
		node_changed.emit()
		selection_changed.emit()
	if tree != _shown:
		_watch(tree)
	_undo_status.update(self, _tree_moved)
	if _tree_moved:
		_tree_moved = false
		_drop_missing()
		scan.set_tree(tree)
		photos.set_tree(tree)
		photos.note_edit()
		scan.note_edit()
		tree_changed.emit()
	jobs.update()
	scan.update()
	if node != null:
		photos.leaves = node.leaves
	photos.update()


## Grafts go on with a branch that was picked, which is remembered among the latest.
func take_scion(lstring: String) -> void:
	scion = lstring
	var others: PackedStringArray = picked
	picked = [lstring]
	for other: String in others:
		if other != lstring and picked.size() < _MOST_PICKED:
			picked.append(other)


## Ends everything, before the plugin goes.
func shut_down() -> void:
	edit_node(null)
	if bark != null:
		bark.call(&"close")
		bark = null
	jobs.shut_down()


## Chooses a tool, or none with an empty id.
func choose(id: StringName) -> void:
	var other: RefCounted = tools.get(id)
	if other == tool:
		return
	cancel_drag()
	if tool != null:
		tool.call(&"stop")
	tool = other
	if tool != null and node != null:
		tool.call(&"start")
	tool_changed.emit()


## Tells the user something; what the library says, in the editor's language.
func say(sentence: String, kind: Kind = Kind.INFO) -> void:
	if not sentence.is_empty():
		said.emit(Sentences.translate(sentence, get_translation_domain()), kind)


func _warn(sentence: String) -> void:
	say(sentence, Kind.WARNING)


func _on_scan_changed() -> void:
	scan_changed.emit()


func _on_view_changed() -> void:
	view_changed.emit()


func _watch(other: TreeReconstruction) -> void:
	if other == _shown:
		return
	if _shown != null:
		_shown.changed.disconnect(_on_tree_changed)
	_shown = other
	if _shown != null:
		_shown.changed.connect(_on_tree_changed)
		if is_instance_valid(node) and not LocalTrees.is_foreign(_shown, node):
			local_trees.watch(_shown)
	scan.set_tree(_shown)
	photos.set_tree(_shown)
	_tree_moved = true


func _on_tree_changed() -> void:
	_tree_moved = true


# --- edits ----------------------------------------------------------------------------------------


## Does an edit command (docs/editing.md) as one step of the history. Where it is refused, the
## user gets its sentence and the result is [code]null[/code].
func run(title: String, command: String) -> TreeEdit:
	if tree == null:
		return null
	if LocalTrees.is_foreign(tree, node):
		# No copy is made for nothing.
		var sentence: String = tree.check_edit(command)
		if not sentence.is_empty():
			say(sentence, Kind.ERROR)
			return null
	return run_edit(title, _try.bind(command))


## As [method run], for whatever returns a [TreeEdit]: [param make] is called with the tree to
## change.
func run_edit(title: String, make: Callable) -> TreeEdit:
	if tree == null:
		return null
	cancel_drag()
	var imported: TreeReconstruction = tree
	var edited: TreeReconstruction = _editable(run_edit.bind(title, make))
	if edited == null:
		return null
	var edit: TreeEdit = make.call(edited)
	if edit == null or edit.is_empty():
		if edit != null:
			say(edit.get_message())
		_take_back(edited, imported)
		return edit
	_record(title, edited, imported, edit)
	say(edit.get_message())
	return edit


## Begins a change that follows the mouse: the history gets one step for it at [method end_drag].
func begin_drag(title: String) -> void:
	cancel_drag()
	_drag = Drag.new()
	_drag.title = title


## Whether a drag is under way.
func is_dragging() -> bool:
	return _drag != null


## Does [param command] in the place of what the drag did before. Where it is refused, the tree is
## as it was before the drag.
func drag(command: String) -> bool:
	if _drag == null or tree == null:
		return false
	if _drag.tree == null:
		_drag.imported = tree
		_drag.tree = _editable(Callable())
		if _drag == null or _drag.tree == null:
			_drag = null
			return false
	if _drag.edit != null:
		_drag.tree.revert_edit(_drag.edit)
		_drag.edit = null
	var done: Variant = _drag.tree.try_edit(command)
	if done is TreeEdit:
		_drag.edit = done
	return _drag.edit != null


## Ends the drag. Returns what it did, or [code]null[/code].
func end_drag() -> TreeEdit:
	var done: Drag = _drag
	_drag = null
	if done == null or done.tree == null:
		return null
	if done.edit == null or done.edit.is_empty():
		_take_back(done.tree, done.imported)
		return null
	_record(done.title, done.tree, done.imported, done.edit)
	say(done.edit.get_message())
	return done.edit


## Ends the drag; the tree is as before.
func cancel_drag() -> void:
	var done: Drag = _drag
	_drag = null
	if done == null or done.tree == null:
		return
	if done.edit != null:
		done.tree.revert_edit(done.edit)
	_take_back(done.tree, done.imported)


## Sets a property of the edited tree, of its leaf rule, or of the node. With [param merged],
## changes that follow each other quickly become one step, as those of a slider.
func set_value(
	title: String, object: Object, property: StringName, value: Variant, merged: bool = false
) -> void:
	if tree == null or object.get(property) == value:
		return
	cancel_drag()
	if object == node:
		history.begin(title, node, [node.get_instance_id(), property] if merged else [])
		history.add_property(node, property, value, node.get(property))
		history.commit()
		return
	var imported: TreeReconstruction = tree
	var edited: TreeReconstruction = _editable(
		_set_value_again.bind(title, object is LeafRule, property, value)
	)
	if edited == null:
		return
	var rule: LeafRule = edited.leaf_rule
	var of_rule: bool = object is LeafRule
	var own: LeafRule = rule
	if (
		of_rule
		and (rule.resource_path.begins_with("res://") and not rule.resource_path.contains("::"))
	):
		# A rule in a file may be that of other trees too.
		own = rule.duplicate() as LeafRule
		edited.leaf_rule = own
	var target: Object = own if of_rule else edited
	# A property may set others with it, as a preset does: so all are set again.
	var before: Dictionary = History.stored_values(target)
	target.set(property, value)
	var after: Dictionary = History.stored_values(target)
	begin_step(title, edited, imported, [target.get_instance_id(), property] if merged else [])
	_add_local(edited, imported)
	if merged and edited == imported:
		# The last of the steps that become one does all that it does again.
		history.add_property(node, &"reconstruction", edited, edited)
	if own != rule or (merged and of_rule):
		history.add_property(edited, &"leaf_rule", own, rule)
	history.add_properties(target, after, before)
	history.commit(false)


## Gives the edited tree the wood, leaves and log of [param made], as what a reconstruction with
## other options made. It stays the same resource, for all nodes that show it; its leaf rules stay,
## unless [param preset] names other leaves, with [param rule] as their rule, if any. The node gets
## [param place] as its transform, if it is one.
func replace_tree(
	title: String,
	made: TreeReconstruction,
	preset: String = "",
	rule: LeafRule = null,
	place: Variant = null
) -> void:
	if tree == null or made == null or made == tree:
		return
	cancel_drag()
	var imported: TreeReconstruction = tree
	var redo: Callable = replace_tree.bind(title, made, preset, rule, place)
	var edited: TreeReconstruction = _editable(redo)
	if edited == null:
		return
	begin_step(title, edited, imported)
	_add_local(edited, imported)
	add_replacement(edited, made)
	if not preset.is_empty():
		var before: Dictionary = History.stored_values(edited)
		edited.leaf_rule = rule
		edited.leaf_preset = preset
		history.add_properties(edited, History.stored_values(edited), before)
	if place is Transform3D:
		history.add_property(node, &"transform", place, node.transform)
	history.commit()


## Gives the edited tree the bark and the recipe of [param made]; with [code]null[/code], tubes.
## Steps with the same [param merged] that follow each other quickly become one.
func set_bark(title: String, made: TreeReconstruction, merged: Array = []) -> void:
	if tree == null:
		return
	cancel_drag()
	var imported: TreeReconstruction = tree
	var edited: TreeReconstruction = _editable(set_bark.bind(title, made, merged))
	if edited == null:
		return
	var before: TreeReconstruction = TreeReconstruction.new()
	before.take_bark_of(edited)
	var after: TreeReconstruction = made if made != null else TreeReconstruction.new()
	begin_step(title, edited, imported, merged)
	_add_local(edited, imported)
	history.add_method(edited, &"take_bark_of", [after], &"take_bark_of", [before])
	history.commit()


## Adds to the step that was begun that [param replaced] takes the wood, leaves and log of
## [param made]. Undone, it is bit for bit what it was, so that earlier steps can be undone, too.
func add_replacement(replaced: TreeReconstruction, made: TreeReconstruction) -> void:
	var before: TreeReconstruction = TreeReconstruction.new()
	before.take_tree_of(replaced)
	var after: TreeReconstruction = TreeReconstruction.new()
	after.take_tree_of(made)
	history.add_method(replaced, &"take_tree_of", [after], &"take_tree_of", [before])


## Gives the edited node a tree of its own, which no other node shows.
func make_unique() -> void:
	if tree == null:
		return
	cancel_drag()
	var shared: TreeReconstruction = tree
	var own: TreeReconstruction = (
		local_trees.make_local(shared, node)
		if LocalTrees.has_file(shared)
		else LocalTrees.copy_of(shared)
	)
	history.begin(tr("Make Unique"), node)
	history.add_property(node, &"reconstruction", own, shared)
	history.commit()
	_watch(own)
	if LocalTrees.has_file(own):
		say(tr("'%s' has a tree of its own now: %s.") % [node.name, own.resource_path])


## Begins a step that changes a tree, [param edited], a copy of [param imported] or the same. Where
## other scenes show it, too, its steps are no scene's, but undone in whichever is shown.
func begin_step(
	title: String, edited: TreeReconstruction, imported: TreeReconstruction, merged: Array = []
) -> void:
	var context: Object = node
	if edited == imported and local_trees.is_in_other_scenes(edited, node):
		context = edited
		local_trees.note_outliving(edited)
	history.begin(title, context, merged)


# The tree to change: the edited one, or a copy of it with a file of its own. Null: the user is
# asked first, and `again` is called then.
func _editable(again: Callable) -> TreeReconstruction:
	var shown: TreeReconstruction = tree
	if not LocalTrees.is_foreign(shown, node):
		return shown if consent.is_settled(shown, node, again) else null
	node.reconstruction = local_trees.make_local(shown, node)
	return node.reconstruction


# The tree, and its rule, may be other ones now.
func _set_value_again(title: String, of_rule: bool, property: StringName, value: Variant) -> void:
	set_value(title, tree.leaf_rule if of_rule else tree, property, value)


func _try(edited: TreeReconstruction, command: String) -> TreeEdit:
	var done: Variant = edited.try_edit(command)
	if done is TreeEdit:
		return done
	say(done as String, Kind.ERROR)
	return null


# Nothing came of an edit that had needed a copy.
func _take_back(edited: TreeReconstruction, imported: TreeReconstruction) -> void:
	if edited == imported:
		return
	node.reconstruction = imported
	local_trees.drop_new(edited)


func _record(
	title: String, edited: TreeReconstruction, imported: TreeReconstruction, edit: TreeEdit
) -> void:
	begin_step(title, edited, imported)
	_add_local(edited, imported)
	history.add_method(edited, &"apply_edit", [edit], &"revert_edit", [edit])
	history.commit(false)


func _add_local(edited: TreeReconstruction, imported: TreeReconstruction) -> void:
	if edited == imported:
		return
	history.add_property(node, &"reconstruction", edited, imported)
	say(
		(
			tr(
				"The edited tree is a copy of its own now, %s: importing the scan again keeps your work."
			)
			% edited.resource_path
		),
		Kind.WARNING
	)


func _get_tree() -> TreeReconstruction:
	return node.reconstruction if is_instance_valid(node) else null
