@tool
@icon("../icons/TreePusher3D.svg")
class_name TreePusher3D
extends Node3D
## A sphere that pushes branches and leaves aside: a child of a character or a vehicle.
##
## Twigs and leaves within [member radius] give way, stout branches hold. The four that are nearest
## to the camera take effect. They come softly, and what they bent springs back softly when they go.
## Trees with a [member TreeWind.quality] below [constant TreeWind.BRANCHES], and baked ones without
## [member TreeBaker.global_wind], do not feel them.

const Checked := preload("checked.gd")
const Pushing: GDScript = preload("pushing.gd")

## How far it reaches, in metres.
@export_range(0.0, 10.0, 0.05, "or_greater", "suffix:m") var radius: float = 1.0:
	set(value):
		radius = Checked.number(value, 0.0, 1000.0, radius)

## How much of the radius takes effect.
@export_range(0.0, 1.0, 0.01) var strength: float = 1.0:
	set(value):
		strength = Checked.number(value, 0.0, 1.0, strength)


func _enter_tree() -> void:
	Pushing.add(self)


func _exit_tree() -> void:
	Pushing.remove(self)
