extends "./suite.gd"
## Photos over the scene: the engine's camera sees what the photo's did, and the picture lies on it.

const PhotoModel := preload("./photo_model.gd")
const PhotoCamera := preload("res://addons/tree_reconstruction/editor/compare/photo_camera.gd")
const PhotoSource := preload("res://addons/tree_reconstruction/editor/compare/photo_source.gd")


# A tree whose scan is small enough for a Vector3.
func _tree_near_zero() -> TreeReconstruction:
	var made: TreeReconstruction = grown_tree(3)
	var kept: Dictionary = made.skeleton
	kept["frame"] = bits(PackedFloat64Array([3.0, -1.5, 2.25, 1.7]))
	made.skeleton = kept
	return made


func test_the_engine_sees_what_the_photo_shows() -> void:
	var made: TreeReconstruction = _tree_near_zero()
	var photos: PhotoModel = PhotoModel.new(folder, made)
	var worker: TreeReconstructor = TreeReconstructor.new()
	var views: Array[Dictionary] = worker.load_photo_views(made)
	check_equal(views.size(), PhotoModel.COUNT, "photos: " + worker.get_error_message())
	var viewport: SubViewport = SubViewport.new()
	var camera: Camera3D = Camera3D.new()
	viewport.add_child(camera)
	tree.root.add_child(viewport)
	var whole: Rect2 = Rect2(Vector2.ZERO, PhotoModel.SIZE)
	var frames: Array[Transform3D] = [
		Transform3D(),
		Transform3D(Basis(Vector3(1, 2, 0.5).normalized(), 1.1).scaled(Vector3.ONE * 2.5)),
		Transform3D(Basis(Vector3.UP, -2.0).scaled(Vector3.ONE * 0.2), Vector3(40, -3, 7)),
	]
	var worst: float = 0.0
	for i: int in views.size():
		check_equal(views[i]["name"], PhotoModel.name_of(i), "the name")
		for frame: Transform3D in frames:
			for shown: Rect2 in [whole, Rect2(60, 100, 80, 40), Rect2(-100, -50, 700, 500)]:
				viewport.size = Vector2i(shown.size * (2.0 if shown != whole else 1.0))
				PhotoCamera.place(camera, views[i], frame, shown)
				for id: int in range(0, made.get_node_count(), 20):
					var place: Vector3 = made.get_node_position(id)
					var wanted: Vector2 = photos.project(i, place, 0.0) - shown.position
					var at: Vector2 = camera.unproject_position(frame * place)
					at *= shown.size / Vector2(viewport.size)
					worst = maxf(worst, at.distance_to(wanted))
	check(worst < 0.1, "The engine's camera is off by up to %f pixels." % worst)
	viewport.free()


# What the lens bent lies where the engine's camera sees the tree's own place.
func test_the_picture_lies_on_the_scene() -> void:
	var made: TreeReconstruction = _tree_near_zero()
	var photos: PhotoModel = PhotoModel.new(folder, made)
	var worker: TreeReconstructor = TreeReconstructor.new()
	var view: Dictionary = worker.load_photo_views(made)[2]
	for id: int in [0, made.get_leaves()[0], made.get_leaves()[5]]:
		var place: Vector3 = made.get_node_position(id)
		var light: Vector2 = photos.project(2, place)
		var photo: Image = Image.create_empty(320, 400, false, Image.FORMAT_RGB8)
		for y: int in 400:
			for x: int in 320:
				var off: float = light.distance_squared_to(Vector2(x + 0.5, y + 0.5))
				photo.set_pixel(x, y, Color.WHITE * exp(-off / 9.0))
		photo.save_png(photos.photos.path_join("photo_2.png"))
		var read: Dictionary = worker.load_photo(view, photos.photos, 200)
		check_equal(read.get("size"), Vector2i(160, 200), worker.get_error_message())
		if read.is_empty():
			return
		check_near(read["scale"], 0.5, 1e-6, "the scale")
		var picture: Image = Image.create_from_data(
			160, 200, false, Image.FORMAT_RGBA8, read["pixels"]
		)
		var sum: Vector2 = Vector2.ZERO
		var weight: float = 0.0
		for y: int in 200:
			for x: int in 160:
				var lit: float = picture.get_pixel(x, y).r
				sum += lit * Vector2(x + 0.5, y + 0.5)
				weight += lit
		var found: Vector2 = sum / weight / 0.5
		var wanted: Vector2 = photos.project(2, place, 0.0)
		check(
			found.distance_to(wanted) < 0.3,
			"Node %d is at %s in the picture instead of %s." % [id, found, wanted]
		)


func test_where_the_photo_shows_nothing_it_is_transparent() -> void:
	var made: TreeReconstruction = _tree_near_zero()
	# Beyond the corners of a picture that bulges less than this.
	var photos: PhotoModel = PhotoModel.new(
		folder, made, "1 SIMPLE_RADIAL 320 400 380 160 200 0.3\n"
	)
	var worker: TreeReconstructor = TreeReconstructor.new()
	var view: Dictionary = worker.load_photo_views(made)[0]
	var read: Dictionary = worker.load_photo(view, photos.photos)
	var picture: Image = Image.create_from_data(320, 400, false, Image.FORMAT_RGBA8, read["pixels"])
	check_equal(picture.get_pixel(0, 0).a, 0.0, "the alpha of the corner")
	check_equal(picture.get_pixel(160, 200).a, 1.0, "the alpha of the middle")


func test_what_is_wrong_gets_a_sentence() -> void:
	var made: TreeReconstruction = _tree_near_zero()
	var worker: TreeReconstructor = TreeReconstructor.new()
	check(worker.load_photo_views(made).is_empty(), "It knows of photos.")
	check_sentence(worker.get_error_message(), "a tree of nothing")
	made.provenance = {"source": folder.path_join("cloud.ply")}
	check(worker.load_photo_views(made).is_empty(), "It knows of photos.")
	check_sentence(worker.get_error_message(), "a tree without a model")
	var photos: PhotoModel = PhotoModel.new(folder, made)
	var view: Dictionary = worker.load_photo_views(made)[1]
	check(not worker.load_photo(view, photos.photos).is_empty(), worker.get_error_message())
	# The model elsewhere, named by any of its folders.
	made.provenance = {"source": folder.path_join("none/cloud.ply")}
	for named: String in [folder, folder.path_join("sparse"), photos.model]:
		check_equal(worker.load_photo_views(made, named).size(), PhotoModel.COUNT, named)
	check(worker.load_photo_views(made, photos.photos.path_join("none")).is_empty(), "No folder.")
	check_sentence(worker.get_error_message(), "a folder without a model")
	for wrong: Dictionary in [
		{},
		{"name": "photo_1.png"},
		_changed(view, "lens", 77),
		_changed(view, "lens_parameters", PackedFloat64Array([1.0])),
		_changed(view, "lens_parameters", PackedFloat64Array([NAN, 1.0, 1.0, 1.0])),
		_changed(view, "size", Vector2i(0, 5)),
		_changed(view, "size", Vector2i(400, 320)),
		_changed(view, "name", "none.png"),
		_changed(view, "name", "../sparse/0/images.txt"),
	]:
		check(worker.load_photo(wrong, photos.photos).is_empty(), "It took %s." % wrong)
		check_sentence(worker.get_error_message(), str(wrong))
	for damaged: String in ["", "0.9 0 0\n", "1 1 0 0 0 0 0 0 7 a.jpg\n\n"]:
		PhotoModel.write(photos.model.path_join("images.txt"), damaged)
		check(worker.load_photo_views(made, photos.model).is_empty(), "It took '%s'." % damaged)
		check_sentence(worker.get_error_message(), "a model of '%s'" % damaged)
	worker.cancel()
	check(worker.load_photo_views(made, photos.model).is_empty(), "It was not cancelled.")


func _changed(view: Dictionary, key: String, value: Variant) -> Dictionary:
	var other: Dictionary = view.duplicate()
	other[key] = value
	return other


func test_the_folder_of_the_photos_is_found() -> void:
	var made: TreeReconstruction = _tree_near_zero()
	var photos: PhotoModel = PhotoModel.new(folder, made)
	var views: Array[Dictionary] = TreeReconstructor.new().load_photo_views(made)
	var nothing: PackedStringArray = ["", ""]
	var found: String = PhotoSource.find_folder(
		views, PhotoSource.list_folders(made.provenance, nothing)
	)
	check_equal(found, photos.photos, "the folder that the tree names")
	# A film's frames lie beside the cloud; what the tree names is the film.
	DirAccess.rename_absolute(photos.photos, folder.path_join("frames"))
	made.provenance = {"source": photos.source, "photos": folder.path_join("walk.mp4")}
	found = PhotoSource.find_folder(views, PhotoSource.list_folders(made.provenance, nothing))
	check_equal(found, folder.path_join("frames"), "the folder of a film's photos")
	# Of HEIC photos some are beside those that were given.
	DirAccess.make_dir_recursive_absolute(folder.path_join("phone"))
	DirAccess.copy_absolute(
		folder.path_join("frames/photo_0.png"), folder.path_join("phone/photo_0.png")
	)
	made.provenance = {"source": photos.source, "photos": folder.path_join("phone")}
	found = PhotoSource.find_folder(views, PhotoSource.list_folders(made.provenance, nothing))
	check_equal(found, folder.path_join("frames"), "the folder with more of them")
	DirAccess.rename_absolute(folder.path_join("frames"), folder.path_join("elsewhere"))
	DirAccess.remove_absolute(folder.path_join("phone/photo_0.png"))
	found = PhotoSource.find_folder(views, PhotoSource.list_folders(made.provenance, nothing))
	check_equal(found, "", "the folder where there is none")
	found = PhotoSource.find_folder(
		views, PhotoSource.list_folders(made.provenance, ["", folder.path_join("elsewhere")])
	)
	check_equal(found, folder.path_join("elsewhere"), "the folder that was chosen")
