extends "./session_suite.gd"
## The colors of leaves that photos gave, as a material of the project.

const PhotoLeaves := preload("res://addons/tree_reconstruction/editor/photos/photo_leaves.gd")
const PhotosPart := preload("res://addons/tree_reconstruction/editor/photos/part.gd")
const OAK: String = "res://addons/tree_reconstruction/presets/oak_leaf.tres"
const TARGET: String = "res://leaf_test_tree.res"


static func _colors(albedo: Array) -> Dictionary:
	return {
		"from": "photos",
		"albedo": albedo,
		"least_green": [albedo[0] * 1.1, albedo[1] * 0.95, albedo[2]],
		"greenest": [albedo[0] * 0.9, albedo[1] * 1.05, albedo[2]],
		"low": [0.9, 1.0, 1.1],
		"high": [1.1, 1.0, 0.9],
		"low_height_m": 1.0,
		"high_height_m": 3.0,
	}


func _clean() -> void:
	for name: String in DirAccess.get_files_at("res://"):
		if name.begins_with("leaf_test_tree"):
			DirAccess.remove_absolute("res://" + name)


# The mean light of its opaque pixels.
func _mean_of(texture: Texture2D) -> Array:
	var image: Image = texture.get_image()
	if image.is_compressed():
		image.decompress()
	var sum: Vector3 = Vector3.ZERO
	var count: int = 0
	for y: int in image.get_height():
		for x: int in image.get_width():
			var stored: Color = image.get_pixel(x, y)
			if stored.a8 >= 102:
				var light: Color = stored.srgb_to_linear()
				sum += Vector3(light.r, light.g, light.b)
				count += 1
	return [sum.x / count, sum.y / count, sum.z / count]


func test_hostile_pictures_have_a_gain_of_one() -> void:
	expected_errors = ["four bytes each", "The mean must be finite."]
	for pixels: PackedByteArray in [PackedByteArray(), PackedByteArray([1, 2, 3])]:
		check_equal(TreeReconstructor.get_picture_gain(pixels, Vector3.ONE), Vector3.ONE, "a gain")
	var green: PackedByteArray = [0, 200, 0, 255]
	check_equal(TreeReconstructor.get_picture_gain(green, Vector3(NAN, 0, 0)), Vector3.ONE, "NaN")


func test_the_picture_is_multiplied_to_the_mean() -> void:
	var made: TreeReconstruction = grown_tree(2)
	made.leaf_preset = "oak"
	# The picture's own mean: nothing is to be multiplied.
	var drawn: ShaderMaterial = load(OAK)
	var own: Array = _mean_of(drawn.get_shader_parameter(&"albedo_texture"))
	var plain: Dictionary = _colors(own)
	plain["least_green"] = own
	var gain: Vector3 = PhotoLeaves.make(plain, made).get_shader_parameter(&"picture_gain")
	check((gain - Vector3.ONE).length() < 0.02, "It is multiplied by %s." % gain)
	# Twice the red light, and no more of the others.
	plain["albedo"] = [2.0 * own[0], own[1], own[2]]
	plain["least_green"] = plain["albedo"]
	var material: ShaderMaterial = PhotoLeaves.make(plain, made)
	gain = material.get_shader_parameter(&"picture_gain")
	check_near(gain.x, pow(2.0, 1.0 / 2.2), 0.05, "the gain of red")
	check_near(gain.y, 1.0, 0.02, "the gain of green")
	var low: Vector3 = material.get_shader_parameter(&"low_gain")
	var high: Vector3 = material.get_shader_parameter(&"high_gain")
	check(low.x < 0.98 and high.x > 1.02, "Red goes from %.2f to %.2f." % [low.x, high.x])
	check_near(low.y, 1.0, 0.001, "green below")
	var heights: Vector2 = material.get_shader_parameter(&"gain_heights")
	check_near(heights.y / heights.x, 3.0, 0.001, "from where to where it goes")
	check_near(heights.y * made.get_aabb().end.y, 3.0, 0.01, "the height above")
	for uniform: StringName in [&"flutter", &"normal_texture", &"albedo_texture"]:
		check_equal(
			material.get_shader_parameter(uniform), drawn.get_shader_parameter(uniform), uniform
		)


func test_a_file_keeps_them() -> void:
	_clean()
	var made: TreeReconstruction = grown_tree(2)
	made.leaf_preset = "birch"
	var material: ShaderMaterial = PhotoLeaves.make(_colors([0.2, 0.1, 0.03]), made)
	# A name that is taken is left alone.
	check_equal(PhotoLeaves.save(material, TARGET), OK, "saving")
	check_equal(material.resource_path, "res://leaf_test_tree_leaves.res", "its file")
	check_equal(PhotoLeaves.free_path(TARGET), "res://leaf_test_tree_leaves_2.res", "another's")
	PhotoLeaves.give(made, material)
	check_equal(ResourceSaver.save(made, TARGET, ResourceSaver.FLAG_COMPRESS), OK, "the tree")
	var again: TreeReconstruction = ResourceLoader.load(
		TARGET, "", ResourceLoader.CACHE_MODE_IGNORE_DEEP
	)
	var read: ShaderMaterial = PhotoLeaves.of(again) as ShaderMaterial
	check(read != null and read != material, "The tree's file has forgotten its leaves.")
	if read != null:
		check(PhotoLeaves.is_made(read), "It has forgotten what was measured.")
		check(not PhotoLeaves.is_outdated(read, again), "It is for other leaves.")
		check_equal(
			read.get_shader_parameter(&"picture_gain"),
			material.get_shader_parameter(&"picture_gain"),
			"what the picture is multiplied by"
		)
		# The picture is the addon's own, and not copied.
		check(
			FileAccess.get_file_as_bytes(read.resource_path).size() < 20_000,
			"It has pictures in it."
		)
	_clean()


func test_leaves_go_with_their_tree() -> void:
	var own: TreeReconstruction = grown_tree(2)
	own.leaf_preset = "oak"
	var material: ShaderMaterial = PhotoLeaves.make(_colors([0.1, 0.14, 0.03]), own)
	PhotoLeaves.give(own, material)
	check_equal(PhotoLeaves.of(Session.LocalTrees.copy_of(own)), material, "a copy's leaves")
	var session: Session = _session_with(own)
	session.node.leaf_material = material
	session.replace_tree("Reconstruct Again", grown_tree(3))
	check_equal(PhotoLeaves.of(session.tree), material, "the leaves after another reconstruction")
	check_equal(session.node.leaf_material, material, "those of its node")
	_undo.undo()
	check_equal(PhotoLeaves.of(session.tree), material, "its leaves after undo")
	PhotoLeaves.give(own, null)
	check(PhotoLeaves.of(own) == null, "It still knows them.")
	_end(session)


# Another kind of leaves is one step, and gets the same colors; so does undoing it.
func test_other_leaves_are_suited() -> void:
	_clean()
	var own: TreeReconstruction = grown_tree(2)
	own.leaf_preset = "oak"
	var material: ShaderMaterial = PhotoLeaves.make(_colors([0.1, 0.14, 0.03]), own)
	check_equal(PhotoLeaves.save(material, TARGET), OK, "saving")
	var session: Session = _session_with(own)
	session.node.leaf_material = material
	var oak: Texture2D = material.get_shader_parameter(&"albedo_texture")
	var gain: Vector3 = material.get_shader_parameter(&"picture_gain")
	session.set_value("Leaf Preset", session.tree, &"leaf_preset", "pine")
	PhotosPart.suit_leaves(session)
	var pine: Texture2D = material.get_shader_parameter(&"albedo_texture")
	check(pine.resource_path.ends_with("/pine_sprays_albedo.png"), "It shows " + pine.resource_path)
	check(material.get_shader_parameter(&"picture_gain") != gain, "It is multiplied as an oak's.")
	var file: ShaderMaterial = ResourceLoader.load(
		material.resource_path, "", ResourceLoader.CACHE_MODE_IGNORE_DEEP
	)
	check_equal(
		file.get_shader_parameter(&"albedo_texture").resource_path, pine.resource_path, "file"
	)
	_undo.undo()
	PhotosPart.suit_leaves(session)
	check_equal(material.get_shader_parameter(&"albedo_texture"), oak, "after undo")
	check_equal(material.get_shader_parameter(&"picture_gain"), gain, "its gain after undo")
	# A material of the user's own is left alone.
	var users: ShaderMaterial = load(OAK)
	users = users.duplicate()
	session.node.leaf_material = users
	session.set_value("Leaf Preset", session.tree, &"leaf_preset", "pine")
	PhotosPart.suit_leaves(session)
	check_equal(users.get_shader_parameter(&"albedo_texture"), oak, "the user's own")
	_end(session)
	_clean()
