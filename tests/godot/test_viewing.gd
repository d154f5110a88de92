extends "./suite.gd"
## What an editor asks of a tree: what lies under the pointer, and what an edit would do.

const VIEWPORT: Vector2 = Vector2(800, 600)


## The tree as a camera at `eye` sees it that looks at its middle.
func _look(made: TreeReconstruction, eye: Vector3) -> Projection:
	var camera: Transform3D = Transform3D(Basis.IDENTITY, eye)
	camera = camera.looking_at(made.get_aabb().get_center())
	var lens: Projection = Projection.create_perspective(60.0, VIEWPORT.aspect(), 0.05, 100.0)
	return lens * Projection(camera.affine_inverse())


func _on_screen(to_screen: Projection, place: Vector3) -> Vector2:
	var clip: Vector4 = to_screen * Vector4(place.x, place.y, place.z, 1.0)
	var middle: Vector2 = VIEWPORT / 2.0
	return middle + Vector2(clip.x, -clip.y) / clip.w * middle


func test_nodes_are_picked_where_they_are_seen() -> void:
	var made: TreeReconstruction = grown_tree(1, 60)
	var to_screen: Projection = _look(made, Vector3(3, 4, 8))
	for id: int in made.get_node_ids():
		var at: Vector2 = _on_screen(to_screen, made.get_node_position(id))
		var got: int = made.pick_node(to_screen, VIEWPORT, at)
		check(got != TreeReconstruction.NO_NODE, "Nothing was picked at node %d." % id)
		if got != TreeReconstruction.NO_NODE:
			var seen: Vector2 = _on_screen(to_screen, made.get_node_position(got))
			check(seen.distance_to(at) <= 2.1, "%d was picked at node %d." % [got, id])
	check_equal(
		made.pick_node(to_screen, VIEWPORT, Vector2(5, 5), 3.0), TreeReconstruction.NO_NODE, "sky"
	)


func test_a_rectangle_picks_what_is_in_it() -> void:
	var made: TreeReconstruction = grown_tree(2, 200)
	var to_screen: Projection = _look(made, Vector3(-6, 2, 3))
	var rect: Rect2 = Rect2(VIEWPORT * 0.5, VIEWPORT * 0.4)
	var wanted: PackedInt32Array = []
	for id: int in made.get_node_ids():
		if rect.has_point(_on_screen(to_screen, made.get_node_position(id))):
			wanted.append(id)
	wanted.sort()
	check(wanted.size() > 3, "There is nothing to pick.")
	check_equal(made.pick_nodes(to_screen, VIEWPORT, rect), wanted, "the nodes in the rectangle")
	var turned: Rect2 = Rect2(rect.end, -rect.size)
	check_equal(made.pick_nodes(to_screen, VIEWPORT, turned), wanted, "from the other corner")


func test_selection_lines() -> void:
	var made: TreeReconstruction = grown_tree(3, 50)
	var lines: Array = made.build_selection_lines([5, 0, 9999, 7])
	check_equal(
		lines[Mesh.ARRAY_VERTEX],
		PackedVector3Array(
			[
				made.get_node_position(made.get_node_parent(5)),
				made.get_node_position(5),
				made.get_node_position(made.get_node_parent(7)),
				made.get_node_position(7)
			]
		),
		"the lines"
	)
	var mesh: ArrayMesh = ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_LINES, lines)
	check_equal(mesh.get_surface_count(), 1, "surfaces")
	check(made.build_selection_lines([0, -1]).is_empty(), "The root has wood.")


func test_a_preview_changes_nothing() -> void:
	var made: TreeReconstruction = grown_tree(4)
	var before: Dictionary = made.skeleton
	var changes: Array[int] = [0]
	made.changed.connect(func() -> void: changes[0] += 1)
	var leaf: int = made.get_leaves()[0]
	var command: String = "graft node=%d twig=oak seed=3" % leaf
	var preview: Dictionary = made.preview_edit(command)
	check_equal(preview["error"], "", "the error")
	check_equal(made.skeleton, before, "the tree")
	check_equal(changes[0], 0, "signals")
	var edit: TreeEdit = made.edit(command)
	check(edit != null, "It was not grafted.")
	if edit != null:
		check_equal(preview["message"], edit.get_message(), "the message")
		check_equal(
			preview["added"].size(), 2 * edit.get_added_nodes().size(), "the ends of added wood"
		)
		check_equal(preview["added_radii"].size(), edit.get_added_nodes().size(), "their radii")
	var gone: Dictionary = made.preview_edit("remove nodes=below:%d" % made.get_branch_nodes()[2])
	check(gone["added"].is_empty() and gone["removed"].size() > 4, "%s" % gone["error"])
	check_sentence(made.preview_edit("prune factor=-3")["error"], "a refusal")
	check_sentence(TreeReconstruction.new().preview_edit("prune")["error"], "for an empty tree")


func test_the_picture() -> void:
	var made: TreeReconstruction = grown_tree(5)
	made.leaf_preset = "oak"
	for size: int in [16, 64, 256]:
		var image: Image = Image.create_from_data(
			size, size, false, Image.FORMAT_RGBA8, made.draw(size)
		)
		check(not image.is_invisible(), "Nothing is seen at %d pixels." % size)
		check_equal(image.get_pixel(0, size - 1).a, 0.0, "the alpha beside the tree")
	var leafy: PackedByteArray = made.draw()
	check_equal(leafy.size(), 128 * 128 * 4, "the usual size")
	made.leaf_rule = LeafRule.from_preset("maple")
	var summer: PackedByteArray = made.draw()
	made.leaf_rule.season = 0.75
	check(made.draw() != summer, "Autumn looks like summer.")
	made.leaf_rule = LeafRule.from_preset("none")
	check(made.draw() != leafy, "The leaves make no difference.")
	expect_error("pixels wide")
	check(made.draw(7).is_empty(), "A tiny picture was drawn.")
	check_equal(TreeReconstruction.new().draw(32).count(0), 32 * 32 * 4, "an empty tree")


func test_orders_of_branching() -> void:
	var made: TreeReconstruction = grown_tree(5)
	for order: int in 4:
		for id: int in made.select_nodes("order:%d" % order):
			check_equal(made.get_node_order(id), order, "the order of node %d" % id)
	check_equal(made.get_node_order(made.get_root()), 0, "the root's order")
	expect_error("no node 99999")
	check_equal(made.get_node_order(99999), -1, "the order of no node")
