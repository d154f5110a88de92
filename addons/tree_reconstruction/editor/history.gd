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

# EditorUndoRedoManager or UndoRedo.
var _undo: Object


func _init(undo: Object) -> void:
	_undo = undo


## Begins a step that the user will see as [param title]. It goes into the history of the scene
## that [param context] is in. With [param merged], steps of the same title that follow each other
## quickly become one, so that a slider that is dragged is one step.
func begin(title: String, context: Node, merged: bool = false) -> void:
	var mode: int = UndoRedo.MERGE_ENDS if merged else UndoRedo.MERGE_DISABLE
	# What is undone is undone in the opposite order.
	if _undo is UndoRedo:
		(_undo as UndoRedo).create_action(title, mode, true)
	else:
		_undo.call(&"create_action", title, mode, context, true)


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


## Keeps [param node], which the step adds to the scene, alive while the step can be undone or
## done.
func keep_added(node: Node) -> void:
	_undo.call(&"add_do_reference", node)


## Ends the step. Without [param execute] what it does is done already.
func commit(execute: bool = true) -> void:
	_undo.call(&"commit_action", execute)
