@tool
class_name TreeBaker
extends RefCounted
## Turns trees into plain scenes and meshes that need neither this addon nor its library.
##
## A baked scene holds a mesh for each level of detail, of a surface of bark and one for each kind
## of leaves, that take turns by their distance. Their nodes are named after the tree, with
## [code]_LOD0[/code], [code]_LOD1[/code] and so on; an impostor is the last of them. The scene has
## its materials, with the wind, and a body along its wood. Share it, use it in a project without
## the addon, or give the meshes to a tool that scatters them.
## [codeblock]
## var baker := TreeBaker.new()
## baker.levels = 3
## ResourceSaver.save(baker.bake(tree), "res://trees/oak.scn")
## [/codeblock]
## The leaves are vertices then, unless [member form] says otherwise, so it needs more memory than a
## [TreeInstance3D]; and it no longer follows its scan, its rules or its edits.

## How the leaves are drawn.
enum Form {
	## Leaves and bark are two surfaces of one mesh per level. Two draws for a tree, or for all
	## trees of a [MultiMesh] or of a tool that scatters meshes.
	JOINED,
	## Each level has a mesh of bark and a [MultiMeshInstance3D] of leaves below it, in a fraction
	## of the memory. The scene has a short script of its own, which tells the leaves where they are.
	MULTIMESH,
}

# How far the wind moves a tree beyond its box, over its height.
const _SWAY: float = 0.25
const LeavesApart := preload("leaves_apart.gd")
const Lightmap := preload("lightmap.gd")
const PlainMaterials := preload("plain_materials.gd")
const SharedFiles := preload("shared_files.gd")
const BuildJob := preload("../nodes/tree_build_job.gd")
const Collision := preload("../nodes/tree_collision.gd")
const Levels := preload("../nodes/tree_levels.gd")
const LeafKinds := preload("../nodes/leaf_kinds.gd")

## How many levels of detail there are, the finest first: 1 to 5.
var levels: int = Levels.COUNT:
	set(value):
		levels = clampi(value, 1, Levels.MOST)

## The distances in metres from which on the next level is shown, one less than there are levels.
## Empty: chosen by the tree's height.
var distances: PackedFloat32Array = []

## How the leaves are drawn.
var form: Form = Form.JOINED

## Whether the finest level's bark gets the second texture coordinates that a [LightmapGI] needs.
## The leaves are nodes of their own then, and they and the coarser levels are lit by the lightmap's
## probes: levels that stand in one place would shade each other in it. Only the editor can do this.
var lightmap_uv2: bool = false

## The length of a texel of the lightmap in metres.
var lightmap_texel_size: float = 0.1

## Whether the tree bears its leaves.
var leaves: bool = true

## Whether the wind moves it.
var wind: bool = true

## Whether its wind is that of the project, as of a [TreeInstance3D]: it follows [TreeWind] and
## gives way to [TreePusher3D]. Then it needs the project's shader globals
## [code]tree_wind_…[/code], which the addon's plugin adds. Otherwise it has a wind of its own, in
## its materials.
var global_wind: bool = false

## Whether there is a [StaticBody3D] along its stout wood.
var collision: bool = true

## The shapes of that body.
var collision_kind: TreeInstance3D.CollisionKind = TreeInstance3D.CollisionKind.CAPSULES

## How many shapes it has at most; see [member TreeInstance3D.collision_shapes].
var collision_shapes: int = 32:
	set(value):
		collision_shapes = maxi(value, 1)

## Thinner wood, measured from its middle, lets everything through.
var collision_minimum_radius: float = 0.03

## The bark's material; without one, that of the tree's leaf preset. For one without the addon's
## shader the bark's picture goes around each branch a whole number of times, and meets itself.
var bark_material: Material

## The leaves' material; without one, that of the tree's leaf preset.
var leaf_material: Material

## What is shown of the tree beyond the last level, if it is given: see [TreeImpostorBaker].
var impostor: TreeImpostor

## With [constant Form.MULTIMESH], a folder for what all trees of a kind have in common: materials,
## pictures, shaders and leaf cards become files there, made once, which the scenes name. A scene
## then has its bark and the places of its leaves alone, and a script of the folder's draws it.
## Empty: all is in each scene.
var shared_folder: String = "":
	set(value):
		shared_folder = value
		_shared = null

var _shared: SharedFiles

# Kept, so that loading them again is no work.
var _loaded: Array[Material] = []


## What was built of a tree, before it becomes nodes.
class Parts:
	extends RefCounted
	## The surface arrays of the bark of each level.
	var bark: Array[Array] = []
	## The leaves of each level, by kind: see [method TreeReconstruction.build_joined_foliage] or, with
	## [constant TreeBaker.MULTIMESH], [method TreeReconstruction.build_foliage].
	var foliage: Array[Array] = []
	## The size of the finest level's lightmap, if there is one.
	var lightmap: Vector2i = Vector2i.ZERO
	## See [method TreeReconstruction.build_capsules] and
	## [method TreeReconstruction.build_convex_parts].
	var shapes: Array[Dictionary] = []
	## The box around all levels, at rest.
	var box: AABB
	## The pictures of the materials, packed, by the paths of those that they are copies of.
	var pictures: Dictionary[String, Texture2D] = {}
	## How high the finest level's wood reaches, in metres.
	var height: float = 0.0


## Returns the tree as a scene.
func bake(tree: TreeReconstruction) -> PackedScene:
	return make_scene(tree, build(tree))


## Loads the materials that [param tree] is baked with. To be called on the main thread before
## [method build] and the rest run on another one: the engine can lock up if both threads load one.
func load_materials(tree: TreeReconstruction) -> void:
	_loaded = [_bark_of(tree)]
	var kinds: Array[Dictionary] = tree.get_leaf_kinds()
	for kind: Dictionary in kinds:
		_loaded.append(_leaf_of(kind, kinds[0]))


## Builds what [method make_scene] needs. This is the long part, and may run on any thread; it ends
## early, with [code]null[/code], when [param cancelled] returns [code]true[/code].
func build(tree: TreeReconstruction, cancelled: Callable = Callable()) -> Parts:
	var parts: Parts = Parts.new()
	for level: int in levels:
		if cancelled.is_valid() and cancelled.call():
			return null
		var built: Array[Dictionary] = []
		if leaves:
			built = (
				tree.build_joined_foliage(level)
				if form == Form.JOINED
				else tree.build_foliage(level)
			)
		parts.foliage.append(built)
		_build_bark(tree, level, parts)
	if collision:
		parts.shapes = Collision.gather(
			tree, collision_kind, collision_shapes, collision_minimum_radius
		)
	if not _shares():
		parts.pictures = PlainMaterials.plain_pictures(_bark_of(tree))
	for kind: Dictionary in parts.foliage[0]:
		if _is_drawn(kind) and not _shares():
			var leaf: Material = _leaf_of(kind, parts.foliage[0][0])
			parts.pictures.merge(PlainMaterials.plain_pictures(leaf))
	for place: Vector3 in _places(parts.bark[0]):
		parts.height = maxf(parts.height, place.y)
	var first: bool = true
	for arrays: Array in parts.bark + joined_leaves(parts):
		for place: Vector3 in _places(arrays):
			parts.box = AABB(place, Vector3.ZERO) if first else parts.box.expand(place)
			first = false
	for kinds: Array in parts.foliage:
		for kind: Dictionary in kinds:
			if kind.has("leaves"):
				parts.box = LeavesApart.box_around(parts.box, kind.leaves)
	return parts


## The surface arrays of all leaves that are vertices, of all levels and kinds.
static func joined_leaves(parts: Parts) -> Array[Array]:
	var found: Array[Array] = []
	for kinds: Array in parts.foliage:
		for kind: Dictionary in kinds:
			if kind.has("arrays"):
				found.append(kind.arrays)
	return found


func _build_bark(tree: TreeReconstruction, level: int, parts: Parts) -> void:
	# Only the addon's shader knows how to hide the seam of a picture that does not fit around.
	var whole_repeats: bool = not PlainMaterials.is_addons(_bark_of(tree))
	var arrays: Array = tree.build_mesh_arrays(
		level, whole_repeats, leaves, BuildJob.leaf_triangles(parts.foliage[level])
	)
	if lightmap_uv2 and level == 0 and not arrays.is_empty():
		var unwrapped: Lightmap.Unwrapped = Lightmap.unwrap(arrays, lightmap_texel_size)
		if unwrapped.arrays.is_empty():
			push_error("Only the editor's program can make coordinates for a lightmap.")
		else:
			arrays = unwrapped.arrays
			parts.lightmap = unwrapped.size
	parts.bark.append(arrays)


## Makes a scene of what [method build] returned for the same tree, on the main thread.
func make_scene(tree: TreeReconstruction, parts: Parts) -> PackedScene:
	var root: Node3D = make_nodes(tree, parts)
	var scene: PackedScene = PackedScene.new()
	scene.pack(root)
	root.free()
	return scene


## As [method make_scene], but returns the nodes, which belong to the caller.
func make_nodes(tree: TreeReconstruction, parts: Parts) -> Node3D:
	var root: Node3D = Node3D.new()
	root.name = _name_of(tree)
	var meshes: Array[ArrayMesh] = make_meshes(tree, parts)
	if impostor != null:
		meshes.append(_plain_card(tree, parts, meshes))
	var switches: PackedFloat32Array = Levels.distances(parts.height, meshes.size(), distances)
	var apart: Array[Array] = _make_leaves(tree, parts)
	for level: int in meshes.size():
		var part: MeshInstance3D = MeshInstance3D.new()
		# By such names, tools that scatter meshes know the levels; the impostor is the last one.
		part.name = "%s_LOD%d" % [root.name, level]
		part.mesh = meshes[level]
		# The mesh has room for the wind in its own box, for whoever draws it without this node.
		part.custom_aabb = parts.box
		part.extra_cull_margin = _reach_of(parts)
		part.gi_mode = _gi_mode(level == 0)
		var drawn: Array[GeometryInstance3D] = [part]
		root.add_child(part)
		part.owner = root
		if level < apart.size():
			for each: GeometryInstance3D in apart[level]:
				drawn.append(each)
				part.add_child(each)
				each.owner = root
		for each: GeometryInstance3D in drawn:
			if level > 0:
				each.visibility_range_begin = switches[level - 1]
				each.visibility_range_begin_margin = Levels.margin(switches[level - 1])
			if level + 1 < meshes.size():
				each.visibility_range_end = switches[level]
				each.visibility_range_end_margin = Levels.margin(switches[level])
	if form == Form.MULTIMESH and (_shares() or not apart.is_empty()):
		var own_values: Dictionary = {}
		for i: int in range(1, parts.foliage[0].size()):
			var tints: PackedColorArray = parts.foliage[0][i].tints
			if not tints.is_empty():
				own_values[_node_name(i)] = Dictionary(LeafKinds.season_values(tints))
		if _shares():
			root.set_script(_shared_files().script())
			root.set("values", Dictionary(_shader_values(tree, parts.height)))
			root.set("own_values", own_values)
		else:
			LeavesApart.teach(root, _shader_values(tree, parts.height), own_values)
	if not parts.shapes.is_empty():
		var body: StaticBody3D = StaticBody3D.new()
		body.name = "Wood"
		root.add_child(body)
		body.owner = root
		Collision.fill(body, parts.shapes)
		# Its shapes are the scene's own, seen and saved.
		for shape: Node in body.get_children(true):
			body.remove_child(shape)
			body.add_child(shape)
			shape.owner = root
	return root


## The meshes of all levels, the finest first, each with a surface of bark and one of leaves, unless
## the leaves are nodes of their own. They share their materials and their box.
func make_meshes(tree: TreeReconstruction, parts: Parts) -> Array[ArrayMesh]:
	var values: Dictionary[StringName, Variant] = _shader_values(tree, parts.height)
	var bark: Material
	if _shares():
		bark = _shared_files().material(_bark_of(tree), true, global_wind)
	else:
		bark = PlainMaterials.plain(_bark_of(tree), values, parts.pictures, true, global_wind)
	var leaf: Array[Material] = []
	if not _are_leaves_apart():
		leaf = _plain_leaves(tree, parts, true)
	var meshes: Array[ArrayMesh] = []
	for level: int in parts.bark.size():
		var mesh: ArrayMesh = ArrayMesh.new()
		if not parts.bark[level].is_empty():
			mesh.add_surface_from_arrays(
				Mesh.PRIMITIVE_TRIANGLES, parts.bark[level], [], {}, TreeReconstruction.MESH_FLAGS
			)
			mesh.surface_set_name(mesh.get_surface_count() - 1, "bark")
			mesh.surface_set_material(mesh.get_surface_count() - 1, bark)
		for i: int in leaf.size():
			var arrays: Array = parts.foliage[level][i].arrays
			if not arrays.is_empty():
				_add_leaves(mesh, arrays, leaf[i], i)
		if level == 0 and parts.lightmap != Vector2i.ZERO:
			mesh.lightmap_size_hint = parts.lightmap
		mesh.custom_aabb = _box_of(parts)
		mesh.resource_name = "%s_LOD%d" % [_name_of(tree), level]
		meshes.append(mesh)
	return meshes


func _plain_card(tree: TreeReconstruction, parts: Parts, meshes: Array[ArrayMesh]) -> ArrayMesh:
	var values: Dictionary[StringName, Variant] = _shader_values(tree, parts.height)
	var card: ArrayMesh = impostor.make_mesh(
		PlainMaterials.plain(impostor.material, values, {}, true, global_wind)
	)
	# The engine measures distances from the middle of the box.
	if not meshes.is_empty():
		card.custom_aabb = meshes[0].custom_aabb
	return card


## Why a file of [member shared_folder] could not be written; empty where all could.
func get_error_message() -> String:
	return "" if _shared == null else _shared.error


func _shares() -> bool:
	return form == Form.MULTIMESH and not shared_folder.is_empty()


func _shared_files() -> SharedFiles:
	if _shared == null:
		_shared = SharedFiles.new(shared_folder)
	return _shared


func _are_leaves_apart() -> bool:
	return form == Form.MULTIMESH or lightmap_uv2


# Of each kind, as it stands in parts.foliage; null where nothing is drawn of it.
func _plain_leaves(tree: TreeReconstruction, parts: Parts, joined: bool) -> Array[Material]:
	var made: Array[Material] = []
	for kind: Dictionary in parts.foliage[0]:
		var material: Material = null
		if _is_drawn(kind) and _shares():
			var own: Material = _leaf_of(kind, parts.foliage[0][0])
			material = _shared_files().material(own, joined, global_wind)
		elif _is_drawn(kind):
			var values: Dictionary[StringName, Variant] = _shader_values(tree, parts.height)
			if not (kind.tints as PackedColorArray).is_empty():
				values.merge(LeafKinds.season_values(kind.tints), true)
			material = PlainMaterials.plain(
				_leaf_of(kind, parts.foliage[0][0]), values, parts.pictures, joined, global_wind
			)
		made.append(material)
	return made


# Levels are thinner, but have of each kind what the finest has.
static func _is_drawn(kind: Dictionary) -> bool:
	if kind.has("arrays"):
		return not (kind.arrays as Array).is_empty()
	return not (kind.leaves as PackedFloat32Array).is_empty()


## The names of the surfaces of leaves that look otherwise than the tree's own.
static func get_other_leaves(parts: Parts) -> PackedStringArray:
	var names: PackedStringArray = []
	for i: int in parts.foliage[0].size():
		if parts.foliage[0][i].look != parts.foliage[0][0].look:
			names.append(_surface_name(i))
	return names


# The names of the surface and of the node of the leaves of a kind.
static func _surface_name(kind: int) -> String:
	return "leaves" if kind == 0 else "leaves_%d" % (kind + 1)


static func _node_name(kind: int) -> StringName:
	return &"Leaves" if kind == 0 else StringName("Leaves%d" % (kind + 1))


static func _add_leaves(mesh: ArrayMesh, arrays: Array, material: Material, kind: int) -> void:
	mesh.add_surface_from_arrays(
		Mesh.PRIMITIVE_TRIANGLES, arrays, [], {}, TreeReconstruction.JOINED_LEAF_FLAGS
	)
	mesh.surface_set_name(mesh.get_surface_count() - 1, _surface_name(kind))
	mesh.surface_set_material(mesh.get_surface_count() - 1, material)


# The leaves of each level as nodes, one for each kind, or none.
func _make_leaves(tree: TreeReconstruction, parts: Parts) -> Array[Array]:
	var made: Array[Array] = []
	if not leaves or not _are_leaves_apart():
		return made
	var joined: bool = form == Form.JOINED
	var materials: Array[Material] = _plain_leaves(tree, parts, joined)
	for level: int in parts.foliage.size():
		var nodes: Array[GeometryInstance3D] = []
		for i: int in materials.size():
			var kind: Dictionary = parts.foliage[level][i]
			if not _is_drawn(kind):
				continue
			var node: GeometryInstance3D
			if joined:
				var mesh: ArrayMesh = ArrayMesh.new()
				_add_leaves(mesh, kind.arrays, materials[i], i)
				node = MeshInstance3D.new()
				(node as MeshInstance3D).mesh = mesh
			else:
				node = MultiMeshInstance3D.new()
				var card: Mesh = (
					_shared_files().card(kind.card, materials[i])
					if _shares()
					else LeavesApart.mesh(kind.card, materials[i])
				)
				(node as MultiMeshInstance3D).multimesh = LeavesApart.multimesh(kind.leaves, card)
			node.name = _node_name(i)
			node.custom_aabb = parts.box
			node.extra_cull_margin = _reach_of(parts)
			# No lightmap has a place for each leaf.
			node.gi_mode = _gi_mode(false)
			nodes.append(node)
		made.append(nodes)
	return made


# Of what the lightmap has a place for, and of what its probes light.
func _gi_mode(mapped: bool) -> GeometryInstance3D.GIMode:
	if lightmap_uv2 and not mapped:
		return GeometryInstance3D.GI_MODE_DYNAMIC
	return GeometryInstance3D.GI_MODE_STATIC


# With all that the wind may move.
static func _box_of(parts: Parts) -> AABB:
	return parts.box.grow(_reach_of(parts))


static func _reach_of(parts: Parts) -> float:
	return _SWAY * maxf(parts.height, 0.1)


# What a TreeInstance3D sets for its instance.
func _shader_values(tree: TreeReconstruction, height: float) -> Dictionary[StringName, Variant]:
	var values: Dictionary[StringName, Variant] = {
		&"tree_height": maxf(height, 0.1), &"tree_wind": 1.0 if wind else 0.0
	}
	var own: Dictionary = tree.get_leaf_kinds()[0]
	if not (own.tints as PackedColorArray).is_empty():
		values.merge(LeafKinds.season_values(own.tints))
	return values


func _bark_of(tree: TreeReconstruction) -> Material:
	if bark_material != null:
		return bark_material
	return load(LeafKinds.preset_path(tree.get_leaf_look(), "bark")) as Material


# own: the tree's own kind.
func _leaf_of(kind: Dictionary, own: Dictionary) -> Material:
	if leaf_material != null and LeafKinds.looks_like(kind, own):
		return leaf_material
	return load(LeafKinds.material_path(kind)) as Material


static func _places(arrays: Array) -> PackedVector3Array:
	return PackedVector3Array() if arrays.is_empty() else arrays[Mesh.ARRAY_VERTEX]


static func _name_of(tree: TreeReconstruction) -> String:
	var name: String = tree.resource_name
	if name.is_empty() and not tree.resource_path.contains("::"):
		name = tree.resource_path.get_file().get_basename()
	name = name.to_pascal_case().validate_node_name()
	return "Tree" if name.is_empty() else name
