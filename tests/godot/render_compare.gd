extends "./picture_suite.gd"
## What 'Compare with Photos' draws of the scene and a photo.

const Stage := preload("res://addons/tree_reconstruction/editor/compare/photo_stage.gd")
const PHOTO: Color = Color(0.8, 0.4, 0.2)
const SIZE: Vector2i = Vector2i(200, 160)
# The photo's pixels; the stage is wider.
const PIXELS: Vector2i = Vector2i(300, 320)

var _page: SubViewport
var _compared: Stage


# The stage over a viewport with a grown tree, seen from where its camera is.
func _compare(made: TreeReconstruction) -> void:
	_open_stage(SIZE)
	_look_at_all(made)
	await _show_tree(made, false)
	_page = SubViewport.new()
	_page.size = SIZE
	_page.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	tree.root.add_child(_page)
	_compared = Stage.new(&"")
	_page.add_child(_compared)
	_compared.size = SIZE
	_compared.look_into(_viewport)
	(
		_compared
		. stand(
			{
				"name": "a.jpg",
				"transform": _camera.global_transform,
				"focal": 0.5 * PIXELS.y / tan(deg_to_rad(20.0)),
				"principal": Vector2(PIXELS) * 0.5,
				"size": PIXELS,
			}
		)
	)


func _show_photo() -> void:
	var photo: Image = Image.create_empty(150, 160, false, Image.FORMAT_RGBA8)
	photo.fill(PHOTO)
	_compared.show_picture(ImageTexture.create_from_image(photo), 0.5)


func _drawn() -> Image:
	_compared.update(Transform3D())
	await RenderingServer.frame_post_draw
	await RenderingServer.frame_post_draw
	return _page.get_texture().get_image()


func _is_like(color: Color, wanted: Color) -> bool:
	var apart: Vector3 = Vector3(color.r - wanted.r, color.g - wanted.g, color.b - wanted.b)
	return apart.length() < 0.03


func _end_all() -> void:
	_page.free()
	_viewport.free()


func test_what_lies_over_what() -> void:
	var made: TreeReconstruction = grown_tree(2)
	await _compare(made)
	await _drawn()
	var scene: Image = _compared._viewport.get_texture().get_image()
	var alone: Image = await _drawn()
	_show_photo()
	var pictures: Array[Image] = []
	for mode: Stage.Mode in [Stage.Mode.BEHIND, Stage.Mode.IN_FRONT, Stage.Mode.DIFFERENCE]:
		_compared.mode = mode
		pictures.append(await _drawn())
	_compared.mode = Stage.Mode.IN_FRONT
	_compared.opacity = 0.5
	var half: Image = await _drawn()
	var grey: float = 0.35 * (PHOTO.r * 0.299 + PHOTO.g * 0.587 + PHOTO.b * 0.114)
	var seen: Array[int] = [0, 0]
	for y: int in range(2, SIZE.y - 2, 3):
		for x: int in range(2, SIZE.x - 2, 3):
			var wood: Color = scene.get_pixel(x, y)
			# 75 pixels to each side of the middle are photo.
			var in_photo: bool = absi(x - 100) < 74
			if absi(absi(x - 100) - 75) < 2 or (wood.a > 0.0 and wood.a < 1.0):
				continue
			var wanted: Array[Color] = [wood, wood, wood, wood]
			if wood.a == 0.0:
				seen[0] += 1
				wanted = [Stage.GROUND, Stage.GROUND, Stage.GROUND, Stage.GROUND]
				if in_photo:
					var flat: Color = Color(grey, grey, grey)
					wanted = [PHOTO, PHOTO, flat, Stage.GROUND.lerp(PHOTO, 0.5)]
			elif in_photo:
				seen[1] += 1
				var apart: Color = Color(
					absf(wood.r - PHOTO.r), absf(wood.g - PHOTO.g), absf(wood.b - PHOTO.b)
				)
				wanted = [wood, PHOTO, apart, wood.lerp(PHOTO, 0.5)]
			var all: Array[Image] = pictures + ([half] as Array[Image])
			for i: int in 4:
				check(
					_is_like(all[i].get_pixel(x, y), wanted[i]),
					"%d, %d in picture %d: %s" % [x, y, i, all[i].get_pixel(x, y)]
				)
			var bare: Color = wood if wood.a > 0.0 else Stage.GROUND
			check(_is_like(alone.get_pixel(x, y), bare), "%d, %d without a photo" % [x, y])
			if failures.size() > 6:
				return
	check(seen[0] > 500 and seen[1] > 20, "There is little to be seen: %s" % [seen])
	_end_all()


# Nearer, the scene is drawn anew, and lies on what it lay on.
func test_what_is_seen_nearer_is_the_same() -> void:
	await _compare(grown_tree(2))
	_show_photo()
	await _drawn()
	var far: Image = _compared._viewport.get_texture().get_image()
	_compared._go_nearer(Vector2(100, 80), 2.0)
	await _drawn()
	var near: Image = _compared._viewport.get_texture().get_image()
	var same: int = 0
	var all: int = 0
	for y: int in range(4, SIZE.y, 2):
		for x: int in range(4, SIZE.x, 2):
			var at: Vector2i = (Vector2i(x, y) + SIZE) / 2
			if near.get_pixel(x, y).a == 1.0 and at.x < SIZE.x and at.y < SIZE.y:
				all += 1
				at = Vector2i((Vector2(x, y) - Vector2(100, 80)) / 2.0 + Vector2(100, 80))
				same += int(far.get_pixelv(at).a > 0.3)
	check(all > 100, "The tree is hardly seen.")
	check(same > 0.85 * all, "%d of %d pixels lie elsewhere." % [all - same, all])
	_end_all()


# The sky lights what stands below it, but is not seen.
func test_a_sky_is_light_alone() -> void:
	await _compare(grown_tree(2))
	var world: WorldEnvironment = (
		_viewport.find_children("*", "WorldEnvironment", true, false)[0] as WorldEnvironment
	)
	world.environment.sky = Sky.new()
	world.environment.sky.sky_material = ProceduralSkyMaterial.new()
	world.environment.background_mode = Environment.BG_SKY
	world.environment.ambient_light_source = Environment.AMBIENT_SOURCE_BG
	for sun: Node in _viewport.find_children("*", "DirectionalLight3D", true, false):
		sun.free()
	_compared.look_into(_viewport)
	for i: int in 4:
		await _drawn()
	var scene: Image = _compared._viewport.get_texture().get_image()
	check_equal(scene.get_pixel(1, 1).a, 0.0, "the alpha of the sky")
	var light: float = 0.0
	var count: int = 0
	for y: int in SIZE.y:
		for x: int in SIZE.x:
			var wood: Color = scene.get_pixel(x, y)
			if wood.a == 1.0:
				light += wood.get_luminance()
				count += 1
	check(count > 50, "The tree is hardly seen.")
	check(light > 0.03 * count, "Without a sun the tree is black: %f" % (light / count))
	_end_all()


# Ground hides a foot, and a photo shows the ground.
func test_no_foot_is_seen_in_the_ground() -> void:
	var made: TreeReconstruction = grown_tree(2)
	await _compare(made)
	var instance: TreeInstance3D = (
		_viewport.find_children("*", "TreeInstance3D", true, false)[0] as TreeInstance3D
	)
	# Nearer, where all of it is more than a few pixels, and from above, as photos are taken.
	_compared._view["transform"] = Transform3D(Basis.IDENTITY, Vector3(0.0, 1.6, 6.0))
	# As a project may want it, whose pixels have four depths.
	for msaa: Viewport.MSAA in [Viewport.MSAA_DISABLED, Viewport.MSAA_4X]:
		_compared._viewport.msaa_3d = msaa
		await _check_foot(instance)
	_end_all()


func _check_foot(instance: TreeInstance3D) -> void:
	await _drawn()
	var before: Array[int] = _count_wood()
	check(before[0] > 30, "Of the foot, only %d pixels are seen." % before[0])
	_compared.hide_feet([instance])
	await _drawn()
	var after: Array[int] = _count_wood()
	check_equal(after[0], 0, "pixels of the foot")
	check_equal(after[1], before[1], "pixels of the tree above it")
	instance.visible = false
	_compared.hide_feet([instance, null])
	await _drawn()
	check_equal(_count_wood(), [0, 0] as Array[int], "pixels of a hidden tree")
	instance.visible = true
	_compared.hide_feet([])
	await _drawn()
	check_equal(_count_wood(), before, "pixels once no tree's foot is hidden")


# How much of the picture is wood more than 3 cm below the root, and more than 3 cm above it, in the
# plane through it that faces the camera.
func _count_wood() -> Array[int]:
	var seen: Image = _compared._viewport.get_texture().get_image()
	var count: Array[int] = [0, 0]
	for y: int in SIZE.y:
		var place: Vector3 = _compared.camera.project_position(Vector2(SIZE.x * 0.5, y + 0.5), 6.0)
		if absf(place.y) < 0.03:
			continue
		for x: int in SIZE.x:
			count[0 if place.y < 0.0 else 1] += int(seen.get_pixel(x, y).a > 0.0)
	return count
