extends "./session_suite.gd"
## Trees that several nodes show: the user is asked, once, what an edit should change.

var _asked: Array[Array] = []


# Sessions that are asked, on a tree that so many nodes show besides the edited one.
func _shared_session(made: TreeReconstruction, others: int) -> Session:
	var session: Session = _session_with(made)
	for i: int in others:
		_add_node(made)
	_asked = []
	session.consent.ask = func(nodes: Array[Node], again: Callable) -> void:
		_asked.append([nodes, again])
	return session


func _add_node(made: TreeReconstruction) -> TreeInstance3D:
	var node: TreeInstance3D = TreeInstance3D.new()
	node.reconstruction = made
	tree.root.add_child(node)
	return node


func _end_all(session: Session) -> void:
	for other: Node in tree.root.get_children():
		if other is TreeInstance3D and other != session.node:
			other.free()
	_end(session)


# What was asked last is answered, and the edit goes on.
func _go_on() -> void:
	(_asked[-1][1] as Callable).call()


func test_nothing_changes_before_the_answer() -> void:
	var made: TreeReconstruction = grown_tree(3)
	var before: Dictionary = made.skeleton
	var session: Session = _shared_session(made, 2)
	check(session.run("Prune", "prune_order order=1") == null, "It was done.")
	session.begin_drag("Move")
	check(not session.drag("move nodes=%d by=1,0,0" % made.get_leaves()[0]), "It was dragged.")
	check(session.end_drag() == null, "The drag did something.")
	session.set_value("Leaves", made, &"leaf_size", 0.123)
	session.replace_tree("Again", grown_tree(4))
	check_equal(_asked.size(), 4, "questions")
	check_equal((_asked[0][0] as Array).size(), 2, "nodes that are told")
	check(session.node not in _asked[0][0], "The edited node is among them.")
	check_equal(made.skeleton, before, "the tree")
	check(absf(made.leaf_size - 0.123) > 1e-6, "The leaves were changed.")
	check_equal(_undo.get_history_count(), 0, "steps")
	_end_all(session)


func test_a_unique_tree_leaves_the_others_as_they_are() -> void:
	for seed: int in 5:
		var made: TreeReconstruction = grown_tree(seed)
		var before: Dictionary = made.skeleton
		var session: Session = _shared_session(made, 1)
		session.run("Prune", "prune_order order=1")
		session.make_unique()
		_go_on()
		check(session.tree != made, "It is the same tree.")
		check(session.tree.get_node_count() < made.get_node_count(), "It was not pruned.")
		check_equal(made.skeleton, before, "the tree of the other node")
		check_equal(_undo.get_history_count(), 2, "steps")
		# It is nobody else's now.
		session.run("Smooth", "smooth_radii rounds=1")
		check_equal(_asked.size(), 1, "questions")
		while _undo.undo():
			pass
		check_equal(session.tree, made, "the tree after undo")
		check_equal(made.skeleton, before, "its wood")
		_end_all(session)


func test_who_agrees_is_asked_once_for_these_nodes() -> void:
	var made: TreeReconstruction = grown_tree(3)
	var session: Session = _shared_session(made, 1)
	session.set_value("Leaves", made, &"leaf_size", 0.123)
	session.consent.agree(session.tree, session.node)
	_go_on()
	check_near(made.leaf_size, 0.123, 1e-6, "the size of the leaves")
	check_equal(session.tree, made, "the tree")
	check(session.run("Prune", "prune_order order=2") != null, "It was not done.")
	check_equal(_asked.size(), 1, "questions")
	var third: TreeInstance3D = _add_node(made)
	check(session.run("Smooth", "smooth_radii rounds=1") == null, "A new node was not asked about.")
	check(third in _asked[-1][0], "The new node is not told.")
	_end_all(session)


func test_a_tree_of_one_node_asks_nothing() -> void:
	var session: Session = _shared_session(grown_tree(3), 0)
	_add_node(grown_tree(4))
	check(session.run("Prune", "prune_order order=1") != null, "It was not done.")
	check_equal(_asked.size(), 0, "questions")
	_end_all(session)
