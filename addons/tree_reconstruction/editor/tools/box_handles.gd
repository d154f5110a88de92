@tool
extends RefCounted
## Handles in the middle of a box's faces, by which the mouse drags them.

const SeeingTool := preload("seeing_tool.gd")

const NO_FACE: int = -1
const _COLOR: Color = Color(1.0, 0.95, 0.4)
const _RADIUS: float = 7.0
const _REACH: float = 12.0
# Thinner the box doesn't become, in metres.
const _THINNEST: float = 0.01
# Faces that are seen this steeply or more can't be dragged: the view looks along their way. It is
# the length of that way on the screen over its length seen from the side.
const _STEEPEST: float = 0.2

## The box, in the tree's space.
var box: AABB
## The face that is dragged and the one under the mouse, or NO_FACE. Faces 0 and 1 are the low and
## the high one of x, and so on.
var dragged: int = NO_FACE
var hovered: int = NO_FACE

var _before: AABB
# How far along the axis the mouse was beside the face that it took.
var _off: float


## Whether there is a box to drag.
func has_box() -> bool:
	return box.has_volume()


## Where the handle of a face is, in the tree's space.
func get_place(face: int) -> Vector3:
	var place: Vector3 = box.get_center()
	place[_axis_of(face)] = box.end[_axis_of(face)] if face & 1 else box.position[_axis_of(face)]
	return place


## Where the handle is seen; infinity where it can't be used.
func get_seen(of: SeeingTool, face: int) -> Vector2:
	var seen: Vector2 = of.seen_at(get_place(face))
	var ahead: Vector2 = of.seen_at(get_place(face) + _way_of(face) * 0.01)
	if not seen.is_finite() or not ahead.is_finite():
		return Vector2.INF
	var steep: float = seen.distance_to(ahead) / (0.01 * of.pixels_per_metre(get_place(face)))
	return seen if steep > _STEEPEST else Vector2.INF


## The face whose handle is at a position of the viewport, or NO_FACE.
func find(of: SeeingTool, position: Vector2) -> int:
	var nearest: int = NO_FACE
	var distance: float = _REACH * of.get_scale()
	if not has_box():
		return nearest
	for face: int in 6:
		var away: float = get_seen(of, face).distance_to(position)
		if away < distance:
			distance = away
			nearest = face
	return nearest


## Takes the face at a position. Returns whether there is one.
func take(of: SeeingTool, position: Vector2) -> bool:
	dragged = find(of, position)
	if dragged == NO_FACE:
		return false
	_before = box
	_off = _along(of, position) - get_place(dragged)[_axis_of(dragged)]
	return true


## Moves the face that is dragged to the mouse; the others stay.
func drag(of: SeeingTool, position: Vector2) -> void:
	var axis: int = _axis_of(dragged)
	var to: float = _along(of, position) - _off
	if not is_finite(to):
		return
	var low: float = box.position[axis]
	var high: float = box.end[axis]
	if dragged & 1:
		high = maxf(to, low + _THINNEST)
	else:
		low = minf(to, high - _THINNEST)
	box.position[axis] = low
	box.size[axis] = high - low


## Ends the drag; [param keep] says whether the face stays where it is.
func let_go(keep: bool) -> void:
	if not keep and dragged != NO_FACE:
		box = _before
	dragged = NO_FACE


func draw(of: SeeingTool, overlay: Control) -> void:
	if not has_box():
		return
	var scale: float = of.get_scale()
	for face: int in 6:
		var at: Vector2 = get_seen(of, face)
		if not at.is_finite():
			continue
		var held: bool = face == dragged or (dragged == NO_FACE and face == hovered)
		var radius: float = (_RADIUS + (2.0 if held else 0.0)) * scale
		overlay.draw_circle(at, radius + scale, Color(0, 0, 0, 0.7))
		overlay.draw_circle(at, radius, _COLOR if held else SeeingTool.GONE)
		overlay.draw_circle(at, radius * 0.4, Color(0, 0, 0, 0.7))


# Where on the axis of the dragged face the mouse is: the place of the axis' line through the handle
# that is nearest to the line of sight.
func _along(of: SeeingTool, position: Vector2) -> float:
	var place: Vector3 = get_place(dragged)
	var way: Vector3 = _way_of(dragged)
	var sight_from: Vector3 = of.place_at(position, place)
	var sight: Vector3 = of.place_at(position, place + of.view_direction(Vector3.FORWARD))
	sight = (sight - sight_from).normalized()
	var apart: Vector3 = place - sight_from
	var cosine: float = way.dot(sight)
	var square: float = 1.0 - cosine * cosine
	if square < 1e-6:
		return NAN
	var along: float = (cosine * sight.dot(apart) - way.dot(apart)) / square
	return place[_axis_of(dragged)] + along


static func _axis_of(face: int) -> int:
	return face >> 1


static func _way_of(face: int) -> Vector3:
	var way: Vector3 = Vector3.ZERO
	way[face >> 1] = 1.0
	return way
