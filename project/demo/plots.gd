extends RefCounted
## Meshes of what the preview shows besides the tree: clouds as beads, skeletons as lines and beads.

const POINTS: Shader = preload("./points.gdshader")
const LINES: Shader = preload("./lines.gdshader")

const LEAF: Color = Color("2f9e44")
const BRANCH: Color = Color("f08c00")
const TRUNK: Color = Color("d6262b")
const WOOD: Color = Color("8a8178")

const _LOW: Color = Color("2f4858")
const _MIDDLE: Color = Color("2a8f7f")
const _HIGH: Color = Color("d9a93f")


## A cloud in its own colours, or, where it has none, coloured by height.
static func cloud(points: PackedVector3Array, colors: PackedColorArray) -> ArrayMesh:
	if colors.size() != points.size():
		colors = _by_height(points)
	return _mesh(Mesh.PRIMITIVE_POINTS, points, colors)


## Every segment of a skeleton, coloured by the kind of its outer node or all alike.
static func segments(tree: TreeReconstruction, by_kind: bool) -> ArrayMesh:
	var positions: PackedVector3Array = tree.get_positions()
	var ids: PackedInt32Array = tree.get_node_ids()
	var parents: PackedInt32Array = tree.get_parents()
	var places: Dictionary[int, int] = {}
	for i: int in ids.size():
		places[ids[i]] = i
	var trunk: Dictionary[int, bool] = {}
	for id: int in tree.get_trunk_nodes() if by_kind else PackedInt32Array():
		trunk[id] = true
	var vertices: PackedVector3Array = PackedVector3Array()
	var normals: PackedVector3Array = PackedVector3Array()
	var colors: PackedColorArray = PackedColorArray()
	var sides: PackedVector2Array = PackedVector2Array()
	var indices: PackedInt32Array = PackedInt32Array()
	var left: Vector2 = Vector2(-1.0, 0.0)
	var right: Vector2 = Vector2(1.0, 0.0)
	for i: int in positions.size():
		if parents[i] == TreeReconstruction.NO_NODE:
			continue
		var from: Vector3 = positions[places[parents[i]]]
		var to: Vector3 = positions[i]
		var along: Vector3 = (to - from).normalized()
		if along == Vector3.ZERO:
			continue
		var color: Color = TRUNK if trunk.has(ids[i]) else WOOD
		var first: int = vertices.size()
		vertices.append(from)
		vertices.append(from)
		vertices.append(to)
		vertices.append(to)
		sides.append(left)
		sides.append(right)
		sides.append(left)
		sides.append(right)
		for corner: int in 4:
			normals.append(along)
			colors.append(color)
		indices.append_array([first, first + 1, first + 2, first + 1, first + 3, first + 2])
	var mesh: ArrayMesh = ArrayMesh.new()
	if vertices.is_empty():
		return mesh
	var arrays: Array = []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = vertices
	arrays[Mesh.ARRAY_NORMAL] = normals
	arrays[Mesh.ARRAY_COLOR] = colors
	arrays[Mesh.ARRAY_TEX_UV] = sides
	arrays[Mesh.ARRAY_INDEX] = indices
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	return mesh


## The nodes of one kind, as beads of one colour.
static func nodes(tree: TreeReconstruction, ids: PackedInt32Array, color: Color) -> ArrayMesh:
	var points: PackedVector3Array = PackedVector3Array()
	var colors: PackedColorArray = PackedColorArray()
	points.resize(ids.size())
	colors.resize(ids.size())
	colors.fill(color)
	for i: int in ids.size():
		points[i] = tree.get_node_position(ids[i])
	return _mesh(Mesh.PRIMITIVE_POINTS, points, colors)


## Beads of `diameter` pixels.
static func bead_material(diameter: float, rim: float) -> ShaderMaterial:
	var material: ShaderMaterial = ShaderMaterial.new()
	material.shader = POINTS
	material.set_shader_parameter(&"diameter", diameter)
	material.set_shader_parameter(&"rim", rim)
	return material


## Lines `width` pixels wide.
static func line_material(width: float) -> ShaderMaterial:
	var material: ShaderMaterial = ShaderMaterial.new()
	material.shader = LINES
	material.set_shader_parameter(&"width", width)
	return material


static func _mesh(
	primitive: Mesh.PrimitiveType, points: PackedVector3Array, colors: PackedColorArray
) -> ArrayMesh:
	var mesh: ArrayMesh = ArrayMesh.new()
	if points.is_empty():
		return mesh
	var arrays: Array = []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = points
	arrays[Mesh.ARRAY_COLOR] = colors
	mesh.add_surface_from_arrays(primitive, arrays)
	return mesh


static func _by_height(points: PackedVector3Array) -> PackedColorArray:
	var low: float = INF
	var high: float = -INF
	for point: Vector3 in points:
		low = minf(low, point.y)
		high = maxf(high, point.y)
	var scale: float = 255.0 / maxf(high - low, 1e-6)
	var ramp: PackedColorArray = PackedColorArray()
	for i: int in 256:
		var t: float = i / 255.0
		if t < 0.5:
			ramp.append(_LOW.lerp(_MIDDLE, t * 2.0))
		else:
			ramp.append(_MIDDLE.lerp(_HIGH, t * 2.0 - 1.0))
	var colors: PackedColorArray = PackedColorArray()
	colors.resize(points.size())
	for i: int in points.size():
		colors[i] = ramp[int((points[i].y - low) * scale)]
	return colors
