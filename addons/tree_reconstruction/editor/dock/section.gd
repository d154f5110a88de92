@tool
extends FoldableContainer
## A part of the dock that can be folded. While it is folded it costs nothing.

const Session := preload("../session.gd")
const Widgets := preload("widgets.gd")

var session: Session
## Where its controls are.
var body: VBoxContainer = VBoxContainer.new()

var _stale: bool = true


func _init(of: Session) -> void:
	session = of
	add_child(body)
	_build()
	folding_changed.connect(_on_folding_changed)


## A word that names it where it is kept whether it is folded.
func get_id() -> StringName:
	return &""


## What it shows is out of date. It is brought up to date when it is seen.
func invalidate() -> void:
	_stale = true


## Brings what is seen up to date.
func update() -> void:
	if _stale and not folded and is_visible_in_tree():
		_stale = false
		_refresh()


# Makes the controls.
func _build() -> void:
	pass


# Shows what is edited now. There may be nothing.
func _refresh() -> void:
	pass


# Ends what runs, before the dock goes.
func close() -> void:
	pass


func _on_folding_changed(_now: bool) -> void:
	update()


## A line of buttons that go on below where there is no room.
static func buttons(of: Array[Control]) -> HFlowContainer:
	var flow: HFlowContainer = HFlowContainer.new()
	for control: Control in of:
		flow.add_child(control)
	return flow
