extends RefCounted
## Posts and wires of a recipe of growth, as pictures of trunks show them.

const Recipe := preload("res://addons/tree_reconstruction/editor/dock/growth_recipe.gd")


## A post along its branch, or a wire across it, unless the line has a direction.
## [param place]: what [method TreeReconstructor.find_bark] tells of it.
static func make(line: Recipe.Line, place: Dictionary) -> MeshInstance3D:
	var wire: bool = line.values["shape"] == "wire"
	var shape: CylinderMesh = CylinderMesh.new()
	shape.top_radius = (
		0.5 * float(line.values.get("thickness", "0.004")) if wire else float(line.values["radius"])
	)
	shape.bottom_radius = shape.top_radius
	shape.height = float(line.values["length"])
	var look: StandardMaterial3D = StandardMaterial3D.new()
	look.albedo_color = Color(0.32, 0.31, 0.3) if wire else Color(0.42, 0.36, 0.29)
	look.roughness = 0.9
	shape.material = look
	var thing: MeshInstance3D = MeshInstance3D.new()
	thing.mesh = shape
	var up: Vector3 = Vector3.UP
	if wire:
		up = (place.direction as Vector3).cross(place.out as Vector3)
	if line.values.has("direction"):
		var way: PackedFloat64Array = line.values["direction"].split_floats(",")
		up = Vector3(way[0], way[1], way[2])
	var gap: float = float(line.values.get("gap", "0"))
	thing.basis = Basis(Quaternion(Vector3.UP, up.normalized()))
	thing.position = place.axis + place.out * (place.radius + gap)
	return thing
