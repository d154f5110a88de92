@tool
extends RefCounted
## Colours trees by what their shaders read of them: see TreeWind.show_channel(). In the rendering
## server alone, so that no scene knows of it.

const OwnMaterials := preload("own_materials.gd")
const _SHADER: String = "res://addons/tree_reconstruction/shaders/tree_channels.gdshader"

# By the channel, and whether for leaves.
static var _materials: Dictionary[Vector2i, ShaderMaterial] = {}


## Shows it of `instance` and of what is drawn below it; 0 shows them as they are.
static func show(instance: GeometryInstance3D, channel: int) -> void:
	if channel > 0:
		OwnMaterials.lend(instance, _material(channel, instance is MultiMeshInstance3D))
	else:
		OwnMaterials.restore(instance)
	for child: Node in instance.get_children(true):
		if child is GeometryInstance3D:
			show(child as GeometryInstance3D, channel)


static func _material(channel: int, leaves: bool) -> ShaderMaterial:
	var key: Vector2i = Vector2i(channel, 1 if leaves else 0)
	if not _materials.has(key):
		var material: ShaderMaterial = ShaderMaterial.new()
		material.shader = load(_SHADER) as Shader
		material.set_shader_parameter(&"channel", channel)
		material.set_shader_parameter(&"leaf", leaves)
		_materials[key] = material
	return _materials[key]
