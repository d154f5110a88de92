@tool
extends RefCounted
## Where a sketch's canvas stands in the scene: an upright sheet, seen through a camera.
##
## Positions on the screen are in pixels of whatever shows the camera's picture, whose size is given
## with them; those of the canvas in its pixels, y down.

## How much of a camera's view has to go into the sheet: the cosine of 60 degrees.
const LEAST_FACING: float = 0.5
## The canvas of what is drawn in the view.
const CANVAS: Vector2 = Vector2(1000.0, 1000.0)
# Where on it the drawing belongs, where it may reach, and how much of the place is left for more.
const _ROOM: Rect2 = Rect2(40.0, 60.0, 920.0, 900.0)
const _EDGE: Rect2 = Rect2(10.0, 10.0, 980.0, 980.0)
const _SHARE: float = 0.8
const _LEAST_SHARE: float = 0.4

## In the world: the base is at the origin, X goes to the right along the sheet, Y up, and Z towards
## who sees it.
var frame: Transform3D
## The pixel of the canvas that lies at the origin of [member frame].
var stem_base: Vector2
## How long a pixel of the canvas is, in metres of [member frame].
var pixel: float


func _init(sheet: Transform3D, at: Vector2, metres: float) -> void:
	frame = sheet
	stem_base = at
	pixel = metres


## An upright frame at [param place] that faces a camera: turned about Y alone.
static func facing(camera: Transform3D, place: Vector3) -> Transform3D:
	var back: Vector3 = Vector3(camera.basis.z.x, 0.0, camera.basis.z.z).normalized()
	return Transform3D(Basis(Vector3.UP.cross(back), Vector3.UP, back), place)


## Whether a camera looks down or up too steeply to draw on any upright sheet.
static func is_steep(camera: Transform3D) -> bool:
	var back: Vector3 = camera.basis.z.normalized()
	return Vector2(back.x, back.z).length() < LEAST_FACING


## The same sheet, with the origin at another pixel of the canvas: so far was the base from where it
## was taken for.
func moved_to(at: Vector2) -> RefCounted:
	var off: Vector3 = Vector3((at.x - stem_base.x) * pixel, (stem_base.y - at.y) * pixel, 0.0)
	return _like(frame.translated_local(off), at, pixel)


## Whether the sheet is seen from the side so much that nobody can draw on it. From behind one can.
func is_slanted(camera: Transform3D) -> bool:
	var normal: Vector3 = frame.basis.x.cross(frame.basis.y).normalized()
	return absf(camera.basis.z.normalized().dot(normal)) < LEAST_FACING


## The place in the world of a pixel of the canvas.
func to_world(at: Vector2) -> Vector3:
	return frame * Vector3((at.x - stem_base.x) * pixel, (stem_base.y - at.y) * pixel, 0.0)


## Where a pixel of the canvas is seen. Behind the camera it is [constant Vector2.INF].
func to_screen(camera: Camera3D, size: Vector2, at: Vector2) -> Vector2:
	return _seen(_to_clip(camera), size, at)


## As [method to_screen], of a whole line. What is behind the camera is left out.
func line_to_screen(
	camera: Camera3D, size: Vector2, line: PackedVector2Array
) -> PackedVector2Array:
	var clip: Projection = _to_clip(camera)
	var seen: PackedVector2Array = []
	for at: Vector2 in line:
		var place: Vector2 = _seen(clip, size, at)
		if place.is_finite():
			seen.append(place)
	return seen


## The pixel of the canvas that is seen at [param position]; where the sheet isn't seen there,
## [constant Vector2.INF].
func to_canvas(camera: Camera3D, size: Vector2, position: Vector2) -> Vector2:
	# A place (u, v) of the sheet has the clip coordinates u x + v y + w: two equations, solved in
	# double precision. A ray would not do for a lens whose middle is not the picture's.
	var clip: Projection = _to_clip(camera)
	var a: float = 2.0 * position.x / size.x - 1.0
	var b: float = 1.0 - 2.0 * position.y / size.y
	var m00: float = clip.x.x - a * clip.x.w
	var m01: float = clip.y.x - a * clip.y.w
	var m10: float = clip.x.y - b * clip.x.w
	var m11: float = clip.y.y - b * clip.y.w
	var r0: float = a * clip.w.w - clip.w.x
	var r1: float = b * clip.w.w - clip.w.y
	var det: float = m00 * m11 - m01 * m10
	if absf(det) < 1e-12:
		return Vector2.INF
	var u: float = (r0 * m11 - m01 * r1) / det
	var v: float = (m00 * r1 - r0 * m10) / det
	if u * clip.x.w + v * clip.y.w + clip.w.w <= 1e-6:
		return Vector2.INF
	return Vector2(stem_base.x + u / pixel, stem_base.y - v / pixel)


## How a drawing that takes [param box] of the canvas comes to lie well on it, as a scale and what
## is added then; [constant Transform2D.IDENTITY] where it does already. What is drawn after it
## mostly has room, so that it isn't moved by every stroke.
static func fit(box: Rect2) -> Transform2D:
	var share: float = maxf(box.size.x / _ROOM.size.x, box.size.y / _ROOM.size.y)
	if _EDGE.encloses(box) and share >= _LEAST_SHARE:
		return Transform2D.IDENTITY
	var scale: float = _SHARE / maxf(share, 1e-3)
	var middle: Vector2 = Vector2(box.get_center().x, box.end.y)
	var to: Vector2 = Vector2(_ROOM.get_center().x, _ROOM.end.y)
	return Transform2D(Vector2(scale, 0.0), Vector2(0.0, scale), to - middle * scale)


## The sheet of a canvas whose drawing was moved by what [method fit] returned.
func fitted(by: Transform2D) -> RefCounted:
	return _like(frame, by * stem_base, pixel / by.x.x)


static func _like(sheet: Transform3D, at: Vector2, metres: float) -> RefCounted:
	return new(sheet, at, metres)


func _seen(clip: Projection, size: Vector2, at: Vector2) -> Vector2:
	var u: float = (at.x - stem_base.x) * pixel
	var v: float = (stem_base.y - at.y) * pixel
	var place: Vector4 = clip.x * u + clip.y * v + clip.w
	if place.w <= 1e-6:
		return Vector2.INF
	return Vector2(0.5 + 0.5 * place.x / place.w, 0.5 - 0.5 * place.y / place.w) * size


func _to_clip(camera: Camera3D) -> Projection:
	# From the camera on: no place far from the scene's origin comes into it.
	var to_camera: Transform3D = camera.get_camera_transform().affine_inverse() * frame
	return camera.get_camera_projection() * Projection(to_camera)
