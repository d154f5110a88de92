extends "./trunk_photos.gd"
## The same, from farther away, with a round crown on the trunk.

## What its leaves are like as it is stored, on average.
const LEAF: Color = Color(0.34, 0.4, 0.13)

const _CROWN: Vector3 = Vector3(0.0, 0.0, -0.75)
const _RADIUS: float = 0.6


func _set_camera() -> void:
	super()
	_away = 3.6


func _picture(i: int) -> Image:
	var picture: Image = super(i)
	var noise: FastNoiseLite = FastNoiseLite.new()
	noise.seed = 9
	noise.frequency = 8.0
	noise.fractal_octaves = 5
	noise.fractal_gain = 0.8
	var centre: Vector3 = _centre(i)
	var to_scene: Basis = _turn(i).transposed()
	for y: int in _size.y:
		for x: int in _size.x:
			var pixel: Vector2 = Vector2(x + 0.5, y + 0.5) - 0.5 * _size
			var way: Vector3 = (to_scene * Vector3(pixel.x, pixel.y, _focal)).normalized()
			var ahead: float = (_CROWN - centre).dot(way)
			var beside: float = (centre + ahead * way - _CROWN).length()
			if beside < _RADIUS:
				var at: Vector3 = centre + way * (ahead - sqrt(_RADIUS * _RADIUS - beside * beside))
				picture.set_pixel(x, y, LEAF * (1.0 + 1.1 * noise.get_noise_3dv(at)))
	return picture
