@tool
extends RefCounted
## The trees of a forest: where each stands, which individual it is, and in which cells they are.

const Scatter := preload("scatter.gd")
## Of a multimesh: twelve of the transform, four of a colour, its own tone, its own season and two
## that are free. The colour is white: Compatibility takes anything for one that is not there.
const FLOATS: int = 20
## Ids of trees that were added begin here; below are those of the forest's own trees, by their row.
const FIRST_ADDED: int = 1 << 30
const LAST_ID: int = 0x7fffffff


## Cells of one size, each with the rows of the trees in it.
class Grid:
	extends RefCounted
	var size: float
	var cells: Dictionary[Vector2i, Cell] = {}

	func cell_at(at: Vector3) -> Vector2i:
		return Vector2i(floori(at.x / size), floori(at.z / size))

	func add(row: int, individual: int, at: Vector3) -> void:
		var key: Vector2i = cell_at(at)
		var cell: Cell = cells.get(key)
		if cell == null:
			cell = Cell.new()
			cell.box = AABB(at, Vector3.ZERO)
			cells[key] = cell
		if not cell.rows.has(individual):
			cell.rows[individual] = PackedInt32Array()
		cell.rows[individual].append(row)
		cell.box = cell.box.expand(at)

	func remove(row: int, individual: int, at: Vector3) -> void:
		var key: Vector2i = cell_at(at)
		var cell: Cell = cells[key]
		cell.rows[individual].remove_at(cell.rows[individual].find(row))
		if cell.rows[individual].is_empty():
			cell.rows.erase(individual)
		if cell.rows.is_empty():
			cells.erase(key)


## What stands in one cell: by individual, the rows of the trees. The box is around their bases.
class Cell:
	extends RefCounted
	var rows: Dictionary[int, PackedInt32Array] = {}
	var box: AABB


## All trees, a row of [constant FLOATS] numbers for each.
var buffer: PackedFloat32Array = []
## By row, the individual that each wants to be; -1 for one that was removed.
var individuals: PackedInt32Array = []
## By level of detail.
var grids: Array[Grid] = []
## How many stand.
var count: int = 0
## The scale of the largest tree.
var largest: float = 0.0

var number: int = 1
var variety: int = 1
var smallest_scale: float = 1.0
var largest_scale: float = 1.0
var lean: float = 0.0
var alignment: float = 0.0
var sink: float = 0.0

# Of the trees that were added: their ids in the order of their rows, and their rows by their ids.
var _added: PackedInt32Array = []
var _rows: Dictionary[int, int] = {}


## Stands that begin with cells of such sizes.
func _init(sizes: PackedFloat32Array) -> void:
	for size: float in sizes:
		var grid: Grid = Grid.new()
		grid.size = size
		grids.append(grid)


## Adds a tree at a place that was found on ground of such a normal; returns its id.
func plant(place: Vector3, normal: Vector3) -> int:
	var key: int = Scatter.mix(number, 8 * individuals.size() + 1)
	var yaw: float = TAU * Scatter.share(Scatter.mix(key, 1))
	var scale: float = lerpf(smallest_scale, largest_scale, Scatter.share(Scatter.mix(key, 2)))
	var aside: float = TAU * Scatter.share(Scatter.mix(key, 3))
	var up: Vector3 = Vector3.UP.lerp(normal, alignment)
	up += lean * Scatter.share(Scatter.mix(key, 4)) * Vector3(cos(aside), 0.0, sin(aside))
	up = up.normalized()
	var right: Vector3 = Vector3(cos(yaw), 0.0, -sin(yaw))
	right = (right - up * right.dot(up)).normalized()
	var axes: Basis = Basis(right, up, right.cross(up))
	return add(Transform3D(axes.scaled_local(Vector3.ONE * scale), place - sink * scale * up))


## Adds a tree as it is to stand; returns its id.
func add(frame: Transform3D) -> int:
	var id: int = individuals.size()
	_append(id, frame)
	return id


## Adds one that is not the forest's own, with the id that it has.
func add_again(id: int, frame: Transform3D) -> void:
	_rows[id] = individuals.size()
	_added.append(id)
	_append(id, frame)


## Whether a tree can stand so: at a place that is finite, and not flat.
static func can_stand(frame: Transform3D) -> bool:
	return frame.is_finite() and absf(frame.basis.determinant()) > 1e-9


## From the world's frame to that of a forest that stands so; the world's own for one that can't.
static func into(frame: Transform3D) -> Transform3D:
	return frame.affine_inverse() if can_stand(frame) else Transform3D.IDENTITY


## Leaves an id out: no tree stands there.
func skip() -> void:
	buffer.resize(buffer.size() + FLOATS)
	individuals.append(-1)


## Takes a tree away. Its id is never given again.
func remove(id: int) -> void:
	var row: int = row_of(id)
	for grid: Grid in grids:
		grid.remove(row, individuals[row], place_of(id))
	individuals[row] = -1
	count -= 1


func has(id: int) -> bool:
	var row: int = row_of(id)
	return row >= 0 and individuals[row] >= 0


## Where a tree is in the buffer; -1 where there never was one.
func row_of(id: int) -> int:
	if id >= FIRST_ADDED:
		return _rows.get(id, -1)
	return id if id >= 0 and id < individuals.size() - _added.size() else -1


func id_of(row: int) -> int:
	var own: int = individuals.size() - _added.size()
	return row if row < own else _added[row - own]


## Which individual a tree wants to be.
func individual_of(id: int) -> int:
	return individuals[row_of(id)]


func place_of(id: int) -> Vector3:
	return place_of_row(row_of(id))


func place_of_row(row: int) -> Vector3:
	var at: int = FLOATS * row
	return Vector3(buffer[at + 3], buffer[at + 7], buffer[at + 11])


func frame_of(id: int) -> Transform3D:
	var at: int = FLOATS * row_of(id)
	return Transform3D(
		Basis(
			Vector3(buffer[at], buffer[at + 4], buffer[at + 8]),
			Vector3(buffer[at + 1], buffer[at + 5], buffer[at + 9]),
			Vector3(buffer[at + 2], buffer[at + 6], buffer[at + 10])
		),
		place_of(id)
	)


## The trees that stand within [param reach] of a place, the nearest first.
func near(at: Vector3, reach: float) -> PackedInt32Array:
	var found: PackedInt32Array = []
	if grids.is_empty():
		return found
	var grid: Grid = grids[0]
	var low: Vector2i = grid.cell_at(at - Vector3.ONE * reach)
	var high: Vector2i = grid.cell_at(at + Vector3.ONE * reach)
	var distances: PackedFloat32Array = []
	for key: Vector2i in keys_between(grid, low, high):
		for rows: PackedInt32Array in grid.cells[key].rows.values():
			for row: int in rows:
				var distance: float = place_of_row(row).distance_to(at)
				if distance <= reach:
					var place: int = distances.bsearch(distance, false)
					distances.insert(place, distance)
					found.insert(place, id_of(row))
	return found


## The tree of the forest's own that stands there, seen from above, within [param reach]; of several
## that whose height is nearest. -1 where none does.
func find_base(at: Vector3, reach: float) -> int:
	var found: int = -1
	var best: float = INF
	var grid: Grid = grids[0]
	var aside: Vector3 = Vector3.ONE * reach
	for key: Vector2i in keys_between(grid, grid.cell_at(at - aside), grid.cell_at(at + aside)):
		for rows: PackedInt32Array in grid.cells[key].rows.values():
			for row: int in rows:
				var off: Vector3 = place_of_row(row) - at
				var nearer: bool = Vector2(off.x, off.z).length() <= reach and off.length() < best
				if nearer and id_of(row) < FIRST_ADDED:
					found = id_of(row)
					best = off.length()
	return found


## A number for where all trees stand and which individuals they are.
func add_to(digest: HashingContext) -> void:
	if individuals.is_empty():
		return
	var own: int = individuals.size() - _added.size()
	if own > 0:
		digest.update(buffer.slice(0, FLOATS * own).to_byte_array())
		digest.update(individuals.slice(0, own).to_byte_array())
	# Of those that were added, what is gone leaves no trace.
	for id: int in _added:
		if has(id):
			digest.update(var_to_bytes([id, frame_of(id), individual_of(id)]))


## The cells of a grid that hold trees, between two of them.
static func keys_between(grid: Grid, low: Vector2i, high: Vector2i) -> Array[Vector2i]:
	var keys: Array[Vector2i] = []
	# Whichever is less to look at.
	if (high.x - low.x + 1.0) * (high.y - low.y + 1.0) > grid.cells.size():
		for key: Vector2i in grid.cells:
			if key.x >= low.x and key.x <= high.x and key.y >= low.y and key.y <= high.y:
				keys.append(key)
		return keys
	for y: int in range(low.y, high.y + 1):
		for x: int in range(low.x, high.x + 1):
			if grid.cells.has(Vector2i(x, y)):
				keys.append(Vector2i(x, y))
	return keys


func _append(id: int, frame: Transform3D) -> void:
	var key: int = Scatter.mix(number, 8 * id + 2)
	var axes: Basis = frame.basis
	buffer.append_array(
		PackedFloat32Array(
			[
				axes.x.x,
				axes.y.x,
				axes.z.x,
				frame.origin.x,
				axes.x.y,
				axes.y.y,
				axes.z.y,
				frame.origin.y,
				axes.x.z,
				axes.y.z,
				axes.z.z,
				frame.origin.z,
				1.0,
				1.0,
				1.0,
				1.0,
				2.0 * Scatter.share(Scatter.mix(key, 1)) - 1.0,
				Scatter.share(Scatter.mix(key, 2)),
				0.0,
				0.0
			]
		)
	)
	var row: int = individuals.size()
	individuals.append((Scatter.mix(key, 3) & 0x7fffffff) % variety)
	largest = maxf(largest, axes.y.length())
	for grid: Grid in grids:
		grid.add(row, individuals[row], frame.origin)
	count += 1
