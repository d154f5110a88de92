extends "./photo_files.gd"
## The same, where the photos show the trunk before a bright sky, and are near and sharp enough for
## a picture of its bark: rough at all scales, with cracks up and down.

const _SKY: Color = Color(0.8, 0.87, 0.93)
const _BARK: Color = Color(0.62, 0.5, 0.4)


func _set_camera() -> void:
	_count = 13
	_size = Vector2i(320, 640)
	_focal = 700.0
	_away = 2.6
	_arc = TAU / 30.0 * (_count - 1)


func _picture(i: int) -> Image:
	var noise: FastNoiseLite = FastNoiseLite.new()
	noise.seed = 4
	noise.frequency = 6.0
	noise.fractal_octaves = 6
	noise.fractal_gain = 0.75
	var picture: Image = Image.create_empty(_size.x, _size.y, false, Image.FORMAT_RGB8)
	picture.fill(_SKY)
	var centre: Vector3 = _centre(i)
	var to_scene: Basis = _turn(i).transposed()
	for y: int in _size.y:
		for x: int in _size.x:
			var pixel: Vector2 = Vector2(x + 0.5, y + 0.5) - 0.5 * _size
			var way: Vector3 = to_scene * Vector3(pixel.x / _focal, pixel.y / _focal, 1.0)
			var at: Vector3 = _meet_trunk(centre, way)
			if at != Vector3.INF:
				var tone: float = 0.75 + 0.9 * noise.get_noise_3dv(Vector3(at.x, at.y, 0.3 * at.z))
				picture.set_pixel(x, y, _BARK * tone)
	return picture


# Where a ray meets the model's trunk, a cone from z = 1.5 up to -0.5; Vector3.INF where it doesn't.
static func _meet_trunk(from: Vector3, way: Vector3) -> Vector3:
	var narrows: float = 0.04
	# Its radius at the ray's begin, and how that changes along it.
	var radius: float = 0.15 - narrows * (1.5 - from.z)
	var change: float = narrows * way.z
	var a: float = way.x * way.x + way.y * way.y - change * change
	var b: float = from.x * way.x + from.y * way.y - radius * change
	var c: float = from.x * from.x + from.y * from.y - radius * radius
	var root: float = b * b - a * c
	if root <= 0.0:
		return Vector3.INF
	var at: Vector3 = from + way * ((-b - sqrt(root)) / a)
	return at if at.z < 1.5 and at.z > -0.5 else Vector3.INF
