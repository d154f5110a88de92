extends SceneTree
## Ten views of a tree as a vegetation artist would look at it, which ./dev bench --pictures draws:
## always the same, in the same light, so that pictures of two days can be laid side by side.
## Arguments after '--': a scan, a folder for the pictures, a leaf preset ("" for the tree's own),
## and names of views, or none for all.

const Daylight: PackedScene = preload("res://addons/tree_reconstruction/presets/daylight.tscn")
const Ground := preload("res://scenes/meadow.gd")
const SIZE: Vector2i = Vector2i(1000, 1000)
const FIELD: float = 45.0
const EYE: float = 1.6
const BREAST: float = 1.3
const VIEWS: PackedStringArray = [
	"eye", "trunk", "foot", "fork", "below", "sprig", "40m", "150m", "winter", "backlit"
]
# Where the sun stands, degrees, and from which side all is seen: it comes over the shoulder.
const SUN: Vector3 = Vector3(-42.0, -38.0, 0.0)
const SIDE: Vector3 = Vector3(0.26, 0.0, 0.97)

var _tree: TreeReconstruction
var _instance: TreeInstance3D
var _viewport: SubViewport
var _camera: Camera3D
var _sun: DirectionalLight3D
var _box: AABB
var _height: float


func _init() -> void:
	_run.call_deferred()


func _run() -> void:
	quit(0 if await _draw_all() else 1)


func _draw_all() -> bool:
	var given: PackedStringArray = OS.get_cmdline_user_args()
	var maker: TreeReconstructor = TreeReconstructor.new()
	_tree = maker.reconstruct_file(given[0], {})
	if _tree == null:
		printerr(maker.get_error_message())
		return false
	if given.size() > 2 and not given[2].is_empty():
		if not TreeReconstruction.get_leaf_preset_names().has(given[2]):
			printerr("There are no leaves '%s'." % given[2])
			return false
		_tree.leaf_preset = given[2]
	if DirAccess.make_dir_recursive_absolute(given[1]) != OK:
		printerr("The folder %s could not be made." % given[1])
		return false
	await _stage()
	for view: String in VIEWS if given.size() < 4 else given.slice(3):
		if not VIEWS.has(view):
			printerr("There is no view '%s'; there are: %s." % [view, ", ".join(VIEWS)])
			return false
		await _set_up(view)
		var picture: Image = await _picture()
		if picture.save_jpg(given[1].path_join(view + ".jpg"), 0.92) != OK:
			printerr("The picture of %s could not be written." % view)
			return false
		print("> %s: %d triangles" % [view, _instance.get_triangle_count()])
	return true


func _stage() -> void:
	_viewport = SubViewport.new()
	_viewport.size = SIZE
	_viewport.own_world_3d = true
	_viewport.msaa_3d = Viewport.MSAA_4X
	_viewport.render_target_update_mode = SubViewport.UPDATE_DISABLED
	root.add_child(_viewport)
	var light: Node3D = Daylight.instantiate() as Node3D
	_viewport.add_child(light)
	_sun = light.get_node(^"Sun") as DirectionalLight3D
	_sun.directional_shadow_max_distance = 300.0
	_camera = Camera3D.new()
	_camera.near = 0.02
	_camera.far = 3000.0
	_camera.fov = FIELD
	_viewport.add_child(_camera)
	TreeInstance3D.threaded = false
	_instance = TreeInstance3D.new()
	_instance.wind = false
	_instance.reconstruction = _tree
	_viewport.add_child(_instance)
	await process_frame
	await process_frame
	_box = _tree.get_aabb()
	_height = _box.end.y
	var meadow: Ground = Ground.new()
	meadow.shade = 0.35 * maxf(_box.size.x, _box.size.z)
	meadow.reach = clampf(1.2 * _height, 6.0, 25.0)
	_viewport.add_child(meadow)
	await process_frame


func _set_up(view: String) -> void:
	_sun.rotation_degrees = SUN
	_camera.fov = FIELD
	_instance.lod = 0
	var leafy: bool = view != "winter"
	if _instance.leaves != leafy:
		_instance.leaves = leafy
	match view:
		"eye", "winter":
			_see_whole(1.0)
		"backlit":
			_see_whole(-1.0)
		"trunk":
			var stem: Vector4 = _stem_at(BREAST)
			_look(_place(stem), SIDE, 1.5 + stem.w)
		"foot":
			var stem: Vector4 = _stem_at(0.25)
			_look(_place(stem), (SIDE + 0.45 * Vector3.UP).normalized(), 1.6 + stem.w)
		"fork":
			_see_fork()
		"below":
			var stem: Vector4 = _stem_at(BREAST)
			_camera.fov = 70.0
			_camera.position = _place(stem) + SIDE * (stem.w + 0.06 * _height)
			_camera.look_at(_crown_middle() + 0.1 * _height * Vector3.UP, SIDE)
		"sprig":
			_see_sprig()
		"40m", "150m":
			_see_far(view.to_float())
	await process_frame
	await process_frame


func _picture() -> Image:
	_viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	for frame: int in 3:
		await RenderingServer.frame_post_draw
	_viewport.render_target_update_mode = SubViewport.UPDATE_DISABLED
	return _viewport.get_texture().get_image()


func _place(stem: Vector4) -> Vector3:
	return Vector3(stem.x, stem.y, stem.z)


func _look(at: Vector3, from: Vector3, away: float) -> void:
	_camera.position = at + from * away
	_camera.position.y = maxf(_camera.position.y, 0.08)
	_camera.look_at(at)


# From the height of eyes, as far as the whole tree needs. side: -1 has the sun behind it.
func _see_whole(side: float) -> void:
	if side < 0.0:
		_sun.rotation_degrees = Vector3(
			-24.0, 180.0 + rad_to_deg(atan2(SIDE.x, SIDE.z)) - 12.0, 0.0
		)
	var half: float = tan(deg_to_rad(0.5 * FIELD))
	var away: float = 0.56 * maxf(_height, maxf(_box.size.x, _box.size.z)) / half
	away += 0.5 * _box.size.z
	_camera.position = Vector3(_box.get_center().x, minf(EYE, 0.5 * _height), _box.get_center().z)
	_camera.position += SIDE * away
	_camera.look_at(Vector3(_box.get_center().x, 0.47 * _height, _box.get_center().z))


func _see_far(away: float) -> void:
	_instance.lod = -1
	var middle: Vector3 = Vector3(_box.get_center().x, 0.5 * _height, _box.get_center().z)
	_camera.fov = rad_to_deg(2.0 * atan(0.6 * maxf(_height, _box.size.x) / away))
	_camera.position = middle + SIDE * away
	_camera.position.y = minf(EYE, middle.y)
	_camera.look_at(middle)


# Where the trunk is at that height, or at half its own where it is lower; w: its radius.
func _stem_at(high: float) -> Vector4:
	var most: float = minf(high, 0.5 * _height)
	var before: int = _tree.get_root()
	for id: int in _tree.get_trunk_nodes():
		if _tree.get_node_position(id).y >= most:
			var a: Vector3 = _tree.get_node_position(before)
			var b: Vector3 = _tree.get_node_position(id)
			var share: float = clampf((most - a.y) / maxf(b.y - a.y, 1e-4), 0.0, 1.0)
			var radius: float = lerpf(
				_tree.get_node_radius(before), _tree.get_node_radius(id), share
			)
			var place: Vector3 = a.lerp(b, share)
			return Vector4(place.x, place.y, place.z, radius)
		before = id
	var place: Vector3 = _tree.get_node_position(before)
	return Vector4(place.x, place.y, place.z, _tree.get_node_radius(before))


# The fork whose second branch is the stoutest, from across its plane.
func _see_fork() -> void:
	var best: int = _tree.get_root()
	var stoutest: float = 0.0
	var plane: Vector3 = SIDE
	for id: int in _tree.get_node_ids():
		var children: PackedInt32Array = _tree.get_node_children(id)
		if children.size() < 2 or _tree.get_node_position(id).y < 0.1 * _height:
			continue
		var radii: Array[float] = []
		var ways: Array[Vector3] = []
		for child: int in children:
			radii.append(_tree.get_node_radius(child))
			ways.append(_tree.get_node_position(child) - _tree.get_node_position(id))
		var first: int = radii.find(radii.max())
		var other: float = 0.0
		for i: int in radii.size():
			if i != first and radii[i] > other:
				other = radii[i]
				if other > stoutest:
					plane = ways[first].cross(ways[i])
		if other > stoutest:
			stoutest = other
			best = id
	plane.y *= 0.3
	plane = plane.normalized() if plane.length() > 1e-9 else SIDE
	if plane.dot(SIDE) < 0.0:
		plane = -plane
	_instance.leaves = false
	_look(
		_tree.get_node_position(best) + Vector3.UP * 0.15, plane, 1.0 + _tree.get_node_radius(best)
	)


func _crown_middle() -> Vector3:
	return _box.get_center() + 0.15 * _height * Vector3.UP


# The outermost twig on the sun's side, half way up the crown.
func _see_sprig() -> void:
	var middle: Vector3 = _crown_middle()
	var best: Vector3 = middle
	var most: float = -INF
	var away: Vector3 = SIDE
	for id: int in _tree.get_node_ids():
		if not _tree.get_node_children(id).is_empty():
			continue
		var place: Vector3 = _tree.get_node_position(id)
		var out: float = (place - middle).dot(SIDE) - 1.5 * absf(place.y - middle.y)
		if out > most:
			most = out
			best = place
			away = (place - middle).normalized()
	_look(best - 0.1 * away, (SIDE + 0.25 * Vector3.UP).normalized(), 0.6)
