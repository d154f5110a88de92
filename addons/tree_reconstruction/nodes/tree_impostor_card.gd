@tool
extends MeshInstance3D
## The card of a [TreeInstance3D]'s impostor, beyond its last level of detail.

const Looks := preload("tree_looks.gd")
const OwnMaterials := preload("own_materials.gd")
const _SEASON_PARAMETERS: Array[StringName] = [&"season_early", &"season_late"]


## Shows the impostor of [param tree], in the box of its levels, so that distances are measured from
## the same place.
func show_for(tree: TreeInstance3D) -> void:
	var card: ArrayMesh = tree.impostor.get_mesh()
	if mesh != card:
		mesh = card
		# Where the levels' materials are.
		material_override = tree.impostor.material
	OwnMaterials.give(self, material_override)
	custom_aabb = tree.mesh.custom_aabb
	extra_cull_margin = Looks.get_reach(tree)
	_set_value(&"tree_height", tree.get_tree_height())
	_set_value(&"tree_wind", 1.0 if tree.wind else 0.0)
	var tints: PackedColorArray = [Color(1.0, 1.0, 1.0, 0.0), Color(1.0, 1.0, 1.0, 0.0)]
	if tree.reconstruction != null and tree.reconstruction.leaf_rule != null:
		tints = tree.reconstruction.leaf_rule.get_season_tints()
	for i: int in 2:
		# Colors would be converted by some renderers and not by others.
		var tint: Color = tints[i].srgb_to_linear()
		_set_value(_SEASON_PARAMETERS[i], Vector4(tint.r, tint.g, tint.b, tint.a))


func _set_value(name: StringName, value: Variant) -> void:
	OwnMaterials.tell(self, name, value)
