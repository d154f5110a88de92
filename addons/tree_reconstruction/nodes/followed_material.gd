@tool
extends RefCounted
## A material that copies in the rendering server follow: whatever a script or the inspector sets in
## it is set in them before the next frame is drawn.

# What shaders have per tree.
const _PER_TREE: PackedStringArray = [
	"tree_height", "tree_wind", "tree_origin", "tree_levels", "season_early", "season_late"
]
# Makes plain uniforms of them.
const _DEFINE: String = "\n#define TREE_OWN\n"

# By the ids of the materials, while there are copies.
static var _all: Dictionary[int, RefCounted] = {}
# By the ids of the shaders that were changed for copies; they go when the last material does.
static var _shaders: Dictionary[int, WeakRef] = {}

var _source: ShaderMaterial
var _source_shader: Shader
var _source_code: String
var _shader: Shader
var _copies: Dictionary[RID, bool] = {}
var _values: Dictionary[StringName, Variant] = {}
var _next_pass: Material
var _priority: int = 0


## The one that follows [param material]; [code]null[/code] where the material takes nothing per
## tree, and so needs no copies.
static func of(material: ShaderMaterial) -> RefCounted:
	if material == null or material.shader == null:
		return null
	var id: int = material.get_instance_id()
	if not _all.has(id):
		var shader: Shader = _shader_of(material.shader)
		if shader == null:
			return null
		var made: RefCounted = new()
		made._source = material
		made._take_shader(shader)
		_all[id] = made
		if _all.size() == 1:
			RenderingServer.frame_pre_draw.connect(_look_at_all)
	return _all[id]


## Lets a copy follow.
func join(copy: RID) -> void:
	_copies[copy] = true
	_fill(copy)


## Lets a copy go.
func leave(copy: RID) -> void:
	_copies.erase(copy)
	if not _copies.is_empty():
		return
	_listen(null)
	_all.erase(_source.get_instance_id())
	if _all.is_empty():
		RenderingServer.frame_pre_draw.disconnect(_look_at_all)
		_shaders.clear()


static func _look_at_all() -> void:
	for followed: RefCounted in _all.values():
		followed._look()


func _look() -> void:
	if _source.shader != _source_shader:
		var shader: Shader = _shader_of(_source.shader) if _source.shader != null else null
		# One that takes nothing per tree is drawn as it is.
		_take_shader(_source.shader if shader == null else shader)
		for copy: RID in _copies:
			_fill(copy)
	for name: StringName in _values:
		var value: Variant = _source.get_shader_parameter(name)
		if is_same(value, _values[name]):
			continue
		_values[name] = value
		for copy: RID in _copies:
			RenderingServer.material_set_param(copy, name, _in_server(value))
	if _source.next_pass != _next_pass or _source.render_priority != _priority:
		_next_pass = _source.next_pass
		_priority = _source.render_priority
		for copy: RID in _copies:
			_fill(copy)


func _take_shader(shader: Shader) -> void:
	_listen(_source.shader)
	_shader = shader
	_next_pass = _source.next_pass
	_priority = _source.render_priority
	_values.clear()
	if shader == null:
		return
	for uniform: Dictionary in shader.get_shader_uniform_list():
		if not uniform.name in _PER_TREE:
			_values[StringName(uniform.name)] = _source.get_shader_parameter(uniform.name)


func _listen(shader: Shader) -> void:
	if _source_shader != null:
		_source_shader.changed.disconnect(_on_shader_changed)
	_source_shader = shader
	if shader != null:
		_source_code = shader.code
		shader.changed.connect(_on_shader_changed)


# Somebody edits it.
func _on_shader_changed() -> void:
	if _source_shader.code == _source_code:
		return
	if _shader != _source_shader:
		_shader.code = _code_of(_source_shader)
	_take_shader(_shader)
	for copy: RID in _copies:
		_fill(copy)


func _fill(copy: RID) -> void:
	var server: Object = RenderingServer
	server.material_set_shader(copy, RID() if _shader == null else _shader.get_rid())
	for name: StringName in _values:
		server.material_set_param(copy, name, _in_server(_values[name]))
	server.material_set_render_priority(copy, _priority)
	server.material_set_next_pass(copy, RID() if _next_pass == null else _next_pass.get_rid())


static func _in_server(value: Variant) -> Variant:
	return (value as Texture).get_rid() if value is Texture else value


# The shader with plain uniforms; null for one that takes nothing per tree.
static func _shader_of(shader: Shader) -> Shader:
	var id: int = shader.get_instance_id()
	var known: Shader = _shaders[id].get_ref() as Shader if _shaders.has(id) else null
	if known != null:
		return known
	if not "#include" in shader.code:
		return null
	var made: Shader = Shader.new()
	made.code = _code_of(shader)
	var names: PackedStringArray = _names_of(shader)
	for name: String in _names_of(made):
		if name in _PER_TREE and not name in names:
			_shaders[id] = weakref(made)
			return made
	return null


static func _names_of(shader: Shader) -> PackedStringArray:
	var names: PackedStringArray = []
	for uniform: Dictionary in shader.get_shader_uniform_list():
		names.append(uniform.name)
	return names


static func _code_of(shader: Shader) -> String:
	# It has no path that its includes could be beside.
	var include: RegEx = RegEx.create_from_string('#include\\s+"(?!res://)([^"]+)"')
	var folder: String = shader.resource_path.get_base_dir()
	var code: String = include.sub(shader.code, '#include "%s/$1"' % folder, true)
	var found: RegExMatch = RegEx.create_from_string("shader_type\\s+\\w+\\s*;").search(code)
	if found == null:
		return code
	return code.left(found.get_end()) + _DEFINE + code.substr(found.get_end())
