extends "./picture_suite.gd"
## Leaves that have the colors of photos, in the renderer that this run uses.

const PhotoLeaves := preload("res://addons/tree_reconstruction/editor/photos/photo_leaves.gd")
const SIZE: Vector2i = Vector2i(320, 320)
const LUMINANCE: Vector3 = Vector3(0.2126, 0.7152, 0.0722)
# What the suite takes for sky, and hardly mixes with leaves.
const DARK: Color = Color(0.0, 0.0, 0.17)
# As the reports of photos have it: an autumn that is redder above.
const ALBEDO: Array = [0.22, 0.12, 0.03]
const LOW: Array = [0.8, 1.15, 1.1]
const HIGH: Array = [1.25, 0.9, 0.9]


static func colors(tree_height: float) -> Dictionary:
	return {
		"from": "photos",
		"albedo": ALBEDO,
		"least_green": [0.26, 0.11, 0.025],
		"greenest": [0.18, 0.13, 0.035],
		"low": LOW,
		"high": HIGH,
		"low_height_m": 0.3 * tree_height,
		"high_height_m": tree_height,
	}


func _grown() -> TreeReconstruction:
	var made: TreeReconstruction = grown_tree(2, 900)
	made.leaf_rule = LeafRule.from_preset("oak")
	return made


# A stage where things have their own colors, and bark one that counts as sky.
func _open_flat(made: TreeReconstruction) -> TreeInstance3D:
	_open_stage(SIZE)
	_viewport.debug_draw = Viewport.DEBUG_DRAW_UNSHADED
	_look_at_all(made)
	var instance: TreeInstance3D = await _show_tree(made, false)
	var bark: StandardMaterial3D = StandardMaterial3D.new()
	bark.albedo_color = DARK
	instance.bark_material = bark
	instance.leaf_material = PhotoLeaves.make(colors(made.get_aabb().end.y), made)
	return instance


# A card's pixels mix what lies side by side: what is bark for the most part is bark.
static func _shows_leaf(pixel: Color) -> bool:
	return _shows_tree(pixel) and pixel.r > 0.3


# The mean of what a part of the picture shows of leaves, as light; from its top, 0, to its base, 1.
func _light(picture: Image, from: float = 0.0, to: float = 1.0) -> Vector3:
	var box: Rect2i = Rect2i(SIZE, Vector2i.ZERO)
	for y: int in SIZE.y:
		for x: int in SIZE.x:
			if _shows_leaf(picture.get_pixel(x, y)):
				box = box.expand(Vector2i(x, y)) if box.position != SIZE else Rect2i(x, y, 0, 0)
	var sum: Vector3 = Vector3.ZERO
	var count: int = 0
	for y: int in range(
		box.position.y + roundi(from * box.size.y), box.position.y + roundi(to * box.size.y)
	):
		for x: int in SIZE.x:
			if _shows_leaf(picture.get_pixel(x, y)):
				var light: Color = picture.get_pixel(x, y).srgb_to_linear()
				sum += Vector3(light.r, light.g, light.b)
				count += 1
	check(count > 200, "Only %d pixels show leaves." % count)
	return sum / maxi(count, 1)


# Colors over their luminance. Leaves have so little blue that its levels are few.
func _check_hue(seen: Vector3, wanted: Vector3, within: float, what: String) -> void:
	var ratio: Vector3 = seen / seen.dot(LUMINANCE) / (wanted / wanted.dot(LUMINANCE))
	for axis: int in 3:
		var allowed: float = 2.0 * within if axis == 2 else within
		check_near(
			ratio[axis], 1.0, allowed, "%s: channel %d over what it should be" % [what, axis]
		)


static func _vector(numbers: Array) -> Vector3:
	return Vector3(numbers[0], numbers[1], numbers[2])


func test_a_crown_has_the_measured_colors_at_every_level() -> void:
	var made: TreeReconstruction = _grown()
	var instance: TreeInstance3D = await _open_flat(made)
	var albedo: Vector3 = _vector(ALBEDO)
	for level: int in 3:
		instance.lod = level
		while instance.is_rebuilding():
			await tree.process_frame
		var picture: Image = await _picture()
		var seen: Vector3 = _light(picture)
		_check_hue(seen, albedo, 0.1, "level %d" % level)
		# Some of what is seen lies deep in the crown.
		var bright: float = seen.dot(LUMINANCE) / albedo.dot(LUMINANCE)
		check(bright > 0.6 and bright < 1.15, "Level %d is %.2f as bright." % [level, bright])
		var above: Vector3 = _light(picture, 0.0, 0.3)
		var below: Vector3 = _light(picture, 0.7, 1.0)
		check(
			above.x / above.y > 1.15 * below.x / below.y,
			"Level %d: %s above, %s below." % [level, above, below]
		)
	_viewport.free()


func test_other_leaves_get_the_same_colors() -> void:
	var made: TreeReconstruction = _grown()
	var instance: TreeInstance3D = await _open_flat(made)
	var material: ShaderMaterial = instance.leaf_material as ShaderMaterial
	for look: String in ["birch", "maple"]:
		made.leaf_rule = LeafRule.from_preset(look)
		while instance.is_rebuilding():
			await tree.process_frame
		check(PhotoLeaves.is_outdated(material, made), "Leaves of a %s are none of an oak." % look)
		check(PhotoLeaves.suit(material, made), "The picture of a %s can't be read." % look)
		check(not PhotoLeaves.is_outdated(material, made), "It is still that of another kind.")
		_check_hue(_light(await _picture()), _vector(ALBEDO), 0.1, look)
	_viewport.free()


func test_a_season_is_that_of_the_kind() -> void:
	var made: TreeReconstruction = _grown()
	made.leaf_rule.season = 0.72
	var instance: TreeInstance3D = await _open_flat(made)
	var own: Vector3 = _light(await _picture())
	instance.leaf_material = null
	var drawn: Vector3 = _light(await _picture())
	made.leaf_rule.season = 0.3
	while instance.is_rebuilding():
		await tree.process_frame
	var green: Vector3 = _light(await _picture())
	var off: float = (own - drawn).length()
	check(off < 0.5 * (green - drawn).length(), "Autumn is off by %.3f." % off)
	_viewport.free()


func test_a_baked_tree_and_its_impostor_have_them_too() -> void:
	var made: TreeReconstruction = _grown()
	var instance: TreeInstance3D = await _open_flat(made)
	var live: Vector3 = _light(await _picture())
	instance.visible = false
	var baker: TreeBaker = TreeBaker.new()
	baker.levels = 1
	baker.wind = false
	baker.bark_material = instance.bark_material
	baker.leaf_material = instance.leaf_material
	var baked: Node3D = baker.bake(made).instantiate()
	_viewport.add_child(baked)
	_check_hue(_light(await _picture()), live, 0.1, "baked")
	baked.free()
	var picturing: TreeImpostorBaker = TreeImpostorBaker.new()
	picturing.resolution = 512
	picturing.views = 6
	picturing.bark_material = instance.bark_material
	picturing.leaf_material = instance.leaf_material
	var impostor: TreeImpostor = await picturing.bake(made)
	check(impostor != null, picturing.get_error_message())
	if impostor == null:
		_viewport.free()
		return
	var card: MeshInstance3D = MeshInstance3D.new()
	card.mesh = impostor.get_mesh()
	_viewport.add_child(card)
	RenderingServer.instance_geometry_set_shader_parameter(card.get_instance(), &"tree_wind", 0.0)
	_check_hue(_light(await _picture()), live, 0.1, "the impostor")
	_viewport.free()
