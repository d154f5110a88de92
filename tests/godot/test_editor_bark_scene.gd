extends "./dock_suite.gd"
## Nodes of the scene as obstacles of bark.

const Bark := preload("res://addons/tree_reconstruction/editor/dock/bark.gd")
const BarkWork := preload("res://addons/tree_reconstruction/editor/bark/bark_work.gd")
const AllTools := preload("res://addons/tree_reconstruction/editor/tools/all_tools.gd")
const Picker := preload("res://addons/tree_reconstruction/editor/viewport/picker.gd")
const SceneObstacles := preload("res://addons/tree_reconstruction/editor/bark/scene_obstacles.gd")
const GrownBark := preload("./test_grown_bark.gd")

var _made: Array[Node] = []


func _bark() -> Bark:
	return _dock.sections[&"bark"] as Bark


func _work() -> BarkWork:
	return BarkWork.of(_session) as BarkWork


# A box beside the trunk, 0.8 m up, whose side is at x.
func _box(x: float) -> MeshInstance3D:
	var box: BoxMesh = BoxMesh.new()
	box.size = Vector3(0.1, 0.6, 0.6)
	var node: MeshInstance3D = MeshInstance3D.new()
	node.name = "Stone wall"
	node.mesh = box
	_put(node)
	node.position = Vector3(x + 0.05, 0.8, 0.0)
	return node


func _put(node: Node) -> void:
	tree.root.add_child(node)
	_made.append(node)


func _close() -> void:
	for node: Node in _made:
		if is_instance_valid(node):
			node.free()
	_made.clear()
	_end()


func _grow() -> void:
	_bark().surface.edge.value = 0.08
	_bark().grow.pressed.emit()
	await _finish()
	_frame()


func _reach() -> float:
	return GrownBark._reach(_session.tree, 0.8)


func test_a_node_of_the_scene_is_an_obstacle_and_stays_one() -> void:
	var of: TreeReconstruction = GrownBark.stout()
	_begin(of)
	_session.node.position = Vector3(2.0, 0.0, 1.0)
	_session.node.rotation.y = 0.5
	var wall: MeshInstance3D = _box(0.0)
	# Mirrored and scaled, in the tree's space at x = 0.12.
	wall.global_transform = (
		_session.node.global_transform
		* Transform3D(Basis.from_scale(Vector3(-2.0, 1.0, 1.0)), Vector3(0.22, 0.8, 0.0))
	)
	var shown: Bark = _bark()
	shown.obstacles.take(_session, {"type": "nodes", "nodes": [wall.get_path()]})
	_frame()
	check_equal(shown.list.item_count, 1, "features: %s" % _said)
	check("Stone wall" in shown.list.get_item_text(0), shown.list.get_item_text(0))
	check(shown.fields.has("growth") and not shown.fields.has("along"), "its fields")
	await _grow()
	check(of.has_grown_bark(), "No bark has grown: %s" % _said)
	var held: float = _reach()
	check(held < 0.12 and held > 0.08, "The bark reaches %f m." % held)
	check('scene="../Stone wall"' in of.growth_recipe, of.growth_recipe)
	check_equal(of.growth_meshes.size(), 1, "meshes")
	# Saved and loaded, without that scene.
	ResourceSaver.save(of, folder.path_join("tree.tres"))
	var back: TreeReconstruction = ResourceLoader.load(
		folder.path_join("tree.tres"), "", ResourceLoader.CACHE_MODE_IGNORE
	)
	var again: TreeReconstruction = TreeReconstructor.new().grow_bark(back, back.growth_recipe)
	check(again != null and again.grown_bark == of.grown_bark, "It does not grow alike.")
	_undo.undo()
	_frame()
	check(of.growth_recipe.is_empty() and of.growth_meshes.is_empty(), "Undo leaves something.")
	_undo.redo()
	check_equal(of.growth_meshes.size(), 1, "meshes after redo")
	_close()


func test_what_is_moved_is_told_and_grown_around() -> void:
	var of: TreeReconstruction = GrownBark.stout()
	_begin(of)
	var wall: MeshInstance3D = _box(0.12)
	check(_work().scene.add(wall), str(_said))
	await _grow()
	check(_reach() < 0.12, "The bark goes through.")
	check("as this recipe" in _bark()._notice.text, _bark()._notice.text)
	wall.position.x += 0.02
	_bark().invalidate()
	_frame()
	check("has moved" in _bark()._notice.text, _bark()._notice.text)
	await _grow()
	check(_reach() > 0.12 and _reach() < 0.14, "The bark reaches %f m." % _reach())
	# Gone: it is told, and the bark can grow all the same.
	wall.free()
	_bark().invalidate()
	_frame()
	check("not in this scene" in _bark()._notice.text, _bark()._notice.text)
	await _grow()
	check(_reach() < 0.14, "Without the node the wall is gone: %s" % _said)
	_close()


func test_while_bark_is_painted_it_grows_around_what_is_moved() -> void:
	var of: TreeReconstruction = GrownBark.stout()
	of.growth_recipe = "edges longest=0.08\n"
	_begin(of)
	AllTools.add_to(_session)
	_session.picker = Picker.new(_session)
	_session.choose(&"paint_bark")
	var wall: MeshInstance3D = _box(0.12)
	check(_work().scene.add(wall), str(_said))
	await _finish()
	_frame()
	check_equal(_undo.get_history_count(), 1, "steps")
	check(of.has_grown_bark() and _reach() < 0.12, "It has not grown around it: %s" % _said)
	await _rest()
	wall.position.x += 0.02
	await _rest()
	await _finish()
	_frame()
	check_equal(_undo.get_history_count(), 2, "steps after it moved")
	check(_reach() > 0.12 and not of.growth_pending, "It has not grown again: %s" % _said)
	# Undo takes the bark back, and does not begin again by itself.
	_undo.undo()
	await _rest()
	await _finish()
	check(_reach() < 0.12, "Undo does not bring back the bark before.")
	check(_undo.has_redo(), "What was undone can't be done again.")
	_session.choose(&"")
	_session.tools.clear()
	_session.picker = null
	_close()


# Longer than what was moved must lie still.
func _rest() -> void:
	var end: int = Time.get_ticks_msec() + 600
	while Time.get_ticks_msec() < end:
		await tree.process_frame
		_frame()


func test_shapes_of_all_kinds_have_triangles() -> void:
	_begin(GrownBark.stout())
	var found: SceneObstacles = SceneObstacles.new()
	var shapes: Array[Shape3D] = [
		BoxShape3D.new(),
		SphereShape3D.new(),
		CapsuleShape3D.new(),
		CylinderShape3D.new(),
		ConvexPolygonShape3D.new(),
		ConcavePolygonShape3D.new(),
		HeightMapShape3D.new(),
	]
	var points: PackedVector3Array = [
		Vector3.ZERO, Vector3.UP, Vector3.RIGHT, Vector3.BACK, Vector3(0.2, 0.2, 0.2)
	]
	(shapes[4] as ConvexPolygonShape3D).points = points
	(shapes[5] as ConcavePolygonShape3D).set_faces(points.slice(0, 3))
	for shape: Shape3D in shapes:
		var body: StaticBody3D = StaticBody3D.new()
		var holder: CollisionShape3D = CollisionShape3D.new()
		holder.shape = shape
		body.add_child(holder)
		_put(body)
		for node: Node3D in [holder, body]:
			var corners: PackedVector3Array = found.find(node, _session.node).corners
			check(not corners.is_empty(), "%s has no triangles." % shape.get_class())
			if shape is BoxShape3D or shape is SphereShape3D:
				check(_volume(corners) > 0.1, "%s is inside out." % shape.get_class())
	var csg: CSGBox3D = CSGBox3D.new()
	_put(csg)
	await tree.process_frame
	await tree.process_frame
	check_near(
		_volume(found.find(csg, _session.node).corners), 1.0, 1e-3, "the volume of a CSG box"
	)
	# A group, of which each part is where it is.
	var group: Node3D = Node3D.new()
	_put(group)
	for i: int in 2:
		var part: MeshInstance3D = MeshInstance3D.new()
		part.mesh = BoxMesh.new()
		group.add_child(part)
		part.position.x = 3.0 * i
	check_near(
		_volume(found.find(group, _session.node).corners), 2.0, 1e-3, "the volume of a group"
	)
	_close()


static func _volume(corners: PackedVector3Array) -> float:
	var sum: float = 0.0
	for i: int in range(0, corners.size(), 3):
		sum += corners[i].dot(corners[i + 1].cross(corners[i + 2])) / 6.0
	return sum


func test_what_can_be_no_obstacle_gets_a_sentence() -> void:
	var of: TreeReconstruction = GrownBark.stout()
	_begin(of)
	var marker: Marker3D = Marker3D.new()
	_put(marker)
	var flat: MeshInstance3D = _box(0.5)
	flat.scale = Vector3(1.0, 0.0, 1.0)
	var large: MeshInstance3D = MeshInstance3D.new()
	var sphere: SphereMesh = SphereMesh.new()
	sphere.radial_segments = 400
	sphere.rings = 300
	large.mesh = sphere
	_put(large)
	var plain: Node = Node.new()
	_put(plain)
	var below: MeshInstance3D = MeshInstance3D.new()
	below.mesh = BoxMesh.new()
	_session.node.add_child(below)
	for pair: Array in [
		[marker, "no triangles"],
		[flat, "scale of 0"],
		[large, "240800 triangles"],
		[plain, "no place"],
		[below, "belongs to the tree"],
		[_session.node, "belongs to the tree"],
	]:
		_said.clear()
		check(not _work().scene.add(pair[0] as Node), "It is an obstacle: %s" % pair[1])
		check(pair[1] in str(_said), str(_said))
	check_equal(_work().get_recipe().get_features().size(), 0, "features")
	# Where the trunk begins nothing can grow.
	var stone: MeshInstance3D = _box(-0.05)
	stone.position.y = 0.0
	_said.clear()
	check(_work().scene.add(stone), str(_said))
	await _grow()
	check("where the trunk begins" in str(_said), str(_said))
	check(not of.has_grown_bark(), "It has grown.")
	_close()
