@tool
extends RefCounted
## Obstacles that are nodes of the scene: they are taken into the recipe of the edited tree, and
## looked after when they are moved.

const Recipe := preload("../dock/growth_recipe.gd")
const SceneObstacles := preload("scene_obstacles.gd")
const Session := preload("../session.gd")

# Seconds that an obstacle must lie still before bark grows around it again.
const _REST: float = 0.25

# The triangles that were taken, by their names in recipes.
var meshes: Dictionary[String, PackedVector3Array] = {}

var _session: Session
var _obstacles: SceneObstacles = SceneObstacles.new()
# Where the nodes were seen last, by their lines' paths, and of which tree.
var _seen: Dictionary[String, Transform3D] = {}
var _seen_of: TreeReconstruction
# Seconds until what was moved lies still; 0: nothing moves.
var _moving: float = 0.0
# BarkWork, which has this.
var _work: WeakRef


func _init(work: RefCounted, session: Session) -> void:
	_work = weakref(work)
	_session = session
	_obstacles.set_translation_domain(session.get_translation_domain())
	set_translation_domain(session.get_translation_domain())


## Makes a node of the scene an obstacle, as a step, or as a draft while bark is not painted. Where
## it can't be one, the user is told why. Returns whether it is one now.
func add(node: Node) -> bool:
	var tree: TreeInstance3D = _session.node
	if tree == null or not tree.is_inside_tree() or _session.tree == null:
		return false
	var place: Node3D = node as Node3D
	if place == null or not place.is_inside_tree():
		_session.say(
			tr("'%s' has no place in the scene: choose a node with a mesh.") % node.name,
			_session.Kind.ERROR
		)
		return false
	var found: SceneObstacles.Found = _obstacles.find(place, tree)
	if not found.sentence.is_empty():
		_session.say(found.sentence, _session.Kind.ERROR)
		return false
	var work: RefCounted = _work.get_ref()
	var recipe: Recipe = work.call(&"get_recipe")
	var path: String = str(tree.get_path_to(place))
	var line: Recipe.Line = null
	for other: Recipe.Line in recipe.get_features():
		if SceneObstacles.is_one(other) and other.get_word("scene") == path:
			line = other
	if line == null:
		line = Recipe.Line.new("obstacle shape=mesh")
		recipe.lines.append(line)
	_write(line, place, found.corners)
	line.set_word("scene", path)
	work.set(&"selected", recipe.get_features().find(line))
	_keep(tr("Obstacle from the Scene"))
	return true


## Whether a line's node has moved or changed since the bark met it, or is gone.
func is_moved(line: Recipe.Line) -> bool:
	if not SceneObstacles.is_one(line) or _session.node == null:
		return false
	var node: Node3D = SceneObstacles.node_of(line, _session.node)
	if node == null:
		return false
	return not SceneObstacles.is_at(line, node, _session.node)


## What the user should know of the recipe's obstacles; empty if nothing.
func get_notice(recipe: Recipe) -> String:
	for line: Recipe.Line in recipe.get_features():
		if not SceneObstacles.is_one(line) or _session.node == null:
			continue
		if not _session.node.is_inside_tree():
			continue
		if SceneObstacles.node_of(line, _session.node) == null:
			return (
				tr(
					(
						"'%s' is not in this scene any more. The bark keeps its shape: remove it from the list"
						+ " if it should be gone."
					)
				)
				% SceneObstacles.name_of(line)
			)
		if is_moved(line):
			return (
				tr("'%s' has moved in the scene since the bark met it. Grow lets it meet it there.")
				% SceneObstacles.name_of(line)
			)
	return ""


## Writes into the recipe where its obstacles are now, with their triangles as they are now.
func follow(recipe: Recipe) -> void:
	for line: Recipe.Line in recipe.get_features():
		if not SceneObstacles.is_one(line):
			continue
		var node: Node3D = SceneObstacles.node_of(line, _session.node)
		if node == null:
			continue
		var found: SceneObstacles.Found = _obstacles.find(node, _session.node)
		if found.sentence.is_empty():
			_write(line, node, found.corners)
		else:
			_session.say(found.sentence, _session.Kind.WARNING)


## The triangles that a recipe needs, by their names.
func get_meshes(recipe: String) -> Dictionary:
	var needed: Dictionary = {}
	for line: Recipe.Line in Recipe.new(recipe).get_features():
		var name: String = line.get_word("mesh")
		if name.is_empty():
			continue
		if meshes.has(name):
			needed[name] = meshes[name]
		elif _session.tree.growth_meshes.has(name):
			needed[name] = _session.tree.growth_meshes[name]
	return needed


## To be called once a frame: when an obstacle was moved and lies still again, the bark grows around
## it, if it grows of itself.
func update(delta: float) -> void:
	var tree: TreeInstance3D = _session.node
	if tree == null or _session.tree == null or not tree.is_inside_tree():
		_seen_of = null
		return
	var work: RefCounted = _work.get_ref()
	var recipe: Recipe = work.call(&"get_recipe")
	var fresh: bool = _seen_of != _session.tree
	if fresh:
		_seen.clear()
		_seen_of = _session.tree
		_moving = 0.0
	for line: Recipe.Line in recipe.lines:
		if not SceneObstacles.is_one(line):
			continue
		var path: String = line.get_word("scene")
		var node: Node3D = SceneObstacles.node_of(line, tree)
		if node == null:
			continue
		var at: Transform3D = tree.global_transform.affine_inverse() * node.global_transform
		if not _seen.has(path):
			_seen[path] = at
			# It may have been moved while another node was selected.
			if fresh and is_moved(line):
				_moving = _REST
		elif _seen[path] != at:
			_seen[path] = at
			_moving = _REST
	if _moving > 0.0 and not Input.is_mouse_button_pressed(MOUSE_BUTTON_LEFT):
		_moving -= delta
		if _moving <= 0.0:
			_moving = 0.0
			_rest()


func _rest() -> void:
	var work: RefCounted = _work.get_ref()
	var automatic: bool = work.get(&"automatic") and work.call(&"is_painting")
	var recipe: Recipe = work.call(&"get_recipe")
	# What was undone can be done again: that is worth more than what it would do anew.
	if automatic and recipe.lines.any(is_moved) and not _session.history.can_redo(_session.node):
		follow(recipe)
		_keep(tr("Obstacle Moved"))
	else:
		work.emit_signal(&"changed")


func _write(line: Recipe.Line, node: Node3D, corners: PackedVector3Array) -> void:
	var name: String = SceneObstacles.mesh_name(node, corners)
	meshes[name] = corners
	line.set_word("mesh", name)
	SceneObstacles.place(line, node, _session.node)


func _keep(title: String) -> void:
	var work: RefCounted = _work.get_ref()
	if work.call(&"is_painting"):
		work.call(&"commit", title)
	else:
		work.emit_signal(&"changed")
