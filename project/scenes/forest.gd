extends Node3D
## A forest that a single scan makes: thousands of trees on hills, in the wind, and none is a copy.

const DemoTree := preload("demo_tree.gd")
const Controls := preload("panel.gd")
const WalkingCamera := preload("walking_camera.gd")

# The hills: metres from side to side, metres from one corner to the next, and how high they are.
const _SIDE: float = 500.0
const _STEP: float = 4.0
const _RELIEF: float = 14.0

var _noise: FastNoiseLite = FastNoiseLite.new()
var _since: float = 0.0

@onready var _hills: MeshInstance3D = $Hills
@onready var _trees: TreeVariantSpawner3D = $Trees
@onready var _walker: WalkingCamera = $Walker
@onready var _panel: Controls = $Panel


func _ready() -> void:
	_noise.frequency = 0.006
	_noise.fractal_octaves = 3
	_hills.mesh = _make_hills()
	_make_air()
	_walker.ground = height_at
	_walker.position = Vector3(0.0, height_at(0.0, 0.0) + 1.7, 0.0)
	var source: TreeReconstruction = DemoTree.load_tree()
	_trees.minimum_distance = 0.3 * source.get_aabb().size.y
	_trees.source = source
	_trees.finished.connect(_find_glade.bind(0.6 * source.get_aabb().size.y), CONNECT_ONE_SHOT)
	_make_panel()


func _process(delta: float) -> void:
	_since += delta
	if _since < 0.5:
		return
	_since = 0.0
	var figures: Array = [
		_trees.get_tree_count(),
		_monitor(Performance.RENDER_TOTAL_DRAW_CALLS_IN_FRAME),
		_monitor(Performance.RENDER_TOTAL_PRIMITIVES_IN_FRAME) / 1e6,
		_monitor(Performance.TIME_FPS),
	]
	_panel.note("%d trees, %d draw calls\n%.2f million triangles, %d frames a second" % figures)


## How high the ground is at a place, in metres.
func height_at(x: float, z: float) -> float:
	return _RELIEF * _noise.get_noise_2d(x, z)


# Between trees one sees far: what is there is veiled.
func _make_air() -> void:
	var world: WorldEnvironment = $World/Daylight/Environment
	# The other scenes share it.
	world.environment = world.environment.duplicate() as Environment
	world.environment.fog_depth_begin = 10.0
	world.environment.fog_depth_end = 420.0
	world.environment.fog_light_color = Color(0.74, 0.81, 0.84)


# Goes to where no tree stands in the way, and looks to where the next ones are a little way off.
func _find_glade(room: float) -> void:
	for i: int in 400:
		# Outwards in a spiral.
		var away: Vector2 = Vector2.from_angle(2.4 * i) * (2.0 * sqrt(i))
		var place: Vector3 = Vector3(away.x, height_at(away.x, away.y), away.y)
		if _trees.find_trees(place, room).is_empty():
			_walker.position = place + Vector3.UP * 1.7
			_walker.turn_to(_find_view(place, 2.0 * room))
			return


# The heading in which the first tree, within some 25 degrees, is about so far away.
func _find_view(place: Vector3, wanted: float) -> float:
	var best: float = 0.0
	var least: float = INF
	for i: int in 24:
		var yaw: float = TAU * i / 24.0
		var ahead: Vector3 = Basis(Vector3.UP, yaw) * Vector3.FORWARD
		var free: float = 3.0 * wanted
		for id: int in _trees.find_trees(place, 3.0 * wanted):
			var way: Vector3 = (_trees.get_tree_transform(id).origin - place) * Vector3(1, 0, 1)
			if way.normalized().dot(ahead) > 0.9:
				free = way.length()
				break
		if absf(free - wanted) < least:
			least = absf(free - wanted)
			best = yaw
	return best


func _make_panel() -> void:
	_panel.begin(
		"A forest of one tree",
		"Walk with W, A, S, D, drag to look, Shift to run, the wheel to rise above the trees."
	)
	_panel.slider(
		"Trees",
		"How many stand on 100 square metres, where there is room.",
		Vector3(0.05, 4.0, 0.05),
		_trees.density,
		func(value: float) -> void: _trees.density = value
	)
	_panel.slider(
		"Glades",
		"0 spreads the trees evenly, 1 leaves glades between thickets.",
		Vector3(0.0, 1.0, 0.01),
		_trees.clumping,
		func(value: float) -> void: _trees.clumping = value
	)
	_panel.slider(
		"Individuals",
		"How many different trees there are; each is made of the scan's own branches.",
		Vector3(1, 24, 1),
		_trees.variants,
		func(value: float) -> void: _trees.variants = int(value)
	)
	_panel.slider(
		"Variation",
		"How far an individual is from the scan: 0 is the scan itself.",
		Vector3(0.0, 1.0, 0.01),
		_trees.amount,
		func(value: float) -> void: _trees.amount = value
	)
	_panel.slider(
		"Wind",
		"How hard it blows: 0 is calm, 1 a strong breeze.",
		Vector3(0.0, 2.0, 0.01),
		1.0,
		func(value: float) -> void:
			RenderingServer.global_shader_parameter_set(&"tree_wind_strength", value)
	)
	_panel.button(
		"Another forest", "The same numbers with another seed.", func() -> void: _trees.seed += 1
	)


func _make_hills() -> ArrayMesh:
	var tool: SurfaceTool = SurfaceTool.new()
	tool.begin(Mesh.PRIMITIVE_TRIANGLES)
	var count: int = int(_SIDE / _STEP) + 1
	for row: int in count:
		for column: int in count:
			var x: float = column * _STEP - 0.5 * _SIDE
			var z: float = row * _STEP - 0.5 * _SIDE
			tool.set_uv(Vector2(x, z) / 1200.0)
			tool.add_vertex(Vector3(x, height_at(x, z), z))
	for row: int in count - 1:
		for column: int in count - 1:
			var first: int = row * count + column
			for corner: int in [0, 1, count, 1, count + 1, count]:
				tool.add_index(first + corner)
	tool.generate_normals()
	return tool.commit()


static func _monitor(which: Performance.Monitor) -> int:
	return int(Performance.get_monitor(which))
