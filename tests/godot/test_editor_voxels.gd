extends "./suite.gd"
## The voxels of the scan as a layer of the view.

const Session := preload("res://addons/tree_reconstruction/editor/session.gd")
const AllTools := preload("res://addons/tree_reconstruction/editor/tools/all_tools.gd")
const VoxelView := preload("res://addons/tree_reconstruction/editor/viewport/voxel_view.gd")


# The sides that show of random boxes, counted another way.
func test_voxels_show_the_sides_that_nothing_hides() -> void:
	var random: RandomNumberGenerator = RandomNumberGenerator.new()
	for trial: int in 20:
		random.seed = trial
		var cells: Dictionary[Vector3i, bool] = {Vector3i.ZERO: true, Vector3i(7, 7, 7): true}
		var points: PackedVector3Array = [Vector3.ZERO, Vector3(7.5, 7.5, 7.5)]
		for i: int in random.randi_range(1, 300):
			var cell: Vector3i = Vector3i(
				random.randi_range(0, 7), random.randi_range(0, 7), random.randi_range(0, 7)
			)
			cells[cell] = true
			points.append(Vector3(cell) + Vector3.ONE * random.randf_range(0.1, 0.4))
		var made: Array = VoxelView.build(points, 1.0)
		check_equal(made[0], 1.0, "the edge")
		check_equal(made[1], cells.size(), "voxels")
		var sides: int = 6 * cells.size()
		for cell: Vector3i in cells:
			for axis: Vector3i in [Vector3i.RIGHT, Vector3i.UP, Vector3i.BACK]:
				sides -= 2 if cells.has(cell + axis) else 0
		var places: PackedVector3Array = made[2][Mesh.ARRAY_VERTEX]
		var normals: PackedVector3Array = made[2][Mesh.ARRAY_NORMAL]
		var indices: PackedInt32Array = made[2][Mesh.ARRAY_INDEX]
		check_equal(places.size(), 4 * sides, "corners")
		check_equal(indices.size(), 6 * sides, "indices")
		for t: int in range(0, indices.size(), 3):
			var a: Vector3 = places[indices[t]]
			var turn: Vector3 = (places[indices[t + 2]] - a).cross(places[indices[t + 1]] - a)
			# The engine's front faces are clockwise.
			check(turn.normalized().is_equal_approx(normals[indices[t]]), "A side faces inward.")
	check_equal(VoxelView.build([], 1.0)[1], 0, "voxels of nothing")


func test_voxels_are_a_layer_apart_from_the_tools() -> void:
	var node: TreeInstance3D = TreeInstance3D.new()
	node.reconstruction = grown_tree(3)
	tree.root.add_child(node)
	var undo: UndoRedo = UndoRedo.new()
	var session: Session = Session.new(undo)
	AllTools.add_to(session)
	session.edit_node(node)
	var view: VoxelView = VoxelView.new(session)
	view.update()
	check(not view.layer.shown, "Voxels are shown that nobody asked for.")
	session.scan.points = [Vector3.ZERO, Vector3(0, 2, 0), Vector3(0, 1, 1)]
	session.view.voxels = true
	view.update()
	while not session.jobs.get_running().is_empty():
		await tree.process_frame
		session.jobs.update()
	check(view.layer.shown and view.layer.mesh.get_surface_count() == 1, "No voxels are shown.")
	check_equal(view.count, 3, "voxels")
	view.update()
	check(session.jobs.get_running().is_empty(), "Voxels that are there are built again.")
	session.choose(&"flood")
	session.choose(&"select")
	view.update()
	check(view.layer.shown, "A tool takes the voxels away.")
	session.view.voxels = false
	view.update()
	check(not view.layer.shown, "Voxels are still shown.")
	session.shut_down()
	session.choose(&"")
	session.tools.clear()
	undo.clear_history()
	undo.free()
	node.free()
