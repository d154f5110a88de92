@tool
extends MeshInstance3D
## Erases what of a tree's foot is in the ground. A photo shows the ground that hides it, but has no
## depth to do so.

const ERASER: Shader = preload("buried_foot.gdshader")
## Of the 3D layers, one that no camera of the editor sees: neither a scene's nor a gizmo's.
const LAYER: int = 1 << 21
# How wide and how deep a foot is, as above_ground.cpp and root_flare.cpp have it: radii of the
# root, and metres that a trunk goes on at most.
const _RADII: float = 6.0
const _DEPTH: float = 2.0


func _init() -> void:
	var box: BoxMesh = BoxMesh.new()
	box.size = Vector3(2.0, 1.0, 2.0)
	var eraser: ShaderMaterial = ShaderMaterial.new()
	eraser.shader = ERASER
	box.material = eraser
	mesh = box
	layers = LAYER
	cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	visible = false


## Goes where the foot of [param node] is. To be called once a frame: trees are edited and moved.
func follow(node: TreeInstance3D) -> void:
	visible = _has_foot(node)
	if not visible:
		return
	var tree: TreeReconstruction = node.reconstruction
	var width: float = _RADII * tree.get_node_radius(tree.get_root())
	var depth: float = maxf(_DEPTH, width)
	var place: Vector3 = tree.get_node_position(tree.get_root())
	var scaled: Basis = Basis.from_scale(Vector3(width, depth, width))
	var wanted: Transform3D = node.global_transform * Transform3D(scaled, place)
	# The editor would draw for one that is no other, too.
	if wanted != global_transform:
		global_transform = wanted


static func _has_foot(node: TreeInstance3D) -> bool:
	if not is_instance_valid(node) or not node.is_visible_in_tree():
		return false
	var tree: TreeReconstruction = node.reconstruction
	return tree != null and not tree.is_empty() and tree.is_trunk(tree.get_root())
