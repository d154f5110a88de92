@tool
extends RefCounted
## A camera of the scene as the pinhole that [method TreeReconstructor.sketch_branch] asks for, in a
## tree's space.
##
## An orthogonal camera becomes a pinhole so far behind it that what it sees is the same within a
## pixel. Godot's bases look along -Z, as the pinhole's does.

# So many times the tree's size an orthogonal camera is moved away, as far as the focal length, in
# pixels, stays below what is a camera; nearer than the second one the picture would bend.
const _FAR: float = 1000.0
const _LEAST_FAR: float = 25.0
const _MOST_FOCAL: float = 9e5
# By which share the axes of a node may differ in length, or lean.
const _EVEN: float = 1e-3

## [code]transform[/code], [code]focal[/code], [code]size[/code] and [code]principal[/code]; empty
## where there is none.
var camera: Dictionary = {}
## Why there is none.
var sentence: String = ""

# From the pixels of the view to those of the pinhole's picture.
var _to_picture: Transform2D


## What [param of] sees of a tree whose places are in [param box], in its own space, and which
## stands at [param frame] in the scene. [param size] is that of the view in the pixels of its
## events.
func _init(
	of: Camera3D, size: Vector2, frame: Transform3D, box: AABB, domain: StringName = &""
) -> void:
	set_translation_domain(domain)
	var pose: Transform3D = frame.affine_inverse() * of.get_camera_transform()
	if not _is_even(pose.basis):
		sentence = tr(
			"The node is scaled unevenly: a branch can be drawn only where all its axes are scaled alike."
		)
		return
	# Metres of the tree to one of the scene.
	var scale: float = pose.basis.x.length()
	var lens: Projection = of.get_camera_projection()
	# Pixels to the tangent of the angle, or to a metre, to the right and up.
	var across: float = lens.x.x * 0.5 * size.x
	var up: float = lens.y.y * 0.5 * size.y
	var principal: Vector2
	if of.projection == Camera3D.PROJECTION_ORTHOGONAL:
		principal = Vector2(0.5 + 0.5 * lens.w.x, 0.5 - 0.5 * lens.w.y) * size
	else:
		principal = Vector2(0.5 - 0.5 * lens.z.x, 0.5 + 0.5 * lens.z.y) * size
	# Its pixels are square, and its right is not its left.
	var mirrored: bool = pose.basis.determinant() < 0.0
	_to_picture = Transform2D.IDENTITY.scaled(
		Vector2((-1.0 if mirrored else 1.0) * up / across, 1.0)
	)
	if mirrored:
		_to_picture.origin.x = size.x * up / across
	pose.basis = pose.basis.orthonormalized()
	if mirrored:
		pose.basis.x = -pose.basis.x
	var focal: float = up
	if of.projection == Camera3D.PROJECTION_ORTHOGONAL:
		var pixels: float = up / scale
		var across_tree: float = maxf(box.size.length(), 1e-3)
		var away: float = minf(_FAR * across_tree, _MOST_FOCAL / pixels)
		if away < _LEAST_FAR * across_tree:
			sentence = tr(
				(
					"This orthogonal view is too near to draw a branch in it: go farther away, or look with"
					+ " perspective."
				)
			)
			return
		var middle: float = (box.get_center() - pose.origin).dot(pose.basis.z)
		pose.origin += pose.basis.z * (middle + away)
		focal = pixels * away
	camera = {
		"transform": pose,
		"focal": focal,
		"size": Vector2i((Vector2(size.x * up / across, size.y)).ceil()),
		"principal": _to_picture * principal,
	}


## Positions of the view as pixels of the pinhole's picture.
func to_picture(positions: PackedVector2Array) -> PackedVector2Array:
	return _to_picture * positions


static func _is_even(basis: Basis) -> bool:
	var length: float = basis.x.length()
	if not is_finite(length) or length < 1e-9:
		return false
	var off: float = maxf(absf(basis.y.length() - length), absf(basis.z.length() - length))
	var lean: float = maxf(
		absf(basis.x.dot(basis.y)), maxf(absf(basis.y.dot(basis.z)), absf(basis.z.dot(basis.x)))
	)
	return off < _EVEN * length and lean < _EVEN * length * length
