@tool
extends RefCounted
## Reads the materials of a forest's individuals and has the engine translate their shaders, a step
## per frame: a step is one picture or one shader, and may take some milliseconds. All of it is done
## on the main thread: one of the engine's would need it for the pictures, while it may wait for the
## same ones.

const Individual := preload("individual.gd")
const Materials := preload("materials.gd")
# Steps that find their work done already don't count: so long they go on, in microseconds.
const _SHORT: int = 300

var _plans: Array[Individual] = []
var _steps: Array[Callable] = []
# Whether the last step has read a file.
var _has_read: bool = false
# Kept until there is a material or an individual that has it.
var _kept: Array[Resource] = []
var _before: Array[Resource] = []
var _shaders: Dictionary[Material, bool] = {}


## Begins with the individuals that are to be built, and further materials that their trees have.
func start(plans: Array[Individual], others: Array[Material]) -> void:
	_plans = plans
	_steps = []
	_shaders = {}
	# What was kept for the forest before may be needed by this one.
	_before = _kept
	_kept = []
	var paths: Dictionary[String, bool] = {}
	for plan: Individual in plans:
		var needed: PackedStringArray = [plan.bark_path]
		for look: Individual.Look in plan.looks:
			needed.append(look.path)
		for path: String in needed:
			if not path.is_empty() and not paths.has(path):
				paths[path] = true
				_steps.append(_open.bind(path))
	for plan: Individual in plans:
		_steps.append(_give.bind(plan))
	for material: Material in others:
		_steps.append(_need_shader.bind(material))


## Begins with materials in files, for trees that are drawn with them as they are.
func start_paths(paths: PackedStringArray) -> void:
	_before = _kept
	_kept = []
	_plans = []
	_steps = []
	for path: String in paths:
		_steps.append(_open.bind(path))


## Goes on for a frame; returns whether the materials are there.
func poll_paths() -> bool:
	if _go_on():
		_before = []
		return true
	return false


## Drops what is under way.
func stop() -> void:
	_plans = []
	_steps = []


## Whether individuals wait for their materials.
func is_busy() -> bool:
	return not _plans.is_empty()


## Goes on for a frame; returns the individuals when they have their materials, else none.
func poll() -> Array[Individual]:
	if not _go_on():
		return []
	var done: Array[Individual] = _plans
	_plans = []
	_before = []
	return done


func _go_on() -> bool:
	var deadline: int = Time.get_ticks_usec() + _SHORT
	while not _steps.is_empty():
		var step: Callable = _steps.pop_front()
		_has_read = false
		step.call()
		if _has_read or Time.get_ticks_usec() >= deadline:
			return false
	return true


# What a material is made of comes first, one by one.
func _open(path: String) -> void:
	if ResourceLoader.has_cached(path):
		_kept.append(load(path))
		return
	var parts: Array[Callable] = []
	for listed: String in ResourceLoader.get_dependencies(path):
		# As 'UID::type::path', or the path alone.
		var part: String = listed.get_slice("::", listed.get_slice_count("::") - 1)
		parts.append(_read.bind(part))
	parts.append(_read.bind(path))
	_steps = parts + _steps


func _read(path: String) -> void:
	_has_read = not ResourceLoader.has_cached(path)
	var made: Resource = load(path)
	if made == null:
		return
	_kept.append(made)
	if made is Shader:
		_steps.push_front((made as Shader).get_rid)


func _give(plan: Individual) -> void:
	if not plan.bark_path.is_empty():
		plan.bark_material = load(plan.bark_path) as Material
	_need_shader(plan.bark_material)
	for look: Individual.Look in plan.looks:
		if not look.path.is_empty():
			look.material = load(look.path) as Material
		_need_shader(look.material)


func _need_shader(material: Material) -> void:
	if not _shaders.has(material):
		_shaders[material] = true
		_steps.append(_make_shader.bind(material))


# The engine translates it when it is first asked for.
func _make_shader(material: Material) -> void:
	var shader: Shader = Materials.shader_for(material)
	if shader != null:
		_kept.append(shader)
		_steps.push_front(shader.get_rid)
