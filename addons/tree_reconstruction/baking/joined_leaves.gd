@tool
extends RefCounted
## All leaves of a tree as one surface, whose vertices know what a multimesh knows per leaf.

## CUSTOM0: where the petiole is, and the leaf's phase. CUSTOM1: the way along the leaf, and how
## stiff its branch is. CUSTOM2: the way across it, and its hue.
const FLAGS: int = (
	(Mesh.ARRAY_CUSTOM_RGBA_FLOAT << Mesh.ARRAY_FORMAT_CUSTOM0_SHIFT)
	| (Mesh.ARRAY_CUSTOM_RGBA8_SNORM << Mesh.ARRAY_FORMAT_CUSTOM1_SHIFT)
	| (Mesh.ARRAY_CUSTOM_RGBA8_SNORM << Mesh.ARRAY_FORMAT_CUSTOM2_SHIFT)
)
const _FLOATS_PER_LEAF: int = 20
const _LEAVES_BETWEEN_CHECKS: int = 500


## The surface arrays of [param card] (see [method TreeReconstruction.build_leaf_form_arrays]) at
## all places of [param buffer] (see [method TreeReconstruction.build_leaf_buffer]); empty without
## any, or when [param cancelled] returns [code]true[/code].
static func join(buffer: PackedFloat32Array, card: Array, cancelled: Callable) -> Array:
	@warning_ignore("integer_division")
	var count: int = buffer.size() / _FLOATS_PER_LEAF
	if count == 0 or card.is_empty():
		return []
	var joined: Joined = Joined.new(card, count)
	for leaf: int in count:
		if leaf % _LEAVES_BETWEEN_CHECKS == 0 and cancelled.is_valid() and cancelled.call():
			return []
		joined.add(buffer, leaf)
	return joined.to_arrays()


# The surface while it grows.
class Joined:
	extends RefCounted

	var _card_places: PackedVector3Array
	var _card_normals: PackedVector3Array
	var _card_tangents: PackedFloat32Array
	var _card_colors: PackedColorArray
	var _card_indices: PackedInt32Array
	var _each: int
	var _places: PackedVector3Array
	var _normals: PackedVector3Array
	var _tangents: PackedFloat32Array
	var _colors: PackedColorArray
	var _uvs: PackedVector2Array
	var _indices: PackedInt32Array
	var _petioles: PackedFloat32Array
	var _lengthwise: PackedByteArray
	var _across: PackedByteArray

	func _init(card: Array, count: int) -> void:
		_card_places = card[Mesh.ARRAY_VERTEX]
		_card_normals = card[Mesh.ARRAY_NORMAL]
		_card_tangents = card[Mesh.ARRAY_TANGENT]
		_card_colors = card[Mesh.ARRAY_COLOR]
		_card_indices = card[Mesh.ARRAY_INDEX]
		_each = _card_places.size()
		_places.resize(count * _each)
		_normals.resize(count * _each)
		_tangents.resize(4 * count * _each)
		_colors.resize(count * _each)
		_petioles.resize(4 * count * _each)
		_lengthwise.resize(4 * count * _each)
		_across.resize(4 * count * _each)
		_indices.resize(count * _card_indices.size())
		var uvs: PackedVector2Array = card[Mesh.ARRAY_TEX_UV]
		for i: int in count:
			_uvs.append_array(uvs)

	func add(buffer: PackedFloat32Array, leaf: int) -> void:
		var at: int = leaf * _FLOATS_PER_LEAF
		var axes: Basis = Basis(
			Vector3(buffer[at], buffer[at + 4], buffer[at + 8]),
			Vector3(buffer[at + 1], buffer[at + 5], buffer[at + 9]),
			Vector3(buffer[at + 2], buffer[at + 6], buffer[at + 10])
		)
		var petiole: Vector3 = Vector3(buffer[at + 3], buffer[at + 7], buffer[at + 11])
		var color: Color = Color(buffer[at + 12], buffer[at + 13], buffer[at + 14], buffer[at + 15])
		var lengthwise: int = _packed(axes.y.normalized(), buffer[at + 19])
		var across: int = _packed(axes.x.normalized(), buffer[at + 18])
		for i: int in _each:
			var to: int = leaf * _each + i
			_places[to] = axes * _card_places[i] + petiole
			_normals[to] = (axes * _card_normals[i]).normalized()
			var along: Vector3 = Vector3(
				_card_tangents[4 * i], _card_tangents[4 * i + 1], _card_tangents[4 * i + 2]
			)
			along = (axes * along).normalized()
			_tangents[4 * to] = along.x
			_tangents[4 * to + 1] = along.y
			_tangents[4 * to + 2] = along.z
			_tangents[4 * to + 3] = _card_tangents[4 * i + 3]
			_colors[to] = _outward(axes, color * _card_colors[i])
			_petioles[4 * to] = petiole.x
			_petioles[4 * to + 1] = petiole.y
			_petioles[4 * to + 2] = petiole.z
			_petioles[4 * to + 3] = buffer[at + 16]
			_lengthwise.encode_u32(4 * to, lengthwise)
			_across.encode_u32(4 * to, across)
		var first: int = leaf * _card_indices.size()
		for i: int in _card_indices.size():
			_indices[first + i] = leaf * _each + _card_indices[i]

	func to_arrays() -> Array:
		var arrays: Array = []
		arrays.resize(Mesh.ARRAY_MAX)
		arrays[Mesh.ARRAY_VERTEX] = _places
		arrays[Mesh.ARRAY_NORMAL] = _normals
		arrays[Mesh.ARRAY_TANGENT] = _tangents
		arrays[Mesh.ARRAY_COLOR] = _colors
		arrays[Mesh.ARRAY_TEX_UV] = _uvs
		arrays[Mesh.ARRAY_CUSTOM0] = _petioles
		arrays[Mesh.ARRAY_CUSTOM1] = _lengthwise
		arrays[Mesh.ARRAY_CUSTOM2] = _across
		arrays[Mesh.ARRAY_INDEX] = _indices
		return arrays

	# A leaf's color is the way out of the crown in its own axes: here in those of the tree.
	static func _outward(axes: Basis, color: Color) -> Color:
		var way: Vector3 = axes * (2.0 * Vector3(color.r, color.g, color.b) - Vector3.ONE)
		way = 0.5 * way.normalized() + 0.5 * Vector3.ONE
		return Color(way.x, way.y, way.z, color.a)

	# Four numbers of -1 to 1 as bytes.
	static func _packed(way: Vector3, fourth: float) -> int:
		return _byte(way.x) | (_byte(way.y) << 8) | (_byte(way.z) << 16) | (_byte(fourth) << 24)

	static func _byte(number: float) -> int:
		return roundi(127.0 * clampf(number, -1.0, 1.0)) & 0xff
