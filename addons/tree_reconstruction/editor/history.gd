@tool
extends RefCounted
## The undo history that every change goes through: the editor's own, or a plain [UndoRedo] in
## tests.
##
## [codeblock]
## history.begin("Prune", node)
## history.add_method(tree, &"apply_edit", [edit], &"revert_edit", [edit])
## history.commit(false)     # it is done already
## [/codeblock]
## Actions name resources and nodes of the user's alone, nothing of the plugin: so they outlive it
## being switched off, and its scripts being loaded again.

## What a reconstruction makes of a tree; all else is how it looks.
const MADE: Array[StringName] = [
	&"skeleton",
	&"foliage",
	&"provenance",
	&"edit_log",
	&"growth_recipe",
	&"growth_meshes",
	&"growth_pending",
	&"grown_bark",
]

# EditorUndoRedoManager or UndoRedo.
var _undo: Object
# The version of each history, by its id, when it was looked at last.
var _seen: Dictionary[int, int] = {}
# What the step before may merge with, and the history's version after it.
var _merged: Array = []
var _version: int = -1
var _context: WeakRef


func _init(undo: Object) -> void:
	_undo = undo


## Begins a step that the user will see as [param title]. It goes into the history of the scene
## that [param context] is in, or, for a resource with a file, that of all scenes. Steps with the
## same [param merged], such as an object and its property, that follow each other quickly become
## one, so that a slider that is dragged is one
## step.
func begin(title: String, context: Object, merged: Array = []) -> void:
	# The engine would merge by the title alone.
	var same: bool = (
		not merged.is_empty() and merged == _merged and _get_version(context) == _version
	)
	var mode: int = UndoRedo.MERGE_ENDS if same else UndoRedo.MERGE_DISABLE
	_merged = merged
	_context = weakref(context)
	# What is undone is undone in the opposite order.
	if _undo is UndoRedo:
		(_undo as UndoRedo).create_action(title, mode, true)
	else:
		# Whether resources are saved is known without the history, which would ask for those that
		# nobody holds any more.
		_undo.call(&"create_action", title, mode, context, true, context is Node)


## Adds a call that does, and one that undoes. The arguments are kept alive.
func add_method(
	object: Object, do_name: StringName, do_with: Array, undo_name: StringName, undo_with: Array
) -> void:
	if _undo is UndoRedo:
		var plain: UndoRedo = _undo as UndoRedo
		plain.add_do_method(Callable(object, do_name).bindv(do_with))
		plain.add_undo_method(Callable(object, undo_name).bindv(undo_with))
		if object is RefCounted:
			plain.add_do_reference(object)
			plain.add_undo_reference(object)
	else:
		_undo.callv(&"add_do_method", [object, do_name] + do_with)
		_undo.callv(&"add_undo_method", [object, undo_name] + undo_with)


## Adds a property's new and old value.
func add_property(object: Object, property: StringName, value: Variant, old: Variant) -> void:
	_undo.call(&"add_do_property", object, property, value)
	_undo.call(&"add_undo_property", object, property, old)


## Adds all of an object's [param values] and [param old] values, by their names. Both are set in
## the order of [param values], since what is set first may set others with it, as a preset does.
func add_properties(object: Object, values: Dictionary, old: Dictionary) -> void:
	var names: Array = values.keys()
	for name: StringName in names:
		_undo.call(&"add_do_property", object, name, values[name])
	names.reverse()
	for name: StringName in names:
		_undo.call(&"add_undo_property", object, name, old[name])


## Keeps [param node], which the step adds to the scene, alive while the step can be undone or
## done.
func keep_added(node: Node) -> void:
	_undo.call(&"add_do_reference", node)


## Ends the step. Without [param execute] what it does is done already.
func commit(execute: bool = true) -> void:
	_undo.call(&"commit_action", execute)
	var plain: UndoRedo = _get_plain(_context.get_ref() as Object)
	_version = plain.get_version()
	_seen[plain.get_instance_id()] = _version


## To be called once a frame, with all whose histories steps may be in: returns the title of the
## step that was undone since the last call (with a minus before it) or done again (with a plus), or
## nothing.
func look(contexts: Array[Object]) -> String:
	var found: String = ""
	for context: Object in contexts:
		var plain: UndoRedo = _get_plain(context)
		var id: int = plain.get_instance_id()
		var now: int = plain.get_version()
		var before: int = _seen.get(id, now)
		_seen[id] = now
		var at: int = plain.get_current_action()
		if now < before and plain.has_redo():
			found = "-" + plain.get_action_name(at + 1)
		elif now > before and at >= 0:
			found = "+" + plain.get_action_name(at)
	return found


## Whether something that was undone can be done again in the history that [param context] is in.
func can_redo(context: Object) -> bool:
	return _get_plain(context).has_redo()


func _get_version(context: Object) -> int:
	return _get_plain(context).get_version()


func _get_plain(context: Object) -> UndoRedo:
	var plain: UndoRedo = _undo as UndoRedo
	if plain == null:
		var id: int = _undo.call(&"get_object_history_id", context)
		plain = _undo.call(&"get_history_undo_redo", id)
	return plain


## By name, what is saved of [param object] but what was made of it at large, as a skeleton.
static func stored_values(object: Object) -> Dictionary:
	var values: Dictionary = {}
	for property: Dictionary in object.get_property_list():
		var name: StringName = property.name
		# What is large is not set by a property of the leaves.
		if property.usage & PROPERTY_USAGE_STORAGE and name not in MADE and name != &"script":
			values[name] = object.get(name)
	return values
