extends "./suite.gd"
## What files of tests that look at pictures extend: a stage under a blue sky, and what is to be
## seen on it in the renderer that this run uses.

const SKY: Color = Color(0.2, 0.3, 0.9)
# Pixels across the shadows of all that is seen: as fine as these pictures.
const SHADOWS: int = 1024

var _viewport: SubViewport
var _camera: Camera3D


# An empty stage: the sky, its light, a sun and a camera.
func _open_stage(size: Vector2i, shadows: bool = false) -> void:
	_viewport = SubViewport.new()
	_viewport.size = size
	_viewport.own_world_3d = true
	_viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	tree.root.add_child(_viewport)
	var world: WorldEnvironment = WorldEnvironment.new()
	world.environment = Environment.new()
	world.environment.background_mode = Environment.BG_COLOR
	world.environment.background_color = SKY
	world.environment.ambient_light_source = Environment.AMBIENT_SOURCE_COLOR
	world.environment.ambient_light_color = Color.WHITE
	world.environment.ambient_light_energy = 0.5
	_viewport.add_child(world)
	var sun: DirectionalLight3D = DirectionalLight3D.new()
	sun.rotation_degrees = Vector3(-40, 30, 0)
	sun.shadow_enabled = shadows
	_viewport.add_child(sun)
	# The engine's own is 4096, and cleared for each picture, whatever is in it.
	RenderingServer.directional_shadow_atlas_set_size(SHADOWS, true)
	_camera = Camera3D.new()
	_camera.fov = 40.0
	_viewport.add_child(_camera)
	_camera.make_current()


# Stands the camera before a tree, so that all of it is in the picture.
func _look_at_all(made: TreeReconstruction, at: Vector3 = Vector3.ZERO) -> void:
	var box: AABB = made.get_aabb()
	_camera.position = at + box.get_center() + Vector3(0, 0, box.size.length() * 1.4)


# Puts a tree on the stage, at its finest level, and waits until it is built.
func _show_tree(made: TreeReconstruction, wind: bool = true) -> TreeInstance3D:
	var instance: TreeInstance3D = TreeInstance3D.new()
	instance.lod = 0
	instance.wind = wind
	instance.reconstruction = made
	_viewport.add_child(instance)
	while instance.is_rebuilding():
		await tree.process_frame
	return instance


# What the stage looks like now.
func _picture() -> Image:
	await RenderingServer.frame_post_draw
	await RenderingServer.frame_post_draw
	return _viewport.get_texture().get_image()


# What the stage looks like once nothing changes any more. The engine draws with a pipeline for all
# cases until the one for just this is compiled, in the background, and they round differently.
func _settled() -> Image:
	var picture: Image = await _picture()
	var same: int = 0
	var tries: int = 0
	while same < 10 and tries < 300:
		var next: Image = await _picture()
		same = same + 1 if next.get_data() == picture.get_data() else 0
		picture = next
		tries += 1
	check(same == 10, "The picture does not come to rest.")
	return picture


static func _shows_tree(pixel: Color) -> bool:
	return pixel.b < pixel.g + 0.15


# The share of the picture that shows the tree, and its mean color.
static func _summary(picture: Image) -> Array:
	var count: int = 0
	var sum: Color = Color(0.0, 0.0, 0.0)
	for y: int in picture.get_height():
		for x: int in picture.get_width():
			var pixel: Color = picture.get_pixel(x, y)
			if _shows_tree(pixel):
				count += 1
				sum += pixel
	return [count / float(picture.get_width() * picture.get_height()), sum / maxf(count, 1.0)]


# The differences of all pixels, or of those in `part`, together.
static func _change(a: Image, b: Image, part: Rect2i = Rect2i()) -> float:
	var whole: Rect2i = part if part.has_area() else Rect2i(Vector2i.ZERO, a.get_size())
	var sum: float = 0.0
	for y: int in range(whole.position.y, whole.end.y):
		for x: int in range(whole.position.x, whole.end.x):
			sum += _apart(a.get_pixel(x, y), b.get_pixel(x, y))
	return sum


# The mean difference of a channel, over the pixels where either shows the tree.
static func _difference(a: Image, b: Image) -> float:
	var sum: float = 0.0
	var count: int = 0
	for y: int in a.get_height():
		for x: int in a.get_width():
			var one: Color = a.get_pixel(x, y)
			var other: Color = b.get_pixel(x, y)
			if _shows_tree(one) or _shows_tree(other):
				sum += _apart(one, other)
				count += 1
	return sum / (3.0 * maxi(count, 1))


static func _apart(one: Color, other: Color) -> float:
	return absf(one.r - other.r) + absf(one.g - other.g) + absf(one.b - other.b)
