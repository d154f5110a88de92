@tool
extends RefCounted
## What a tool of the viewport is: it turns the mouse and keys into edits of the session's tree.

## The overlay or the ghosts want to be drawn again.
signal changed

const Session := preload("../session.gd")

## Where the tree and its selection are, and where every edit goes through.
var session: Session


## A word that names it in settings.
func get_id() -> StringName:
	return &""


## What the user reads.
func get_title() -> String:
	return ""


## What it does and how the mouse does it, in whole sentences.
func get_tooltip() -> String:
	return ""


## The name of one of the editor's icons, or the path of a picture.
func get_icon() -> String:
	return "Node3D"


## The key that chooses it unless the user sets another one.
func get_key() -> Key:
	return KEY_NONE


## It was chosen.
func start() -> void:
	pass


## Another one was chosen, or another tree. Nothing half done may stay.
func stop() -> void:
	pass


## Takes a mouse or key event of the viewport. Returns whether it was meant for this tool; a click
## on nothing is the editor's.
func input(_camera: Camera3D, _event: InputEvent) -> bool:
	return false


## Whether it is told of the node under the mouse, which is marked then.
func picks_nodes() -> bool:
	return true


## Controls for below the viewport, or [code]null[/code]. The caller frees them.
func make_settings() -> Control:
	return null


## Whether the mouse is for it over a photo, too, while the tree is compared with its photos. Then
## it has a [code]draw_strokes(on: CanvasItem)[/code].
func draws_over_photos() -> bool:
	return false


## Draws over the viewport.
func draw(_overlay: Control) -> void:
	pass


## Where the last [method draw] has written; empty if nowhere.
func get_sentence_box() -> Rect2:
	return Rect2()


## Surface arrays of lines in the tree's space, to be drawn translucently over it: what a click
## would do.
func get_ghosts() -> Array:
	return []
