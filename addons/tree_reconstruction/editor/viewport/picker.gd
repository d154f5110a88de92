@tool
extends RefCounted
## Finds the nodes of the edited tree on the screen, and places of the screen in the tree's space.
##
## Positions are those of the viewport's events, in the pixels of the control that shows it, also
## where the editor draws it at half the resolution.

const Session: GDScript = preload("../session.gd")
const NO_NODE: int = TreeReconstruction.NO_NODE
## How far off a click may be, in pixels at the editor's scale of 1.
const REACH: float = 8.0
## Within how many pixels of wood a click beside it was meant for it.
const NEAR: float = 20.0
# How far the arrows and rings of the editor's own gizmo reach from the node's origin, and in what
# height of a viewport they begin to shrink.
const _ARROWS: float = 115.0
const _LOW: float = 400.0

## Tells whether the editor shows its own arrows and rings at the node's origin.
var are_arrows_shown: Callable

var _session: Session


func _init(session: Session) -> void:
	_session = session


## The node that is seen at [param position], the nearest one within reach, or NO_NODE.
func pick(camera: Camera3D, position: Vector2) -> int:
	if _session.tree == null or camera == null:
		return NO_NODE
	return _session.tree.pick_node(
		get_to_screen(camera), get_size(camera), position, REACH * get_scale()
	)


## Whether a click at [param position] is beside wood by so little that it was hardly meant for
## what is behind.
func is_near(camera: Camera3D, position: Vector2) -> bool:
	if _session.tree == null or camera == null:
		return false
	var reach: float = NEAR * get_scale()
	var id: int = _session.tree.pick_node(get_to_screen(camera), get_size(camera), position, reach)
	return id != NO_NODE


## Whether a press is for the arrows and rings by which the editor moves and turns the whole node.
func is_on_arrows(camera: Camera3D, position: Vector2) -> bool:
	if are_arrows_shown.is_valid() and not are_arrows_shown.call():
		return false
	var base: Vector2 = project_place(camera, Vector3.ZERO)
	# They shrink in low viewports.
	var low: float = minf(get_size(camera).y / _LOW, 1.0)
	return base.distance_to(position) <= _ARROWS * get_scale() * low


## The nodes that are seen in a rectangle.
func pick_rect(camera: Camera3D, rect: Rect2) -> PackedInt32Array:
	if _session.tree == null or camera == null:
		return PackedInt32Array()
	return _session.tree.pick_nodes(get_to_screen(camera), get_size(camera), rect.abs())


## Where a node is seen. Behind the camera it is [constant Vector2.INF].
func project(camera: Camera3D, id: int) -> Vector2:
	if _session.tree == null or not _session.tree.has_node(id):
		return Vector2.INF
	return project_place(camera, _session.tree.get_node_position(id))


## Where a place of the tree's space is seen. Behind the camera it is [constant Vector2.INF].
func project_place(camera: Camera3D, place: Vector3) -> Vector2:
	var clip: Vector4 = get_to_screen(camera) * Vector4(place.x, place.y, place.z, 1.0)
	if clip.w <= 1e-6:
		return Vector2.INF
	var size: Vector2 = get_size(camera)
	return Vector2(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w) * size


## How many pixels a metre of the tree's space is at a place of it.
func pixels_per_metre(camera: Camera3D, place: Vector3) -> float:
	var clip: Vector4 = get_to_screen(camera) * Vector4(place.x, place.y, place.z, 1.0)
	var scale: float = _session.node.global_basis.get_scale().y
	return (
		absf(camera.get_camera_projection().y.y)
		* scale
		* 0.5
		* get_size(camera).y
		/ maxf(clip.w, 1e-6)
	)


## The place in the tree's space that is seen at [param position], on the plane through the place
## [param through] of the tree's space that faces the camera.
func ray_plane(camera: Camera3D, position: Vector2, through: Vector3) -> Vector3:
	var in_viewport: Vector2 = position * camera.get_viewport().get_visible_rect().size
	in_viewport /= get_size(camera)
	var from: Vector3 = camera.project_ray_origin(in_viewport)
	var way: Vector3 = camera.project_ray_normal(in_viewport)
	var frame: Transform3D = _session.node.global_transform
	var forward: Vector3 = -camera.global_basis.z.normalized()
	var distance: float = (frame * through - from).dot(forward) / way.dot(forward)
	return frame.affine_inverse() * (from + way * distance)


## The line of sight through [param position] in the tree's space: where it begins, and a way along
## it that is one metre of the world.
func get_ray(camera: Camera3D, position: Vector2) -> PackedVector3Array:
	var in_viewport: Vector2 = position * camera.get_viewport().get_visible_rect().size
	in_viewport /= get_size(camera)
	var to_tree: Transform3D = _session.node.global_transform.affine_inverse()
	return [
		to_tree * camera.project_ray_origin(in_viewport),
		to_tree.basis * camera.project_ray_normal(in_viewport),
	]


## What leads from the tree's space to the camera's clip space.
func get_to_screen(camera: Camera3D) -> Projection:
	var to_camera: Transform3D = camera.get_camera_transform().affine_inverse()
	return camera.get_camera_projection() * Projection(to_camera * _session.node.global_transform)


## The size of what shows the camera's picture, in the pixels of its events.
func get_size(camera: Camera3D) -> Vector2:
	var viewport: Viewport = camera.get_viewport()
	var container: SubViewportContainer = viewport.get_parent() as SubViewportContainer
	return container.size if container != null else viewport.get_visible_rect().size


## The camera of the editor's viewport that an overlay lies over, or [code]null[/code].
func get_camera_of(overlay: Control) -> Camera3D:
	for i: int in 4:
		var viewport: SubViewport = EditorInterface.get_editor_viewport_3d(i)
		if overlay.get_parent().is_ancestor_of(viewport):
			return viewport.get_camera_3d()
	return null


## How much larger than usual the editor draws its controls.
static func get_scale() -> float:
	return EditorInterface.get_editor_scale() if Engine.is_editor_hint() else 1.0
