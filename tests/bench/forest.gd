extends SceneTree
## What forests cost, as ./dev bench --forest prints it: TreeVariantSpawner3D beside scene copies of
## TreeInstance3D, drawn by the Compatibility renderer. Arguments: a scan or a saved tree, else a
## birch that a grammar grows; numbers of trees, else 400 and 10000; --brief for fewer copies.

const VIEW: Vector2i = Vector2i(480, 270)
const DENSITY: float = 2.0
const FRAMES: int = 4
# Copies are added until they have taken so long; the other is for --brief.
const PATIENCE_MS: int = 40_000
const LITTLE_PATIENCE_MS: int = 8_000
const MEGABYTE: float = 1_000_000.0

var _source: TreeReconstruction
var _viewport: SubViewport
var _before: float = 0.0
var _worst: float = 0.0
# What it takes to ask for the time.
var _asking: float = INF
var _patience: int = PATIENCE_MS


## Says when the frame's scripts begin or end.
class Bell:
	extends Node
	var rings: Callable

	func _process(_delta: float) -> void:
		rings.call()


func _initialize() -> void:
	_run.call_deferred()


func _run() -> void:
	var counts: PackedInt32Array = []
	for argument: String in OS.get_cmdline_user_args():
		if argument == "--brief":
			_patience = LITTLE_PATIENCE_MS
		elif argument.is_valid_int():
			counts.append(int(argument))
		else:
			_source = _read(argument)
	if counts.is_empty():
		counts = [400, 10_000]
	if _source == null:
		var system: LSystem = LSystem.new()
		system.grammar = LSystem.get_preset("birch")
		_source = system.grow(7)
		_source.leaf_rule = LeafRule.from_preset("birch")
	print(
		(
			"The tree: %d nodes, %.1f m.\n" % [_source.get_node_count(), _source.get_aabb().end.y]
			+ "| trees | how | ready s | worst script ms | walking ms | draw calls | thousand triangles"
			+ " | frame CPU ms | MB of memory | MB of graphics |\n|---|---|---|---|---|---|---|---|---|---|"
		)
	)
	for i: int in 100:
		var began: float = _spent()
		_asking = minf(_asking, _spent() - began)
	for count: int in counts:
		await _measure(count, true)
		await _measure(count, false)
	quit()


func _read(path: String) -> TreeReconstruction:
	if path.get_extension() in ["res", "tres"]:
		return load(path) as TreeReconstruction
	var made: TreeReconstruction = TreeReconstructor.new().reconstruct_file(path, {})
	made.leaf_rule = LeafRule.from_preset("oak")
	return made


func _measure(count: int, spawner: bool) -> void:
	_begin(count)
	var memory: float = Performance.get_monitor(Performance.MEMORY_STATIC)
	var graphics: float = Performance.get_monitor(Performance.RENDER_VIDEO_MEM_USED)
	var began: int = Time.get_ticks_msec()
	var planted: int = count
	var walking: String = ""
	var ready: float = 0.0
	if spawner:
		var forest: TreeVariantSpawner3D = TreeVariantSpawner3D.new()
		forest.source = _source
		forest.region_size = Vector2.ONE * _side(count)
		forest.density = DENSITY
		forest.minimum_distance = 3.0
		forest.clumping = 0.0
		forest.view_distance = 400.0
		_viewport.add_child(forest)
		await forest.finished
		planted = forest.get_tree_count()
		ready = (Time.get_ticks_msec() - began) / 1000.0
		await process_frame
		var worst: float = _worst
		# From the edge to the middle, and back for the picture.
		var camera: Camera3D = _viewport.get_camera_3d()
		var place: Vector3 = camera.position
		_worst = 0.0
		for step: int in 8:
			camera.position.z -= 0.04 * _side(count)
			await process_frame
		walking = "%.2f" % _worst
		camera.position = place
		_worst = worst
		while not forest._forest._cells.is_done():
			await process_frame
	else:
		planted = await _copies(count)
		ready = (Time.get_ticks_msec() - began) / 1000.0
	var drawn: PackedStringArray = await _draw()
	print(
		(
			"| %d | %s | %.1f | %.2f | %s | %s | %.0f | %.0f |"
			% [
				planted,
				"spawner" if spawner else "copies",
				ready,
				_worst,
				walking,
				" | ".join(drawn),
				(Performance.get_monitor(Performance.MEMORY_STATIC) - memory) / MEGABYTE,
				(Performance.get_monitor(Performance.RENDER_VIDEO_MEM_USED) - graphics) / MEGABYTE
			]
		)
	)
	_viewport.queue_free()
	await process_frame
	await process_frame


static func _side(count: int) -> float:
	return sqrt(100.0 * count / DENSITY)


func _begin(count: int) -> void:
	_viewport = SubViewport.new()
	_viewport.size = VIEW
	_viewport.own_world_3d = true
	_viewport.render_target_update_mode = SubViewport.UPDATE_DISABLED
	root.add_child(_viewport)
	var camera: Camera3D = Camera3D.new()
	camera.far = 1000.0
	camera.position = Vector3(0.0, 2.0, 0.5 * _side(count))
	_viewport.add_child(camera)
	_viewport.add_child(DirectionalLight3D.new())
	for end: int in 2:
		var bell: Bell = Bell.new()
		bell.process_priority = -1000 + 2000 * end
		bell.rings = _start_clock if end == 0 else _stop_clock
		_viewport.add_child(bell)
	_worst = 0.0


# As many as there is patience for.
func _copies(count: int) -> int:
	var began: int = Time.get_ticks_msec()
	var random: RandomNumberGenerator = RandomNumberGenerator.new()
	random.seed = 1
	var side: float = _side(count)
	for i: int in count:
		var one: TreeInstance3D = TreeInstance3D.new()
		one.reconstruction = _source
		one.position = Vector3(random.randf() - 0.5, 0.0, random.randf() - 0.5) * side
		_viewport.add_child(one)
		await process_frame
		while one.is_rebuilding():
			await process_frame
		if Time.get_ticks_msec() - began > _patience:
			return i + 1
	return count


# Draw calls, triangles and the processor's time of a frame.
func _draw() -> PackedStringArray:
	_viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	var id: RID = _viewport.get_viewport_rid()
	var least: float = INF
	await process_frame
	for frame: int in FRAMES:
		var began: float = _spent()
		await process_frame
		least = minf(least, _spent() - began)
	var kind: int = RenderingServer.VIEWPORT_RENDER_INFO_TYPE_VISIBLE
	var calls: int = RenderingServer.viewport_get_render_info(
		id, kind, RenderingServer.VIEWPORT_RENDER_INFO_DRAW_CALLS_IN_FRAME
	)
	var triangles: int = RenderingServer.viewport_get_render_info(
		id, kind, RenderingServer.VIEWPORT_RENDER_INFO_PRIMITIVES_IN_FRAME
	)
	return ["%d" % calls, "%.0f" % (triangles / 1000.0), "%.1f" % least]


func _start_clock() -> void:
	_before = _spent()


func _stop_clock() -> void:
	_worst = maxf(_worst, _spent() - _before - _asking)


# The milliseconds that this thread has had of a processor, where the system tells: what others do
# on a busy machine is not the forest's.
static func _spent() -> float:
	# To add the process's threads up, the system looks at each one's clock; else it would tell what
	# was at its last tick, some milliseconds ago.
	var whole: FileAccess = FileAccess.open("/proc/self/stat", FileAccess.READ)
	var file: FileAccess = FileAccess.open("/proc/thread-self/schedstat", FileAccess.READ)
	if whole == null or file == null:
		return Time.get_ticks_usec() / 1000.0
	whole.get_line()
	return float(file.get_line().get_slice(" ", 0)) / 1e6
