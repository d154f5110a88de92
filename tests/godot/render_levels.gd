extends "./suite.gd"
## What needs a window: levels of detail that take turns, and many trees at once.

const SIZE: Vector2i = Vector2i(160, 160)
const SKY: Color = Color(0.1, 0.1, 0.9)
const LIMIT_FRAMES: int = 2000
# Of a channel: what rounding may change.
const ROUNDING: float = 0.02

var _viewport: SubViewport
var _camera: Camera3D


func _is_compatibility() -> bool:
	return RenderingServer.get_current_rendering_method() == "gl_compatibility"


func _stage() -> void:
	_viewport = SubViewport.new()
	_viewport.size = SIZE
	_viewport.own_world_3d = true
	_viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	tree.root.add_child(_viewport)
	var world: WorldEnvironment = WorldEnvironment.new()
	world.environment = Environment.new()
	world.environment.background_mode = Environment.BG_COLOR
	world.environment.background_color = SKY
	world.environment.ambient_light_source = Environment.AMBIENT_SOURCE_COLOR
	world.environment.ambient_light_color = Color.WHITE
	_viewport.add_child(world)
	_camera = Camera3D.new()
	_camera.fov = 40.0
	_viewport.add_child(_camera)


func _plant(made: TreeReconstruction, place: Vector3) -> TreeInstance3D:
	var instance: TreeInstance3D = TreeInstance3D.new()
	instance.reconstruction = made
	instance.wind = false
	instance.position = place
	_viewport.add_child(instance)
	return instance


func _settle(instance: TreeInstance3D) -> void:
	for i: int in LIMIT_FRAMES:
		if not instance.is_building_levels():
			return
		await tree.process_frame
	check(false, "The levels did not end.")


func _look_at(instance: TreeInstance3D, reach: float) -> void:
	var box: AABB = instance.reconstruction.get_aabb()
	var middle: Vector3 = instance.position + box.get_center()
	_camera.position = middle + Vector3(0.0, 0.0, box.size.length() * reach)
	_camera.look_at(middle)


func _picture() -> Image:
	await RenderingServer.frame_post_draw
	await RenderingServer.frame_post_draw
	return _viewport.get_texture().get_image()


func _is_same(a: Color, b: Color) -> bool:
	return absf(a.r - b.r) < ROUNDING and absf(a.g - b.g) < ROUNDING and absf(a.b - b.b) < ROUNDING


func _different(a: Image, b: Image) -> int:
	var count: int = 0
	for y: int in SIZE.y:
		for x: int in SIZE.x:
			count += 0 if _is_same(a.get_pixel(x, y), b.get_pixel(x, y)) else 1
	return count


# Where two levels meet, each pixel is the one's or the other's: so there are no holes, nothing is
# drawn twice, and what is covered lies between what they cover alone.
func test_each_pixel_of_two_levels_that_meet_is_of_one_of_them() -> void:
	# Forward+ and Mobile mix them by the same code.
	if RenderingServer.get_current_rendering_method() == "forward_plus":
		return
	_stage()
	var made: TreeReconstruction = grown_tree(2, 600)
	var instance: TreeInstance3D = _plant(made, Vector3.ZERO)
	_look_at(instance, 1.4)
	await _settle(instance)
	var middle: Vector3 = Vector3(0.0, 0.5 * instance.get_tree_height(), 0.0)
	var away: float = _camera.position.distance_to(middle)
	for level: int in [1, 2]:
		var pictures: Array[Image] = []
		for begin: float in [2.0 * away, 0.5 * away, away]:
			var distances: PackedFloat32Array = [0.25 * away, begin, 4.0 * away]
			instance.level_distances = distances if level == 2 else distances.slice(1)
			pictures.append(await _picture())
		var holes: int = 0
		var nobodys: int = 0
		var ones: int = 0
		var others: int = 0
		for y: int in SIZE.y:
			for x: int in SIZE.x:
				var finer: Color = pictures[0].get_pixel(x, y)
				var coarser: Color = pictures[1].get_pixel(x, y)
				var seen: Color = pictures[2].get_pixel(x, y)
				if _is_same(finer, coarser):
					nobodys += 0 if _is_same(seen, finer) else 1
				elif _is_same(seen, finer):
					ones += 1
				elif _is_same(seen, coarser):
					others += 1
				else:
					nobodys += 1
				if _is_same(seen, SKY) and not _is_same(finer, SKY) and not _is_same(coarser, SKY):
					holes += 1
		check(ones + others > 500, "Levels %d and %d look alike." % [level - 1, level])
		check_near(ones / float(ones + others), 0.5, 0.1, "the share of the finer level")
		check_equal(holes, 0, "the holes where level %d begins" % level)
		check(nobodys < 5, "%d pixels are neither level's where %d begins." % [nobodys, level])
	_viewport.free()


func _redness(picture: Image) -> float:
	var sum: float = 0.0
	for y: int in SIZE.y:
		for x: int in SIZE.x:
			var color: Color = picture.get_pixel(x, y)
			sum += maxf(color.r - maxf(color.g, color.b), 0.0)
	return sum


# Compatibility has room for the values of 256 instances. The engine says so where they don't fit.
func test_two_hundred_trees_stand_in_compatibility() -> void:
	if not _is_compatibility():
		return
	_stage()
	var common: TreeReconstruction = grown_tree(2, 40)
	var other: TreeReconstruction = grown_tree(3, 300)
	other.leaf_rule = LeafRule.from_preset("maple")
	TreeInstance3D.threaded = false
	for i: int in 200:
		_plant(common, Vector3(4.0 * (i % 20), 0.0, -20.0 - 4.0 * (i / 20)))
	var last: TreeInstance3D = _plant(other, Vector3(30.0, 0.0, 30.0))
	await tree.process_frame
	await tree.process_frame
	TreeInstance3D.threaded = true
	_look_at(last, 1.2)
	_camera.far = 30.0
	var summer: float = _redness(await _picture())
	other.leaf_rule.season = 0.78
	await _settle(last)
	var still: Image = await _picture()
	check(_redness(still) > summer + 100.0, "The last tree's season does not show.")
	check(_different(still, await _picture()) < 5, "The last tree moves without wind.")
	last.wind = true
	await tree.create_timer(0.3).timeout
	check(_different(still, await _picture()) > 300, "No wind moves the last tree.")
	_viewport.free()


# What draws with copies there follows what is set in materials.
func test_materials_are_followed_in_compatibility() -> void:
	if not _is_compatibility():
		return
	_stage()
	var instance: TreeInstance3D = _plant(grown_tree(2), Vector3.ZERO)
	_look_at(instance, 1.4)
	await _settle(instance)
	var before: Image = await _picture()
	var bark: ShaderMaterial = instance.mesh.surface_get_material(0).duplicate()
	instance.bark_material = bark
	instance.leaves = false
	await _settle(instance)
	var bare: Image = await _picture()
	check(_different(before, bare) > 500, "The leaves are still there.")
	bark.set_shader_parameter(&"tint", Color.RED)
	var red: Image = await _picture()
	check(_redness(red) > 10.0 + 2.0 * _redness(bare), "A material's new tint is not seen.")
	var plain: StandardMaterial3D = StandardMaterial3D.new()
	plain.shading_mode = BaseMaterial3D.SHADING_MODE_UNSHADED
	plain.albedo_color = Color.GREEN
	instance.material_override = plain
	await tree.process_frame
	check_equal(_redness(await _picture()), 0.0, "the red of an override of another kind")
	instance.material_override = null
	await tree.process_frame
	check(_different(red, await _picture()) < 5, "The material did not come back.")
	bark.shader = load("res://addons/tree_reconstruction/shaders/tree_channels.gdshader")
	check(_different(red, await _picture()) > 300, "A material's new shader is not seen.")
	_viewport.free()
