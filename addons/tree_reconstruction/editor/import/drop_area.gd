@tool
extends Control
## Lies over a 3D viewport of the editor while trees are dragged: shows where they will stand, and
## takes them. At all other times it is hidden and in nobody's way.

const SceneAdder: GDScript = preload("./scene_adder.gd")

const _CIRCLE: int = 48
const _LEAST_RADIUS: float = 0.3

var adder: SceneAdder

var _viewport: SubViewport
var _trees: Array[TreeReconstruction] = []
var _place: Vector3
var _over: bool = false


## An area over the viewport. It is a child of the viewport's container's parent, which is the
## editor's.
static func create(viewport: SubViewport, scene_adder: SceneAdder) -> Control:
	var area: Control = new()
	area.adder = scene_adder
	area._viewport = viewport
	area.name = &"TreeDropArea"
	area.visible = false
	area.set_anchors_preset(Control.PRESET_FULL_RECT)
	return area


func _notification(what: int) -> void:
	match what:
		NOTIFICATION_DRAG_BEGIN:
			_begin(get_viewport().gui_get_drag_data())
		NOTIFICATION_DRAG_END:
			_end()
		NOTIFICATION_MOUSE_EXIT:
			_over = false
			queue_redraw()


## The trees in what is dragged: files, or resources from the inspector.
func trees_of(data: Variant) -> Array[TreeReconstruction]:
	var trees: Array[TreeReconstruction] = []
	if not data is Dictionary:
		return trees
	var dragged: Dictionary = data
	match dragged.get("type", ""):
		"files":
			var files: PackedStringArray = adder.resolved(dragged.get("files", PackedStringArray()))
			# Scenes among them are the engine's to add.
			if SceneAdder.tree_files(files).size() == files.size():
				trees = SceneAdder.load_trees(files)
		"resource":
			if dragged.get("resource") is TreeReconstruction:
				trees.append(dragged["resource"])
	return trees


func _begin(data: Variant) -> void:
	_trees = trees_of(data)
	_over = false
	visible = not _trees.is_empty()


func _end() -> void:
	_trees = []
	_over = false
	visible = false


func _can_drop_data(at_position: Vector2, _data: Variant) -> bool:
	var camera: Camera3D = _viewport.get_camera_3d()
	if _trees.is_empty() or camera == null:
		return false
	_place = SceneAdder.place_under(camera, _to_view(at_position))
	_over = true
	queue_redraw()
	return true


func _drop_data(at_position: Vector2, data: Variant) -> void:
	var camera: Camera3D = _viewport.get_camera_3d()
	var trees: Array[TreeReconstruction] = trees_of(data)
	if camera == null or trees.is_empty():
		return
	adder.add(trees, SceneAdder.place_under(camera, _to_view(at_position)))


# The crown's circle on the ground and the height of each tree.
func _draw() -> void:
	var camera: Camera3D = _viewport.get_camera_3d()
	if not _over or camera == null:
		return
	var offsets: PackedVector3Array = SceneAdder.side_by_side(_trees)
	var color: Color = get_theme_color(&"accent_color", &"Editor")
	var width: float = 2.0 * EditorInterface.get_editor_scale()
	for i: int in _trees.size():
		var box: AABB = _trees[i].get_aabb()
		var base: Vector3 = _place + offsets[i]
		var radius: float = maxf(maxf(box.size.x, box.size.z) * 0.5, _LEAST_RADIUS)
		var middle: Vector3 = base + Vector3(box.get_center().x, 0.0, box.get_center().z)
		var last: Vector3 = middle + Vector3(radius, 0.0, 0.0)
		for k: int in range(1, _CIRCLE + 1):
			var angle: float = TAU * k / _CIRCLE
			var next: Vector3 = middle + Vector3(cos(angle), 0.0, sin(angle)) * radius
			_line(camera, last, next, color, width)
			last = next
		_line(camera, base, base + Vector3(0.0, box.end.y, 0.0), color, width)


func _line(camera: Camera3D, from: Vector3, to: Vector3, color: Color, width: float) -> void:
	if camera.is_position_behind(from) or camera.is_position_behind(to):
		return
	draw_line(
		_to_area(camera.unproject_position(from)),
		_to_area(camera.unproject_position(to)),
		color,
		width,
		true
	)


# The viewport may be drawn at half its size.
func _to_view(point: Vector2) -> Vector2:
	return point * _viewport.get_visible_rect().size / size.max(Vector2.ONE)


func _to_area(point: Vector2) -> Vector2:
	return point * size / _viewport.get_visible_rect().size.max(Vector2.ONE)
