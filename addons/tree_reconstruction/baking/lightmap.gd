@tool
extends RefCounted
## A second set of texture coordinates, in which no part of a mesh covers another: where a lightmap
## keeps its light. The engine's own unwrapper cuts the charts; it drops what it doesn't know, so
## what it makes is brought back onto the whole mesh here.


## What [method unwrap] made.
class Unwrapped:
	extends RefCounted
	## Empty if it could not be done.
	var arrays: Array = []
	## How many texels the lightmap needs.
	var size: Vector2i = Vector2i.ZERO


## Returns the surface of triangles [param arrays] with [constant Mesh.ARRAY_TEX_UV2]; vertices on
## the charts' edges are doubled. [param texel] is the length of a texel in metres. It may run on
## any thread, but in the editor's program alone.
static func unwrap(arrays: Array, texel: float) -> Unwrapped:
	var made: Unwrapped = Unwrapped.new()
	var places: PackedVector3Array = arrays[Mesh.ARRAY_VERTEX]
	var numbers: PackedColorArray = []
	numbers.resize(places.size())
	for i: int in places.size():
		# The colors come back as they were: so each says which vertex it is.
		numbers[i] = Color8(i & 255, (i >> 8) & 255, (i >> 16) & 255, (i >> 24) & 255)
	var bare: Array = []
	bare.resize(Mesh.ARRAY_MAX)
	for kept: int in [Mesh.ARRAY_VERTEX, Mesh.ARRAY_NORMAL, Mesh.ARRAY_TEX_UV, Mesh.ARRAY_INDEX]:
		bare[kept] = arrays[kept]
	bare[Mesh.ARRAY_COLOR] = numbers
	var mesh: ArrayMesh = ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, bare)
	if mesh.lightmap_unwrap(Transform3D.IDENTITY, texel) != OK:
		return made
	var cut: Array = mesh.surface_get_arrays(0)
	var from: PackedInt32Array = []
	for number: Color in cut[Mesh.ARRAY_COLOR] as PackedColorArray:
		from.append(number.r8 | (number.g8 << 8) | (number.b8 << 16) | (number.a8 << 24))
	made.arrays.resize(Mesh.ARRAY_MAX)
	for kind: int in Mesh.ARRAY_MAX:
		if arrays[kind] != null and kind != Mesh.ARRAY_INDEX:
			made.arrays[kind] = _gathered(arrays[kind], from, places.size())
	made.arrays[Mesh.ARRAY_TEX_UV2] = cut[Mesh.ARRAY_TEX_UV2]
	made.arrays[Mesh.ARRAY_INDEX] = cut[Mesh.ARRAY_INDEX]
	made.size = mesh.lightmap_size_hint
	return made


# Of an array of `count` vertices those that `from` names.
static func _gathered(array: Variant, from: PackedInt32Array, count: int) -> Variant:
	@warning_ignore("integer_division")
	var each: int = array.size() / count
	var gathered: Variant = array.duplicate()
	gathered.resize(from.size() * each)
	for i: int in from.size():
		for j: int in each:
			gathered[each * i + j] = array[each * from[i] + j]
	return gathered
