@tool
extends RefCounted
## Materials for whole trees in a multimesh: what a [TreeInstance3D] sets for its instance is in
## them, what differs from tree to tree comes with the multimesh.

const _ADDON: String = "res://addons/tree_reconstruction/"
const LeafKinds := preload("../leaf_kinds.gd")
const _DEFINES: String = "\n#define TREE_BAKED\n#define TREE_WIND_GLOBALS\n"

# By their paths; they go when the last material does.
static var _shaders: Dictionary[String, WeakRef] = {}
# The names of their uniforms, likewise.
static var _uniforms: Dictionary[String, Array] = {}


## A copy of [param material] for whole trees with [param values]. A material that has no shader of
## the addon's is returned as it is.
static func for_trees(material: Material, values: Dictionary[StringName, Variant]) -> Material:
	if not _is_ours(material):
		return material
	var shaded: ShaderMaterial = material as ShaderMaterial
	var made: ShaderMaterial = ShaderMaterial.new()
	made.shader = _shader_of(shaded.shader)
	made.render_priority = shaded.render_priority
	for name: StringName in _uniforms[shaded.shader.resource_path]:
		var value: Variant = shaded.get_shader_parameter(name)
		if value != null:
			made.set_shader_parameter(name, value)
	for name: StringName in values:
		made.set_shader_parameter(name, values[name])
	return made


## The shader that [method for_trees] gives a copy of [param material], made now unless something
## has it; [code]null[/code] where the copy is the material itself.
static func shader_for(material: Material) -> Shader:
	return _shader_of((material as ShaderMaterial).shader) if _is_ours(material) else null


## Whether the material's shader is the addon's, which shows each tree of a multimesh at its own
## level of detail.
static func knows_levels(material: Material) -> bool:
	return (
		_is_ours(material) and (material as ShaderMaterial).shader.code.contains("tree_levels_gone")
	)


## Sets [param values] in what [method for_trees] made, unless it is the material itself.
static func set_values(made: Material, values: Dictionary[StringName, Variant]) -> void:
	var shaded: ShaderMaterial = made as ShaderMaterial
	# Those that it made are of no file, and so are their shaders.
	if shaded == null or shaded.shader == null or not shaded.shader.code.contains(_DEFINES):
		return
	for name: StringName in values:
		shaded.set_shader_parameter(name, values[name])


## Whether the material's shader is the addon's, which lets leaves turn, fall and unfold.
static func knows_seasons(material: Material) -> bool:
	return (
		_is_ours(material) and (material as ShaderMaterial).shader.code.contains("season_standing")
	)


static func _is_ours(material: Material) -> bool:
	var shaded: ShaderMaterial = material as ShaderMaterial
	return (
		shaded != null and shaded.shader != null and shaded.shader.resource_path.begins_with(_ADDON)
	)


static func _shader_of(shader: Shader) -> Shader:
	var path: String = shader.resource_path
	var known: Shader = null
	if _shaders.has(path):
		known = _shaders[path].get_ref() as Shader
	if known == null:
		known = Shader.new()
		known.code = _code_of(shader)
		_shaders[path] = weakref(known)
		var names: Array = []
		for uniform: Dictionary in shader.get_shader_uniform_list():
			names.append(StringName(uniform.name))
		_uniforms[path] = names
	return known


static func _code_of(shader: Shader) -> String:
	# It has no path that its includes could be beside.
	var include: RegEx = RegEx.create_from_string('#include\\s+"(?!res://)([^"]+)"')
	var folder: String = shader.resource_path.get_base_dir()
	var code: String = include.sub(shader.code, '#include "%s/$1"' % folder, true)
	var type: RegEx = RegEx.create_from_string("shader_type\\s+\\w+\\s*;")
	var end: int = type.search(code).get_end()
	return code.left(end) + _DEFINES + code.substr(end)
