@tool
extends RefCounted
## The ground under a forest, from the triangles of a mesh: how high it is at a place, and how
## steep.

const _TRIANGLES_PER_CELL: float = 2.0
const _MOST_CELLS: float = 250_000.0

## What it covers, seen from above.
var rect: Rect2
## Seen from above, in square metres.
var area: float = 0.0

var _corners: PackedVector3Array
var _size: float = 1.0
var _columns: int = 1
var _cells: Dictionary[int, PackedInt32Array] = {}


## [param corners]: three for each triangle, in the frame of the forest.
func _init(corners: PackedVector3Array) -> void:
	_corners = corners
	@warning_ignore("integer_division")
	var count: int = corners.size() / 3
	if count == 0:
		return
	rect = Rect2(corners[0].x, corners[0].z, 0.0, 0.0)
	for corner: Vector3 in corners:
		rect = rect.expand(Vector2(corner.x, corner.z))
	var cells: float = clampf(count / _TRIANGLES_PER_CELL, 1.0, _MOST_CELLS)
	_size = maxf(sqrt(rect.get_area() / cells), 0.01)
	_columns = int(rect.size.x / _size) + 1
	for i: int in count:
		var a: Vector3 = corners[3 * i]
		var b: Vector3 = corners[3 * i + 1]
		var c: Vector3 = corners[3 * i + 2]
		area += 0.5 * absf((b.x - a.x) * (c.z - a.z) - (c.x - a.x) * (b.z - a.z))
		var low: Vector3 = a.min(b).min(c)
		var high: Vector3 = a.max(b).max(c)
		for row: int in range(_row(low.z), _row(high.z) + 1):
			for column: int in range(_column(low.x), _column(high.x) + 1):
				var cell: int = row * _columns + column
				if not _cells.has(cell):
					_cells[cell] = PackedInt32Array()
				_cells[cell].append(i)


## The highest place of the ground at [param at] (x, z), and its normal; empty where there is none.
func find(at: Vector2) -> PackedVector3Array:
	var found: PackedVector3Array = []
	for i: int in _cells.get(_row(at.y) * _columns + _column(at.x), PackedInt32Array()):
		var a: Vector3 = _corners[3 * i]
		var u: Vector3 = _corners[3 * i + 1] - a
		var v: Vector3 = _corners[3 * i + 2] - a
		var whole: float = u.x * v.z - v.x * u.z
		if whole == 0.0:
			continue
		var x: float = at.x - a.x
		var z: float = at.y - a.z
		var s: float = (x * v.z - v.x * z) / whole
		var t: float = (u.x * z - x * u.z) / whole
		if s < 0.0 or t < 0.0 or s + t > 1.0:
			continue
		var place: Vector3 = Vector3(at.x, a.y + s * u.y + t * v.y, at.y)
		if found.is_empty() or place.y > found[0].y:
			var normal: Vector3 = u.cross(v).normalized()
			found = [place, normal if normal.y > 0.0 else -normal]
	return found


func _row(z: float) -> int:
	return int((z - rect.position.y) / _size)


func _column(x: float) -> int:
	return clampi(int((x - rect.position.x) / _size), 0, _columns - 1)
