@tool
extends RefCounted
## The ways from which an impostor's pictures are taken: the cells of a square that is folded over
## a sphere as an octahedron, or over its upper half. impostor.gdshader does the same.


## Which way the camera of the view in [param column] and [param row] is, from the tree, of
## [param views] in a row.
static func direction(column: int, row: int, views: int, full_sphere: bool) -> Vector3:
	var at: Vector2 = 2.0 * Vector2(column, row) / (views - 1.0) - Vector2.ONE
	if full_sphere:
		var way: Vector3 = Vector3(at.x, 1.0 - absf(at.x) - absf(at.y), at.y)
		if way.y < 0.0:
			way = Vector3(
				(1.0 - absf(at.y)) * (-1.0 if at.x < 0.0 else 1.0),
				way.y,
				(1.0 - absf(at.x)) * (-1.0 if at.y < 0.0 else 1.0)
			)
		return way.normalized()
	var flat: Vector2 = 0.5 * Vector2(at.x + at.y, at.x - at.y)
	return Vector3(flat.x, maxf(1.0 - absf(flat.x) - absf(flat.y), 0.0), flat.y).normalized()


## The axes of the camera there: to the right, up, and towards it.
static func axes(way: Vector3) -> Basis:
	var up: Vector3 = Vector3.FORWARD if absf(way.y) > 0.999 else Vector3.UP
	var right: Vector3 = up.cross(way).normalized()
	return Basis(right, way.cross(right), way)
