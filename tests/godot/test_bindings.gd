extends "./suite.gd"
## How the native classes behave as classes of the engine. It holds with our own bindings and with
## godot-cpp alike.


class Scripted:
	extends TreeReconstruction
	var note: String = "mine"


func test_wrong_numbers_of_arguments_are_errors() -> void:
	var made: TreeReconstruction = grown_tree(1, 20)
	for call: Array in [
		["get_node_position", []], ["get_node_position", [0, 1]], ["build_mesh", [0, 1, 2]]
	]:
		expect_error("TreeReconstruction::%s': Method expected" % call[0])
		check_equal(made.callv(call[0], call[1]), null, "%s%s" % call)
	check_equal(made.get_node_count(), 20, "the nodes afterwards")


func test_null_for_an_object() -> void:
	var path: String = folder.path_join("tree.txt")
	expect_error("no tree")
	check_equal(TreeReconstructor.new().export_file(null, path), ERR_INVALID_PARAMETER, "null")
	check(not FileAccess.file_exists(path), "Something was written.")


func test_default_arguments() -> void:
	var made: TreeReconstruction = grown_tree(2)
	check_equal(made.build_mesh_arrays(), made.build_mesh_arrays(0), "by a direct call")
	check_equal(made.callv("build_mesh_arrays", []), made.build_mesh_arrays(0), "by name")
	check_equal(
		TreeReconstruction.build_leaf_card_arrays(),
		TreeReconstruction.build_leaf_card_arrays(0),
		"of a static method"
	)
	var coarse: Array = made.build_mesh_arrays(2)
	check(
		coarse[Mesh.ARRAY_VERTEX].size() < made.build_mesh_arrays()[Mesh.ARRAY_VERTEX].size(),
		"The argument did not arrive."
	)


func test_both_kinds_of_calls_agree() -> void:
	var made: TreeReconstruction = grown_tree(3)
	var untyped: Variant = made
	check_equal(untyped.get_positions(), made.get_positions(), "get_positions()")
	check_equal(untyped.get_node_position(5), made.get_node_position(5), "get_node_position()")
	check_equal(made.call("get_aabb"), made.get_aabb(), "get_aabb()")
	check_equal(Callable(made, "is_trunk").call(1), made.is_trunk(1), "is_trunk()")
	check_equal(made.callv("get_node_radius", [5]), made.get_node_radius(5), "get_node_radius()")


func test_enumerations_are_known_to_scripts() -> void:
	check_equal(
		ClassDB.class_get_enum_constants("TreeReconstruction", "NodeKind", true),
		PackedStringArray(
			["NODE_KIND_LEAF", "NODE_KIND_BRANCH", "NODE_KIND_COMMON", "NODE_KIND_TRUNK"]
		),
		"NodeKind"
	)
	var kind: TreeReconstruction.NodeKind = grown_tree(4, 5).get_node_kind(4)
	check_equal(kind, TreeReconstruction.NODE_KIND_LEAF, "the kind of a tip")
	var kind_method: Array[Dictionary] = ClassDB.class_get_method_list("TreeReconstruction", true)
	kind_method.assign(kind_method.filter(_is_named.bind("get_node_kind")))
	check_equal(kind_method[0].return.class_name, &"TreeReconstruction.NodeKind", "its type")


func _is_named(method: Dictionary, name: String) -> bool:
	return method.name == name


func test_properties_tell_the_inspector_what_they_are() -> void:
	var hints: Dictionary[String, Dictionary] = {}
	for property: Dictionary in TreeReconstruction.new().get_property_list():
		hints[property.name] = property
	check_equal(hints["leaf_preset"].hint, PROPERTY_HINT_ENUM, "the hint of leaf_preset")
	check_equal(
		hints["leaf_preset"].hint_string,
		",".join(TreeReconstruction.get_leaf_preset_names()),
		"the choices of leaf_preset"
	)
	check("suffix:°" in hints["leaf_angle"].hint_string, "The unit of leaf_angle is missing.")
	check_equal(hints["skeleton"].usage & PROPERTY_USAGE_EDITOR, 0, "showing the skeleton")


func test_references_are_counted() -> void:
	var made: TreeReconstruction = grown_tree(5)
	var watch: WeakRef = weakref(made)
	check_equal(made.get_reference_count(), 1, "owners of a new one")
	check_equal(made.build_mesh().get_reference_count(), 1, "owners of a built mesh")
	check_equal(made.build_leaves().get_reference_count(), 1, "owners of built leaves")
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	check_equal(reconstructor.get_raw_skeleton().get_reference_count(), 1, "owners of a raw one")
	reconstructor.export_file(made, folder.path_join("tree.txt"))
	reconstructor.callv("export_file", [made, folder.path_join("tree.txt")])
	check_equal(made.get_reference_count(), 1, "owners after it was an argument")
	var copy: TreeReconstruction = made.duplicate() as TreeReconstruction
	check_equal(copy.get_reference_count(), 1, "owners of a copy")
	made = null
	check(watch.get_ref() == null, "It outlived its last owner.")


func test_scripts_can_extend_a_native_class() -> void:
	var made: Scripted = Scripted.new()
	made.skeleton = grown_tree(6, 30).skeleton
	made.seed = 9
	check_equal(made.get_node_count(), 30, "the nodes")
	check_equal(made.note, "mine", "the script's own member")
	check_equal(made.get("seed"), 9, "a native property")
	check(made.is_class("TreeReconstruction"), "The native class is lost.")


func test_changes_are_signalled_once_each() -> void:
	var made: TreeReconstruction = grown_tree(7)
	var count: Array[int] = [0]
	made.changed.connect(func() -> void: count[0] += 1)
	made.skeleton = grown_tree(8).skeleton
	made.seed = 5
	made.leaf_size = 0.3
	made.leaf_preset = "oak"
	check_equal(count[0], 4, "signals for four changes")


func test_building_on_threads_while_the_tree_changes() -> void:
	var made: TreeReconstruction = grown_tree(9)
	var wanted: Array[Array] = []
	var skeletons: Array[Dictionary] = []
	for i: int in 3:
		made.skeleton = grown_tree(10 + i).skeleton
		skeletons.append(made.skeleton)
		wanted.append(made.build_mesh_arrays())
	var results: Array[Array] = []
	results.resize(40)
	var build: Callable = func(i: int) -> void: results[i] = made.build_mesh_arrays()
	var task: int = WorkerThreadPool.add_group_task(build, results.size())
	for i: int in 200:
		made.skeleton = skeletons[i % 3]
	WorkerThreadPool.wait_for_group_task_completion(task)
	for result: Array in results:
		check(result in wanted, "A mesh is of no tree that there was.")


func test_objects_are_made_on_threads() -> void:
	var counts: Array[int] = []
	counts.resize(40)
	var stored: Dictionary = grown_tree(13, 50).skeleton
	var make: Callable = func(i: int) -> void:
		var made: TreeReconstruction = TreeReconstruction.new()
		made.skeleton = stored
		counts[i] = made.build_mesh().get_surface_count() + made.get_node_count()
	var task: int = WorkerThreadPool.add_group_task(make, counts.size())
	WorkerThreadPool.wait_for_group_task_completion(task)
	for count: int in counts:
		check_equal(count, 51, "a surface and 50 nodes")
