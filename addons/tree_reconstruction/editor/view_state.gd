@tool
extends RefCounted
## What of the edited tree is shown. Kept for each project, never in a scene.

signal changed

enum PointColors { SCAN, HEIGHT, FIDELITY }

const _SECTION: String = "tree_reconstruction"
const _KEY: String = "view"
const _KEPT: PackedStringArray = [
	"editing",
	"points",
	"point_colors",
	"point_size",
	"voxels",
	"skeleton",
	"mesh",
	"leaves",
	"axes",
	"grid"
]

## Whether the viewport's clicks go to the tree's skeleton.
var editing: bool = true:
	set(value):
		editing = value
		changed.emit()
## The scan.
var points: bool = false:
	set(value):
		points = value
		changed.emit()
## By what the scan's points are coloured.
var point_colors: PointColors = PointColors.SCAN:
	set(value):
		point_colors = value
		changed.emit()
## In pixels at the editor's scale of 1.
var point_size: float = 2.0:
	set(value):
		point_size = value
		changed.emit()
## The voxels that hold the scan's points.
var voxels: bool = false:
	set(value):
		voxels = value
		changed.emit()
## The lines and joints that are edited.
var skeleton: bool = true:
	set(value):
		skeleton = value
		changed.emit()
## The bark.
var mesh: bool = true:
	set(value):
		mesh = value
		changed.emit()
## The leaves.
var leaves: bool = true:
	set(value):
		leaves = value
		changed.emit()
## The wind, while the tree is edited.
var wind: bool = false:
	set(value):
		wind = value
		changed.emit()
## Which of the wind's channels the tree is coloured by: a TreeWind.Channel. Not kept.
var channel: int = 0:
	set(value):
		channel = value
		changed.emit()
## The scan's axes at the tree's base.
var axes: bool = false:
	set(value):
		axes = value
		changed.emit()
## Squares of a metre at the tree's base.
var grid: bool = false:
	set(value):
		grid = value
		changed.emit()

## Whether how the bark grew is shown instead of the tree. Not kept.
var growing: bool = false:
	set(value):
		if growing != value:
			growing = value
			changed.emit()

## Whether a sketch is drawn right in the 3D view: its camera, and photos that are compared, stay
## where they are, whatever is selected. Not kept.
var drawing: bool = false:
	set(value):
		drawing = value
		changed.emit()
## What shows the scene from where a photo was taken, while photos are compared (see
## compare/photo_stage.gd); else [code]null[/code]. Not kept.
var stage: Control

var _wanted: WeakRef = weakref(null)


## Shows trees with all that they have.
func show_whole() -> void:
	mesh = true
	leaves = true


## The view goes to a node that was put into a scene, as soon as it is edited.
func want(node: TreeInstance3D) -> void:
	_wanted = weakref(node)


## Whether the view has to go to [param node]. The next question is about another one.
func take_wanted(node: TreeInstance3D) -> bool:
	if node == null or _wanted.get_ref() != node:
		return false
	_wanted = weakref(null)
	return true


## Reads what was shown when the project was open last.
func restore(settings: EditorSettings) -> void:
	var kept: Dictionary = settings.get_project_metadata(_SECTION, _KEY, {})
	for key: String in _KEPT:
		if typeof(kept.get(key)) == typeof(get(key)):
			set(key, kept[key])


## Keeps what is shown for the next time.
func keep(settings: EditorSettings) -> void:
	var kept: Dictionary = {}
	for key: String in _KEPT:
		kept[key] = get(key)
	settings.set_project_metadata(_SECTION, _KEY, kept)
