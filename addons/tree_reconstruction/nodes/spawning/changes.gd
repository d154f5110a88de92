@tool
extends RefCounted
## What a game has done to a forest: which trees it took away, and which it added. Both are kept
## through every rebuild, and can be saved.

const Stand := preload("stand.gd")
## The version of what [method to_state] gives. A newer one is refused.
const FORMAT_VERSION: int = 1
# The base of a tree moves less than this, seen from above, when the ground under it changes.
const _SAME: float = 0.1
const _FLOATS: int = 12

# Of the trees that were taken away: their ids, -1 where none stands there now, and their places.
var _removed: PackedInt32Array = []
var _places: PackedVector3Array = []
# Likewise, by their ids alone: told while no places were known.
var _pending: PackedInt32Array = []
# Of the trees that were added.
var _added: Dictionary[int, Transform3D] = {}
var _next: int = Stand.FIRST_ADDED


## Keeps a tree that is added; returns its id. Ids are never given again.
func add(frame: Transform3D) -> int:
	_added[_next] = frame
	_next += 1
	return _next - 1


## Keeps that a tree is gone from where it stood.
func remove(id: int, place: Vector3) -> void:
	if not _added.erase(id):
		_removed.append(id)
		_places.append(place)


## Likewise, while the places of the forest's own trees are not known.
func remove_later(id: int) -> void:
	if not _added.erase(id) and not _pending.has(id):
		_pending.append(id)


## Whether it is the id of a tree that was added and not taken away.
func has_added(id: int) -> bool:
	return _added.has(id)


## Does all of it to the trees of a forest that is new.
func apply(stand: Stand) -> void:
	for id: int in _pending:
		if stand.has(id):
			remove(id, stand.place_of(id))
		else:
			push_error("The forest has no tree %d." % id)
	_pending = []
	# Those that kept their ids come first, so that none of them is taken for another's.
	var lost: PackedInt32Array = []
	for i: int in _removed.size():
		var id: int = _removed[i]
		if stand.has(id) and _are_same(stand.place_of(id), _places[i]):
			stand.remove(id)
		else:
			lost.append(i)
	for i: int in lost:
		_removed[i] = stand.find_base(_places[i], _SAME)
		if _removed[i] >= 0:
			stand.remove(_removed[i])
	for id: int in _added:
		stand.add_again(id, _added[id])


## All of it, in types that every format of files knows.
func to_state() -> Dictionary:
	var places: PackedFloat32Array = []
	for place: Vector3 in _places:
		places.append_array(PackedFloat32Array([place.x, place.y, place.z]))
	var frames: PackedFloat32Array = []
	for frame: Transform3D in _added.values():
		for axis: Vector3 in [frame.basis.x, frame.basis.y, frame.basis.z, frame.origin]:
			frames.append_array(PackedFloat32Array([axis.x, axis.y, axis.z]))
	return {
		"format_version": FORMAT_VERSION,
		"removed": _removed.duplicate(),
		"removed_at": places,
		"pending": _pending.duplicate(),
		"added": PackedInt32Array(_added.keys()),
		"added_at": frames,
		"next": _next,
	}


## Takes over what [method to_state] gave, from numbers of any type; an empty one is a forest that
## nobody has changed. Returns a sentence, and changes nothing, where that can't be.
func from_state(state: Dictionary) -> String:
	var version: Variant = state.get("format_version", 0 if not state.is_empty() else 1)
	if not _is_number(version) or version < 1:
		return "This is no state of a forest: it doesn't say its format_version. Use get_state()."
	if version > FORMAT_VERSION:
		return "This state of a forest is of a newer version of the addon. Update the addon."
	var lists: Dictionary[String, PackedFloat64Array] = {}
	for name: String in ["removed", "removed_at", "pending", "added", "added_at"]:
		if not _read(state.get(name, []), lists, name):
			return "This state of a forest is damaged: '%s' is no list of numbers." % name
	var wrong: String = _find_fault(lists, state.get("next", Stand.FIRST_ADDED))
	if wrong.is_empty():
		_take(lists, int(state.get("next", Stand.FIRST_ADDED)))
	return wrong


static func _is_number(value: Variant) -> bool:
	return (value is int or value is float) and is_finite(value)


static func _read(
	given: Variant, lists: Dictionary[String, PackedFloat64Array], name: String
) -> bool:
	if not (typeof(given) == TYPE_ARRAY or typeof(given) >= TYPE_PACKED_BYTE_ARRAY):
		return false
	var list: PackedFloat64Array = []
	for value: Variant in given:
		if not _is_number(value):
			return false
		list.append(value)
	lists[name] = list
	return true


static func _find_fault(lists: Dictionary[String, PackedFloat64Array], next: Variant) -> String:
	if (
		lists["removed_at"].size() != 3 * lists["removed"].size()
		or lists["added_at"].size() != _FLOATS * lists["added"].size()
	):
		return "This state of a forest is damaged: it has more or fewer places than trees."
	var highest: int = Stand.FIRST_ADDED - 1
	for id: float in lists["added"]:
		# In their order, each once.
		if id <= highest or id > Stand.LAST_ID:
			return "This state of a forest is damaged: a tree was added as %d." % int(id)
		highest = int(id)
	if not _is_number(next) or next <= highest or next > Stand.LAST_ID:
		return "This state of a forest is damaged: 'next' is no id that is free."
	return ""


func _take(lists: Dictionary[String, PackedFloat64Array], next: int) -> void:
	_removed = PackedInt32Array(Array(lists["removed"]))
	_pending = PackedInt32Array(Array(lists["pending"]))
	_places = []
	for i: int in _removed.size():
		var at: PackedFloat64Array = lists["removed_at"].slice(3 * i, 3 * i + 3)
		_places.append(Vector3(at[0], at[1], at[2]))
	_added = {}
	for i: int in lists["added"].size():
		var at: PackedFloat64Array = lists["added_at"].slice(_FLOATS * i, _FLOATS * (i + 1))
		_added[int(lists["added"][i])] = Transform3D(
			Vector3(at[0], at[1], at[2]),
			Vector3(at[3], at[4], at[5]),
			Vector3(at[6], at[7], at[8]),
			Vector3(at[9], at[10], at[11])
		)
	_next = next


static func _are_same(a: Vector3, b: Vector3) -> bool:
	return Vector2(a.x, a.z).distance_to(Vector2(b.x, b.z)) <= _SAME
