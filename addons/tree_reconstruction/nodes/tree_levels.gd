@tool
extends RefCounted
## Where one level of detail of a tree gives way to the next.

## How many levels a tree has unless it is told otherwise.
const COUNT: int = 4
## How many there can be.
const MOST: int = 5
# How many times its height a tree is away where the next level takes over.
const _SWITCH: PackedFloat32Array = [2.5, 6.0, 14.0, 30.0, 60.0]
# Lower ones are shrubs and seedlings, which are looked at as closely as this.
const _LEAST_HEIGHT: float = 0.5
const _MARGIN: float = 0.05
# Triangles of the finest level of a tree in a forest: for each metre of its height, and at least
# and at most. Each further level has a quarter.
const _PER_METRE: float = 2000.0
const _LEAST_BUDGET: float = 8000.0
const _MOST_BUDGET: float = 60000.0


## The distances in metres from which on the next level is shown, one less than [param count], of a
## tree of such a [param height] in metres. Those of [param chosen] that are there come first. An
## impostor beyond the last level counts as one more.
static func distances(
	height: float, count: int, chosen: PackedFloat32Array = []
) -> PackedFloat32Array:
	var found: PackedFloat32Array = []
	for level: int in clampi(count, 1, MOST + 1) - 1:
		var wanted: float = _SWITCH[level] * maxf(height, _LEAST_HEIGHT)
		if level < chosen.size() and not is_nan(chosen[level]):
			wanted = minf(chosen[level], 1e6)
		# Each level has its turn, however short.
		found.append(maxf(wanted, found[level - 1] if level > 0 else 0.0))
	return found


## How far before and after [param distance] the two levels that meet there mix, in metres.
static func margin(distance: float) -> float:
	return _MARGIN * distance


## The most triangles that a level of one tree of a forest may have, of a tree of such a [param
## height] in metres: that of [param chosen], where 0 sets no bound; by the height where there is
## none for the level.
static func budget(height: float, level: int, chosen: PackedInt32Array = []) -> int:
	if level < chosen.size():
		return maxi(chosen[level], 0)
	return int(clampf(_PER_METRE * height, _LEAST_BUDGET, _MOST_BUDGET) / pow(4.0, level))
