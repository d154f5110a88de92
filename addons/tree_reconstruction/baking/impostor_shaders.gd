@tool
extends RefCounted
## Materials that draw what an impostor keeps of a surface instead of its light.

## What a picture shows.
enum Pass { ALBEDO, NORMAL, DEPTH }

## Numbers that are no colors are drawn as this much and the rest of 1: some renderers know little
## of what is dark.
const LEAST: float = 0.3
# Goes to the end of fragment().
const _END: String = """
	// Of wood only this is kept of what lies in shade.
	float impostor_dim = mix(mix(1.0, AO, 0.7), 1.0, impostor_leaf);
	vec3 impostor_shown = ALBEDO * (OUTPUT_IS_SRGB ? pow(impostor_dim, 0.4545) : impostor_dim);
	if (impostor_pass == 1) {
		impostor_shown = 0.5 + 0.5 * normalize(mat3(INV_VIEW_MATRIX) * NORMAL);
	} else if (impostor_pass == 2) {
		impostor_shown = vec3(
				0.5 + 0.5 * (VERTEX.z + impostor_distance) / impostor_reach,
				impostor_leaf * (0.5 + 0.5 * AO), 0.0);
	}
	if (impostor_pass > 0) {
		impostor_shown = impostor_least + (1.0 - impostor_least) * clamp(impostor_shown, 0.0, 1.0);
		if (!OUTPUT_IS_SRGB) {
			// The picture is taken as if it were light.
			impostor_shown = mix(
					impostor_shown / 12.92,
					pow((impostor_shown + 0.055) / 1.055, vec3(2.4)),
					step(0.04045, impostor_shown));
		}
	}
	ALBEDO = impostor_shown;
"""
const _CUT: String = """
	if (ALPHA < ALPHA_SCISSOR_THRESHOLD) {
		discard;
	}
	ALPHA = 1.0;
"""
const _UNIFORMS: String = """
#define TREE_IMPOSTOR
uniform int impostor_pass = 0;
uniform float impostor_distance = 1.0;
uniform float impostor_reach = 1.0;
uniform float impostor_leaf = 0.0;
uniform float impostor_least = 0.3;
"""
const _STANDARD: String = """
shader_type spatial;
render_mode %s;
uniform sampler2D albedo_texture : source_color, hint_default_white, filter_linear_mipmap;
uniform vec4 albedo : source_color = vec4(1.0);
uniform vec2 uv_scale = vec2(1.0);
uniform vec2 uv_offset = vec2(0.0);
uniform float alpha_threshold = 0.0;
void vertex() {
	UV = UV * uv_scale + uv_offset;
}
void fragment() {
	vec4 color = albedo * texture(albedo_texture, UV);
	ALBEDO = color.rgb;
	ALPHA = color.a;
	ALPHA_SCISSOR_THRESHOLD = alpha_threshold;
}
"""


## Copies of [param material] for every [enum Pass], by their number. [param is_leaf] says whether
## light shines through it. The camera is [param distance] from the middle of the pictures, whose
## half width is [param reach], both in metres.
static func for_passes(
	material: Material, is_leaf: bool, distance: float, reach: float
) -> Array[Material]:
	var made: Array[Material] = []
	var shaded: ShaderMaterial = material as ShaderMaterial
	if shaded == null or shaded.shader == null:
		shaded = _of_standard(material as BaseMaterial3D)
	var shader: Shader = Shader.new()
	shader.code = changed(shaded.shader.code)
	for shown: int in Pass.values():
		var copy: ShaderMaterial = ShaderMaterial.new()
		copy.shader = shader
		for uniform: Dictionary in shaded.shader.get_shader_uniform_list():
			var value: Variant = shaded.get_shader_parameter(uniform.name)
			if value != null:
				copy.set_shader_parameter(uniform.name, value)
		copy.set_shader_parameter(&"impostor_pass", shown)
		copy.set_shader_parameter(&"impostor_distance", distance)
		copy.set_shader_parameter(&"impostor_reach", reach)
		copy.set_shader_parameter(&"impostor_leaf", 1.0 if is_leaf else 0.0)
		copy.set_shader_parameter(&"impostor_least", LEAST)
		made.append(copy)
	return made


## The code of a spatial shader that shows what the uniform [code]impostor_pass[/code] says, and no
## light.
static func changed(code: String) -> String:
	var plain: String = _without_comments(code)
	var type: RegExMatch = RegEx.create_from_string("shader_type\\s+spatial\\s*;").search(plain)
	if type == null:
		return plain
	var modes: RegExMatch = RegEx.create_from_string("render_mode\\s").search(plain)
	var begin: RegExMatch = (
		RegEx.create_from_string("void\\s+fragment\\s*\\(\\s*\\)\\s*\\{").search(plain)
	)
	if begin == null:
		plain += "\nvoid fragment() {\n}\n"
		begin = RegEx.create_from_string("void\\s+fragment\\s*\\(\\s*\\)\\s*\\{").search(plain)
	var end: int = _end_of_block(plain, begin.get_end())
	var cut: String = _CUT if "ALPHA_SCISSOR_THRESHOLD" in plain else ""
	plain = plain.insert(end, cut + _END)
	var unshaded: RegEx = RegEx.create_from_string("\\bunshaded\\b")
	if modes == null:
		return plain.insert(type.get_end(), "\nrender_mode unshaded;\n" + _UNIFORMS)
	var modes_end: int = plain.find(";", modes.get_end()) + 1
	plain = plain.insert(modes_end, _UNIFORMS)
	if unshaded.search(plain.substr(0, modes_end)) == null:
		plain = plain.insert(modes.get_end(), "unshaded, ")
	return plain


# Comments may hold braces and words of the language.
static func _without_comments(code: String) -> String:
	var comment: RegEx = RegEx.create_from_string("(?s)/\\*.*?\\*/|//[^\\n]*")
	return comment.sub(code, " ", true)


# Where the brace is that closes the block that begins before `from`.
static func _end_of_block(code: String, from: int) -> int:
	var depth: int = 1
	for at: int in range(from, code.length()):
		if code[at] == "{":
			depth += 1
		elif code[at] == "}":
			depth -= 1
			if depth == 0:
				return at
	return code.length()


# As much of an engine's material as is seen from far away; without any, of white paint.
static func _of_standard(material: BaseMaterial3D) -> ShaderMaterial:
	var made: ShaderMaterial = ShaderMaterial.new()
	made.shader = Shader.new()
	var culling: PackedStringArray = ["cull_back", "cull_front", "cull_disabled"]
	made.shader.code = _STANDARD % culling[material.cull_mode if material != null else 0]
	if material == null:
		return made
	if material.albedo_texture != null:
		made.set_shader_parameter(&"albedo_texture", material.albedo_texture)
	made.set_shader_parameter(&"albedo", material.albedo_color)
	var scale: Vector3 = material.uv1_scale
	var offset: Vector3 = material.uv1_offset
	made.set_shader_parameter(&"uv_scale", Vector2(scale.x, scale.y))
	made.set_shader_parameter(&"uv_offset", Vector2(offset.x, offset.y))
	var threshold: float = 0.0
	if material.transparency == BaseMaterial3D.TRANSPARENCY_ALPHA_SCISSOR:
		threshold = material.alpha_scissor_threshold
	elif material.transparency != BaseMaterial3D.TRANSPARENCY_DISABLED:
		threshold = 0.5
	made.set_shader_parameter(&"alpha_threshold", threshold)
	return made
