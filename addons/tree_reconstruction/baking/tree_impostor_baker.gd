@tool
class_name TreeImpostorBaker
extends RefCounted
## Takes the pictures of a [TreeImpostor]. It needs a renderer, so not [code]--headless[/code], and
## goes on over many frames, one view in each.
##
## [codeblock]
## var baker := TreeImpostorBaker.new()
## var impostor: TreeImpostor = await baker.bake(tree)
## if impostor == null:
##     print(baker.get_error_message())
## else:
##     ResourceSaver.save(impostor, "res://trees/oak.impostor.res", ResourceSaver.FLAG_COMPRESS)
## [/codeblock]

const Views := preload("impostor_views.gd")
const Shaders := preload("impostor_shaders.gd")
const _SHADER: String = "res://addons/tree_reconstruction/shaders/impostor.gdshader"
const _FILL: String = "res://addons/tree_reconstruction/shaders/impostor_fill.gdshader"
# Pictures are taken so many times as large as they are kept.
const _SAMPLES: int = 2
# How much wider than the tree a picture is, so that smaller mipmaps don't show its neighbours.
const _ROOM: float = 1.06
# The parts of the work, of 1.
const _BUILT: float = 0.1
const _TAKEN: float = 0.8
# What the card takes over from the material of the leaves.
const _TAKEN_OVER: Array[StringName] = [
	&"transmission", &"roughness", &"wind_strength", &"wind_direction", &"wind_speed"
]

## The width of the pictures together, in pixels: 512 to 8192.
var resolution: int = 2048:
	set(value):
		resolution = clampi(value, 512, 8192)

## How many views are in a row; there are as many rows.
var views: int = 12:
	set(value):
		views = clampi(value, 3, 32)

## Whether there are views from below, too, as for a tree on a cliff. They leave fewer for the rest.
var full_sphere: bool = false

## Whether the tree bears its leaves.
var leaves: bool = true

## The bark's material; without one, that of the tree's leaf preset.
var bark_material: Material

## The leaves' material; without one, that of the tree's leaf preset.
var leaf_material: Material

var _progress: float = 0.0
var _stage: String = ""
var _error: String = ""
var _cancelled: bool = false
var _busy: bool = false
var _draws: int = 0
var _center: Vector3
var _radius: float


## Takes the pictures. Returns [code]null[/code] where it was cancelled or could not, which [method
## get_error_message] explains. To be awaited.
func bake(tree: TreeReconstruction) -> TreeImpostor:
	_error = _obstacle(tree)
	if not _error.is_empty():
		return null
	_busy = true
	_cancelled = false
	_progress = 0.0
	RenderingServer.frame_post_draw.connect(_on_drawn)
	var made: TreeImpostor = await _bake(tree)
	RenderingServer.frame_post_draw.disconnect(_on_drawn)
	_busy = false
	return made


## Asks the bake to end soon.
func cancel() -> void:
	_cancelled = true


## How much of the work is done: 0 to 1.
func get_progress() -> float:
	return _progress


## What it is at, in a few words.
func get_stage() -> String:
	return _stage


## Why the last bake made nothing; empty when it was cancelled.
func get_error_message() -> String:
	return _error


func _obstacle(tree: TreeReconstruction) -> String:
	if _busy:
		return "This baker is at work already. Use another one, or wait."
	if tree == null or tree.is_empty():
		return "There is no tree to take pictures of."
	if DisplayServer.get_name() == "headless":
		return (
			"An impostor is made of pictures, and without a window (--headless) nothing is drawn."
			+ " Run this with a window, or, without a screen, by xvfb-run."
		)
	return ""


func _on_drawn() -> void:
	_draws += 1


func _bake(tree: TreeReconstruction) -> TreeImpostor:
	_stage = "building the tree"
	var baker: TreeBaker = TreeBaker.new()
	baker.levels = 1
	baker.leaves = leaves
	baker.wind = false
	baker.collision = false
	baker.bark_material = bark_material
	baker.leaf_material = leaf_material
	baker.load_materials(tree)
	var parts: TreeBaker.Parts = await _threaded(_build.bind(baker, tree)) as TreeBaker.Parts
	if parts == null or _cancelled:
		return null
	_progress = _BUILT
	_stage = "taking pictures"
	var mesh: ArrayMesh = baker.make_meshes(tree, parts)[0]
	var taken: Array[Image] = await _take(mesh, TreeBaker.get_other_leaves(parts))
	if taken.is_empty():
		return null
	_stage = "filling the pictures"
	var mipmapped: Callable = func() -> bool:
		for image: Image in taken:
			image.generate_mipmaps()
		return true
	await _threaded(mipmapped)
	var textures: Array[Texture2D] = await _fill(taken)
	if textures.is_empty():
		return null
	_progress = 1.0
	return _assemble(tree, parts, mesh, textures)


func _build(baker: TreeBaker, tree: TreeReconstruction) -> TreeBaker.Parts:
	var parts: TreeBaker.Parts = baker.build(tree, func() -> bool: return _cancelled)
	if parts == null:
		return null
	_center = parts.box.get_center()
	_radius = 0.01
	for arrays: Array in parts.bark + TreeBaker.joined_leaves(parts):
		if arrays.is_empty():
			continue
		for place: Vector3 in arrays[Mesh.ARRAY_VERTEX] as PackedVector3Array:
			_radius = maxf(_radius, _center.distance_squared_to(place))
	_radius = sqrt(_radius)
	return parts


# Takes all views: color, normals and depth, each as one picture, not filled yet.
func _take(mesh: ArrayMesh, others: PackedStringArray) -> Array[Image]:
	var reach: float = _radius * _ROOM
	var each: int = maxi(resolution / views / 4, 2) * 4
	var stage: Stage = Stage.new(mesh, others, each * _SAMPLES, reach)
	_root().add_child(stage.viewports[0])
	for i: int in range(1, stage.viewports.size()):
		stage.viewports[i].world_3d = stage.viewports[0].find_world_3d()
		_root().add_child(stage.viewports[i])
	var taken: Array[Image] = []
	for shown: int in Shaders.Pass.values():
		taken.append(Image.create_empty(each * views, each * views, false, Image.FORMAT_RGBA8))
	# The first frame may be one without its shaders.
	stage.look_from(Vector3.UP, _center)
	var going_on: bool = await _drawn()
	for view: int in views * views:
		if not going_on:
			break
		@warning_ignore("integer_division")
		var cell: Vector2i = Vector2i(view % views, view / views)
		stage.look_from(Views.direction(cell.x, cell.y, views, full_sphere), _center)
		going_on = await _drawn()
		if going_on:
			for shown: int in taken.size():
				var picture: Image = stage.viewports[shown].get_texture().get_image()
				picture.convert(Image.FORMAT_RGBA8)
				for halving: int in _SAMPLES / 2:
					picture.shrink_x2()
				taken[shown].blit_rect(picture, Rect2i(0, 0, each, each), each * cell)
		_progress = lerpf(_BUILT, _TAKEN, (view + 1.0) / (views * views))
	stage.free_all()
	return taken if going_on else ([] as Array[Image])


# The textures of impostor.gdshader, of what was taken.
func _fill(taken: Array[Image]) -> Array[Texture2D]:
	var sources: Array[ImageTexture] = []
	for image: Image in taken:
		sources.append(ImageTexture.create_from_image(image))
	var formats: Array[Image.Format] = [Image.FORMAT_RGBA8, Image.FORMAT_RGBA8, Image.FORMAT_R8]
	var viewport: SubViewport = SubViewport.new()
	viewport.size = taken[0].get_size()
	viewport.transparent_bg = true
	viewport.disable_3d = true
	var sheet: ColorRect = ColorRect.new()
	sheet.size = viewport.size
	var material: ShaderMaterial = ShaderMaterial.new()
	material.shader = load(_FILL)
	material.set_shader_parameter(&"taken_depth", sources[Shaders.Pass.DEPTH])
	material.set_shader_parameter(&"least", Shaders.LEAST)
	sheet.material = material
	viewport.add_child(sheet)
	_root().add_child(viewport)
	var made: Array[Texture2D] = []
	for kind: int in formats.size():
		material.set_shader_parameter(&"taken", sources[mini(kind, 1)])
		material.set_shader_parameter(&"kind", kind)
		viewport.render_target_update_mode = SubViewport.UPDATE_ONCE
		if not await _drawn():
			break
		var image: Image = viewport.get_texture().get_image()
		image.convert(formats[kind])
		_stage = "packing the pictures"
		made.append(await _on_own_thread(_packed.bind(image)) as Texture2D)
		_progress = lerpf(_TAKEN, 1.0, (kind + 1.0) / formats.size())
	viewport.queue_free()
	return ([] as Array[Texture2D]) if _cancelled else made


static func _packed(image: Image) -> Texture2D:
	image.generate_mipmaps()
	var made: PortableCompressedTexture2D = PortableCompressedTexture2D.new()
	made.keep_compressed_buffer = true
	made.create_from_image(image, PortableCompressedTexture2D.COMPRESSION_MODE_S3TC)
	return made


func _assemble(
	tree: TreeReconstruction, parts: TreeBaker.Parts, mesh: ArrayMesh, textures: Array[Texture2D]
) -> TreeImpostor:
	var material: ShaderMaterial = ShaderMaterial.new()
	material.shader = load(_SHADER)
	material.set_shader_parameter(&"albedo_texture", textures[0])
	material.set_shader_parameter(&"normal_texture", textures[1])
	material.set_shader_parameter(&"depth_texture", textures[2])
	material.set_shader_parameter(&"views", float(views))
	material.set_shader_parameter(&"full_sphere", full_sphere)
	material.set_shader_parameter(&"center", _center)
	material.set_shader_parameter(&"reach", _radius * _ROOM)
	material.set_shader_parameter(&"extents", 0.5 * parts.box.size)
	# The tree's own leaves, unless it has none.
	var surface: int = mesh.get_surface_count() - 1
	for i: int in mesh.get_surface_count():
		if mesh.surface_get_name(i) == "leaves":
			surface = i
	var leaf: ShaderMaterial = mesh.surface_get_material(surface) as ShaderMaterial
	if leaf != null:
		for name: StringName in _TAKEN_OVER:
			var value: Variant = leaf.get_shader_parameter(name)
			if value != null:
				material.set_shader_parameter(name, value)
	var made: TreeImpostor = TreeImpostor.new()
	made.resource_name = tree.resource_name
	made.material = material
	made.box = parts.box
	made.height = maxf(parts.height, 0.1)
	made.fingerprint = TreeImpostor.fingerprint_of(tree)
	return made


# Waits until a frame was drawn. Returns false when it was cancelled.
func _drawn() -> bool:
	var before: int = _draws
	while _draws == before and not _cancelled:
		await _main_loop().process_frame
	return not _cancelled


# What `work` returns on a worker thread, while frames go on.
func _threaded(work: Callable) -> Variant:
	var result: Array = [null]
	var task: int = WorkerThreadPool.add_task(
		func() -> void: result[0] = work.call(), false, "Bake an impostor"
	)
	while not WorkerThreadPool.is_task_completed(task):
		await _main_loop().process_frame
	WorkerThreadPool.wait_for_task_completion(task)
	return result[0]


# The same on a thread of its own. With Vulkan the engine's compressor of pictures is a task of the
# pool that takes up others while it waits, so a task of the pool that compresses may wait for what
# is below it on the same thread, for ever.
func _on_own_thread(work: Callable) -> Variant:
	var thread: Thread = Thread.new()
	var error: Error = thread.start(work)
	if error != OK:
		return work.call()
	while thread.is_alive():
		await _main_loop().process_frame
	return thread.wait_to_finish()


static func _main_loop() -> SceneTree:
	return Engine.get_main_loop() as SceneTree


static func _root() -> Window:
	return _main_loop().root


# A world with the tree in it once for each pass, and a camera for each.
class Stage:
	extends RefCounted

	var viewports: Array[SubViewport] = []

	var _cameras: Array[Camera3D] = []
	var _distance: float

	# others: surfaces of leaves that the card doesn't lead through the season: they are kept as it
	# has turned them, like wood.
	func _init(mesh: ArrayMesh, others: PackedStringArray, size: int, reach: float) -> void:
		_distance = 1.5 * reach
		var environment: Environment = Environment.new()
		environment.background_mode = Environment.BG_COLOR
		environment.background_color = Color.BLACK
		environment.ambient_light_source = Environment.AMBIENT_SOURCE_DISABLED
		environment.reflected_light_source = Environment.REFLECTION_SOURCE_DISABLED
		environment.tonemap_mode = Environment.TONE_MAPPER_LINEAR
		var copies: Array[MeshInstance3D] = []
		for shown: int in Shaders.Pass.values():
			var viewport: SubViewport = SubViewport.new()
			viewport.size = Vector2i(size, size)
			viewport.transparent_bg = true
			viewport.own_world_3d = shown == 0
			viewport.render_target_update_mode = SubViewport.UPDATE_DISABLED
			viewport.mesh_lod_threshold = 0.0
			var camera: Camera3D = Camera3D.new()
			camera.projection = Camera3D.PROJECTION_ORTHOGONAL
			camera.size = 2.0 * reach
			camera.near = 0.25 * reach
			camera.far = 3.0 * reach
			camera.cull_mask = 1 << shown
			camera.environment = environment
			viewport.add_child(camera)
			viewports.append(viewport)
			_cameras.append(camera)
			var copy: MeshInstance3D = MeshInstance3D.new()
			copy.mesh = mesh
			copy.layers = 1 << shown
			copies.append(copy)
			viewports[0].add_child(copy)
		for surface: int in mesh.get_surface_count():
			var name: String = mesh.surface_get_name(surface)
			var each: Array[Material] = Shaders.for_passes(
				mesh.surface_get_material(surface),
				name.begins_with("leaves") and not name in others,
				_distance,
				reach
			)
			for shown: int in copies.size():
				if not name in others:
					_set_neutral(each[shown] as ShaderMaterial)
				copies[shown].set_surface_override_material(surface, each[shown])

	func look_from(way: Vector3, center: Vector3) -> void:
		for i: int in viewports.size():
			_cameras[i].transform = Transform3D(Views.axes(way), center + _distance * way)
			_cameras[i].make_current()
			viewports[i].render_target_update_mode = SubViewport.UPDATE_ONCE

	func free_all() -> void:
		for viewport: SubViewport in viewports:
			viewport.queue_free()

	# The card takes the season's colors on by itself.
	static func _set_neutral(material: ShaderMaterial) -> void:
		for name: StringName in [&"season_early", &"season_late"]:
			if material.get_shader_parameter(name) != null:
				material.set_shader_parameter(name, Vector4(1.0, 1.0, 1.0, 0.0))
