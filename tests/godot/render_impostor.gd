extends "./picture_suite.gd"
## An impostor looks like its tree, in the renderer that this run uses.

const Session := preload("res://addons/tree_reconstruction/editor/session.gd")
const Impostor := preload("res://addons/tree_reconstruction/editor/dock/impostor.gd")
const Files := preload("res://addons/tree_reconstruction/editor/dock/files.gd")
const PlainMaterials := preload("res://addons/tree_reconstruction/baking/plain_materials.gd")
const SIZE: Vector2i = Vector2i(192, 192)
# The mean colors of the pictures that an impostor keeps, and of its tree in the sun, whichever
# renderer it is.
const KEPT: Color = Color(0.368, 0.413, 0.216)
const IN_THE_SUN: Color = Color(0.370, 0.426, 0.222)


# From as far as impostors are seen, with a lens that fills the picture.
func _look(center: Vector3, reach: float, pitch: float, yaw: float) -> void:
	var axes: Basis = Basis.from_euler(Vector3(deg_to_rad(-pitch), deg_to_rad(yaw), 0.0))
	var away: float = 14.0 * reach
	_camera.transform = Transform3D(axes, center + axes.z * away)
	_camera.fov = rad_to_deg(2.0 * asin(1.1 * reach / away))
	_camera.far = 2.0 * away


func _card(mesh: Mesh, place: Transform3D) -> MeshInstance3D:
	var card: MeshInstance3D = MeshInstance3D.new()
	card.mesh = mesh
	card.transform = place
	_viewport.add_child(card)
	RenderingServer.instance_geometry_set_shader_parameter(card.get_instance(), &"tree_wind", 0.0)
	return card


func test_an_impostor_looks_like_its_tree() -> void:
	var made: TreeReconstruction = grown_tree(2)
	made.leaf_rule = LeafRule.from_preset("maple")
	var baker: TreeImpostorBaker = TreeImpostorBaker.new()
	baker.resolution = 512
	baker.views = 6
	var children: int = tree.root.get_child_count()
	var impostor: TreeImpostor = await baker.bake(made)
	check(impostor != null, baker.get_error_message())
	if impostor == null:
		return
	check_equal(baker.get_progress(), 1.0, "the progress")
	check(impostor.is_of(made), "It is of another tree.")
	await tree.process_frame
	check_equal(tree.root.get_child_count(), children, "what is left in the scene")

	# What is saved is the same.
	var path: String = folder.path_join("oak.impostor.res")
	check_equal(ResourceSaver.save(impostor, path, ResourceSaver.FLAG_COMPRESS), OK, "saving")
	impostor = load(path) as TreeImpostor

	_open_stage(SIZE)
	var center: Vector3 = impostor.box.get_center()
	var reach: float = 0.5 * impostor.box.size.length()
	var live: TreeInstance3D = await _show_tree(made, false)
	var card: MeshInstance3D = _card(impostor.get_mesh(), Transform3D.IDENTITY)
	for way: Vector2 in [Vector2(2.0, 0.0), Vector2(25.0, 100.0), Vector2(60.0, 230.0)]:
		_look(center, reach, way.x, way.y)
		live.visible = true
		card.visible = false
		var wanted: Image = await _picture()
		live.visible = false
		var empty: Image = await _picture()
		card.visible = true
		var given: Image = await _picture()
		var nothing: float = _difference(wanted, empty)
		var difference: float = _difference(wanted, given)
		var of: Array = _summary(wanted)
		var shown: Array = _summary(given)
		check(of[0] > 0.05, "There is no tree in the picture from %s." % way)
		check(difference < 0.45 * nothing, "From %s: %.3f of %.3f." % [way, difference, nothing])
		check_near(shown[0], of[0], 0.15 * of[0], "how much of the picture it covers from %s" % way)
		for channel: int in 3:
			check_near(
				shown[1][channel], of[1][channel], 0.05, "channel %d from %s" % [channel, way]
			)
		if way.y == 0.0:
			_check_color(of[1], IN_THE_SUN, "the tree's color")
	_check_color(_kept_color(impostor), KEPT, "the color that the impostor keeps")
	await _check_places(impostor, card, center, reach)
	await _check_wind(card, 1.7 * impostor.height)
	_viewport.free()


func _check_color(given: Color, wanted: Color, what: String) -> void:
	for channel: int in 3:
		check_near(given[channel], wanted[channel], 0.01, "channel %d of %s" % [channel, what])


static func _kept_color(impostor: TreeImpostor) -> Color:
	var texture: Texture2D = impostor.material.get_shader_parameter(&"albedo_texture")
	var picture: Image = texture.get_image()
	picture.decompress()
	var sum: Color = Color(0.0, 0.0, 0.0)
	var count: int = 0
	for y: int in range(0, picture.get_height(), 3):
		for x: int in range(0, picture.get_width(), 3):
			var pixel: Color = picture.get_pixel(x, y)
			if pixel.a > 0.5:
				sum += pixel
				count += 1
	return sum / maxf(count, 1.0)


# Turned and scaled, alone and in a MultiMesh, it is the same.
func _check_places(
	impostor: TreeImpostor, card: MeshInstance3D, center: Vector3, reach: float
) -> void:
	var place: Transform3D = Transform3D(
		Basis.from_euler(Vector3(0.0, 1.1, 0.0)).scaled(Vector3.ONE * 1.7), Vector3(30.0, 4.0, -9.0)
	)
	_look(place * center, 1.7 * reach, 20.0, 75.0)
	card.transform = place
	var alone: Image = await _picture()
	card.visible = false
	check(_difference(alone, await _picture()) > 0.1, "It is gone where it was moved to.")
	var many: MultiMeshInstance3D = MultiMeshInstance3D.new()
	many.multimesh = MultiMesh.new()
	many.multimesh.transform_format = MultiMesh.TRANSFORM_3D
	many.multimesh.mesh = impostor.get_mesh()
	many.multimesh.instance_count = 2
	many.multimesh.set_instance_transform(0, Transform3D(Basis(), Vector3(0.0, -500.0, 0.0)))
	many.multimesh.set_instance_transform(1, place)
	_viewport.add_child(many)
	RenderingServer.instance_geometry_set_shader_parameter(many.get_instance(), &"tree_wind", 0.0)
	check(_difference(alone, await _picture()) < 0.005, "It is another one in a MultiMesh.")
	var still: Dictionary[StringName, Variant] = {&"tree_wind": 0.0}
	many.multimesh.mesh = impostor.make_mesh(PlainMaterials.plain(impostor.material, still, {}))
	check(_difference(alone, await _picture()) < 0.005, "Baked, it is another one.")
	many.free()
	card.visible = true


func _check_wind(card: MeshInstance3D, height: float) -> void:
	var server: Object = RenderingServer
	server.instance_geometry_set_shader_parameter(card.get_instance(), &"tree_height", height)
	var calm: Image = await _picture()
	check(_difference(calm, await _picture()) < 0.001, "It moves without wind.")
	server.instance_geometry_set_shader_parameter(card.get_instance(), &"tree_wind", 1.0)
	(card.mesh.surface_get_material(0) as ShaderMaterial).set_shader_parameter(
		&"wind_strength", 2.0
	)
	var moved: float = _difference(calm, await _picture())
	check(moved > 0.004, "The wind moves it by %.4f." % moved)


func test_baking_can_be_cancelled() -> void:
	var baker: TreeImpostorBaker = TreeImpostorBaker.new()
	baker.resolution = 512
	var children: int = tree.root.get_child_count()
	var ended: Array[bool] = [false]
	var bake: Callable = func() -> void: ended[0] = await baker.bake(grown_tree(2)) == null
	bake.call()
	while baker.get_progress() < 0.15:
		await tree.process_frame
	baker.cancel()
	for i: int in 4:
		await tree.process_frame
	check(ended[0], "It goes on.")
	check_equal(baker.get_error_message(), "", "the reason")
	check_equal(tree.root.get_child_count(), children, "what is left in the scene")


# The renderer's picture compressor is itself a task of the pool, which takes up others while it
# waits: a compression among those would wait for itself.
func test_a_busy_pool_does_not_stop_a_bake() -> void:
	var picture: Image = Image.create_empty(64, 64, false, Image.FORMAT_RGBA8)
	picture.compress(Image.COMPRESS_S3TC)
	var ended: Array[bool] = [false]
	# The compressor itself may take up one of these, and goes on when that ends.
	var released: int = Time.get_ticks_msec() + 20_000
	var occupy: Callable = func() -> void:
		while not ended[0] and Time.get_ticks_msec() < released:
			OS.delay_msec(5)
	var tasks: PackedInt64Array = []
	for i: int in OS.get_processor_count() - 1:
		tasks.append(WorkerThreadPool.add_task(occupy, true))
	var baker: TreeImpostorBaker = TreeImpostorBaker.new()
	baker.resolution = 512
	baker.views = 3
	var made: Array[TreeImpostor] = [null]
	var bake: Callable = func() -> void:
		made[0] = await baker.bake(grown_tree(2))
		ended[0] = true
	bake.call()
	# Standing still has no end; beside other engines a bake may take minutes.
	var until: int = Time.get_ticks_msec() + 300_000
	while not ended[0] and Time.get_ticks_msec() < until:
		await tree.process_frame
	check(made[0] != null, "It stands still while it is %s." % baker.get_stage())
	ended[0] = true
	for task: int in tasks:
		WorkerThreadPool.wait_for_task_completion(task)


func test_the_dock_bakes_and_undoes() -> void:
	var undo: UndoRedo = UndoRedo.new()
	var node: TreeInstance3D = TreeInstance3D.new()
	node.reconstruction = grown_tree(2)
	tree.root.add_child(node)
	var session: Session = Session.new(undo)
	session.edit_node(node)
	var dock: Impostor = Impostor.new(session, Files.new())
	dock.views = 3
	dock.size.select(0)
	var path: String = folder.path_join("oak.impostor.res")
	dock.bake_to(path)
	var most: float = 0.0
	while not session.jobs.get_running().is_empty():
		most = maxf(most, session.jobs.get_running()[0].progress)
		session.update()
		await tree.process_frame
	check(most > 0.3, "It says nothing of how far it is.")
	check_equal(node.impostor.resource_path, path, "the impostor's file")
	undo.undo()
	check_equal(node.impostor, null, "the impostor after undo")
	undo.redo()
	check_equal(node.impostor, load(path), "the impostor after redo")

	# Cancelled, it leaves all as it is.
	var other: String = folder.path_join("other.impostor.res")
	dock.bake_to(other)
	session.jobs.cancel(session.jobs.get_running()[0])
	while not session.jobs.get_running().is_empty():
		session.update()
		await tree.process_frame
	check(not FileAccess.file_exists(other), "A cancelled one is written.")
	check_equal(node.impostor.resource_path, path, "the impostor after a cancelled bake")
	await tree.process_frame
	session.shut_down()
	dock.button.free()
	dock.size.free()
	undo.clear_history()
	undo.free()
	node.free()
