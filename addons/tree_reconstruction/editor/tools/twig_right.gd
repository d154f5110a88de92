@tool
extends "twig.gd"
## Adds a short twig to the right of the view.


func _init() -> void:
	super(false)
