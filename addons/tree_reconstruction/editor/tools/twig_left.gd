@tool
extends "twig.gd"
## Adds a short twig to the left of the view.


func _init() -> void:
	super(true)
