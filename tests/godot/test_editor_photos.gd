extends "./session_suite.gd"
## The window 'New Tree from Photos', on a program that stands in for COLMAP.

const PhotosPanel := preload("res://addons/tree_reconstruction/editor/photos/photos_panel.gd")
const PhotoFolder := preload("res://addons/tree_reconstruction/editor/photos/photo_folder.gd")
const PhotoLog := preload("res://addons/tree_reconstruction/editor/photos/photo_log.gd")
const Widgets := preload("res://addons/tree_reconstruction/editor/dock/widgets.gd")
const PhotoBark := preload("res://addons/tree_reconstruction/editor/photos/photo_bark.gd")
const PhotoLeaves := preload("res://addons/tree_reconstruction/editor/photos/photo_leaves.gd")
const PhotoFiles := preload("./photo_files.gd")
const LeafyPhotos := preload("./leafy_photos.gd")
const TrunkPhotos := preload("./trunk_photos.gd")

const TARGET: String = "res://photo_test_tree.res"

var _files: PhotoFiles
var _session: Session
var _panel: PhotosPanel
var _made: TreeReconstruction


func _open() -> void:
	_clean()
	_files = PhotoFiles.new(folder)
	_session = _session_with(grown_tree(2))
	_panel = PhotosPanel.new(_session)
	_panel.colmap = _files.colmap
	_panel.made.connect(func(made: TreeReconstruction) -> void: _made = made)
	tree.root.add_child(_panel)


func _shut() -> void:
	_panel.close()
	_panel.free()
	_end(_session)
	# What it says to this suite holds the suite.
	_session = null
	_clean()


func _clean() -> void:
	for name: String in DirAccess.get_files_at("res://"):
		if name.begins_with("photo_test_tree"):
			DirAccess.remove_absolute("res://" + name)
	for name: String in DirAccess.get_directories_at("res://"):
		if name.begins_with("photo_test_tree"):
			remove_folder("res://" + name)


static func remove_folder(path: String) -> void:
	var there: DirAccess = DirAccess.open(path)
	there.include_hidden = true
	for name: String in there.get_directories():
		remove_folder(path.path_join(name))
	for name: String in there.get_files():
		there.remove(name)
	DirAccess.remove_absolute(path)


func _frame() -> void:
	_session.update()
	_panel.update()
	await tree.process_frame


func _begin() -> void:
	_panel.show_folder(_files.photos)
	_panel._target.text = TARGET
	_panel._update_buttons()
	check(not _panel.begin.disabled, "It can't be begun: %s" % _panel.begin.tooltip_text)
	_panel.begin.pressed.emit()


func _wait() -> void:
	while true:
		while not _session.jobs.get_running().is_empty():
			await _frame()
		_panel.update()
		# It may have begun to draw what was converted only now.
		if _session.jobs.get_running().is_empty():
			return


func test_photos_become_a_tree() -> void:
	_open()
	_panel._height.value = 6.0
	_begin()
	check(_panel.end.visible and not _panel.begin.visible, "It can't be ended.")
	await _wait()
	if not _made is TreeReconstruction:
		check(false, "No tree was made: " + _panel.message.text)
		_shut()
		return
	check_equal(_made.resource_path, TARGET, "the tree's file")
	var again: TreeReconstruction = (
		ResourceLoader.load(TARGET, "", ResourceLoader.CACHE_MODE_IGNORE) as TreeReconstruction
	)
	check_equal(again.get_node_count(), _made.get_node_count(), "nodes in the file")
	check_near(_made.measure()["height"], 6.0, 0.3, "the height")
	var work: String = "res://photo_test_tree_photos"
	check_equal(_made.provenance["source"], work + "/cloud.ply", "what the tree is made of")
	check_equal(_made.provenance["photos"], _files.photos, "the photos")
	check_equal(_made.provenance["options"], {"known_height": 6.0}, "options of the tree")
	check(FileAccess.file_exists(work + "/.gdignore"), "The engine would import the work.")
	var report: Dictionary = _made.provenance["report"]["photos"]
	check_equal(int(report["placed"]), 8, "photos that were placed")
	check_equal(report["missing"], ["photo 8.jpg"], "photos that were not")
	check_equal(report["cameras"].size(), 8, "cameras in the circle")
	check_near(report["widest_gap"]["degrees"], 123.75, 1.0, "the gap of the circle")
	check(_panel.circle.visible, "The circle isn't shown.")
	check("photo" in _panel.circle.tooltip_text, "It doesn't say where to add photos.")
	check("2,003 features" in _panel.grid.get_item_tooltip(2), "Features of a photo aren't told.")
	check("not found" in _panel.grid.get_item_tooltip(8), "A photo without a place isn't told.")
	check(_panel.grid.get_item_icon(4) != null, "A photo has no picture.")
	_panel.say_where(_made, false)
	check("8 of 9 photos" in _panel.message.text, "It says: " + _panel.message.text)
	# Photos of 64 pixels show no bark.
	check("The tree has drawn bark. " in _panel.message.text, "It says: " + _panel.message.text)
	check(PhotoBark.of(_made) == null, "It has bark that no photo shows.")
	check_equal(PhotoBark.free_path(TARGET), "res://photo_test_tree_bark.res", "a free name")
	check(_panel.begin.visible and _panel.begin.disabled, "It would write over the tree.")
	# The scan is there to look at, and to make the tree of it again.
	var worker: TreeReconstructor = TreeReconstructor.new()
	check(worker.load_cloud(_made), worker.get_error_message())
	check(worker.reconstruct_file(_made.provenance["source"]) != null, worker.get_error_message())
	_shut()


func test_a_marker_is_printed_and_asked_for() -> void:
	_open()
	var path: String = folder.path_join("marker.svg")
	_panel._marker.value = 123.4
	_panel.save_marker(path)
	check("123.4 mm" in FileAccess.get_file_as_string(path), "The page has another side.")
	check(path in _panel.message.text, "It says: " + _panel.message.text)
	_panel.save_marker(folder.path_join("marker.doc"))
	check(".svg or .png" in _panel.message.text, "It says: " + _panel.message.text)
	_panel._marker.value = 0.0
	_panel.save_marker(path)
	check("150 mm" in FileAccess.get_file_as_string(path), "The page has not the usual side.")
	_panel._marker.value = 123.4
	_begin()
	check(not _panel._marker.editable, "It can be changed while it is used.")
	await _wait()
	check(_panel._marker.editable, "It can't be changed any more.")
	if _made != null:
		check_near(_made.provenance["photo_options"]["marker_side"], 0.1234, 1e-9, "the side")
		check(not _made.provenance["report"]["scale_from_marker"], "It has a marker's size.")
	_panel.say_where(_made, false)
	check("No photo shows a marker" in _panel.message.text, "It says: " + _panel.message.text)
	_shut()


func test_photos_give_their_bark() -> void:
	_open()
	_files = TrunkPhotos.new(folder.path_join("trunk"))
	_panel.colmap = _files.colmap
	Widgets.choose(_panel._time, "quick")
	_panel._height.value = 2.0
	# As in the editor: else they could not be saved.
	PortableCompressedTexture2D.set_keep_all_compressed_buffers(true)
	# What bears the name already is somebody else's.
	var other: String = "res://photo_test_tree_bark.res"
	PhotoFiles.write(other, "not yours".to_utf8_buffer())
	_begin()
	await _wait()
	check(_made != null, "No tree was made: " + _panel.message.text)
	var bark: ShaderMaterial = PhotoBark.of(_made) as ShaderMaterial
	if bark == null:
		check(false, "It has no bark: %s" % "; ".join(_panel.making.get_warnings()))
		_shut()
		return
	check_equal(bark.resource_path, "res://photo_test_tree_bark_2.res", "the bark's file")
	check_equal(FileAccess.get_file_as_string(other), "not yours", "another's file")
	_panel.say_where(_made, false)
	check(bark.resource_path in _panel.message.text, "It says: " + _panel.message.text)
	check(not "drawn bark" in _panel.message.text, "It says: " + _panel.message.text)
	# As the next start of the editor finds them: the tree's file leads to the bark's.
	var again: TreeReconstruction = (
		ResourceLoader.load(TARGET, "", ResourceLoader.CACHE_MODE_IGNORE_DEEP) as TreeReconstruction
	)
	bark = PhotoBark.of(again) as ShaderMaterial
	check(bark != null, "The tree's file has forgotten its bark.")
	check(bark.shader.resource_path.ends_with("/bark.gdshader"), "It has another shader.")
	for parameter: StringName in PhotoBark.PICTURES:
		var texture: Texture2D = bark.get_shader_parameter(parameter) as Texture2D
		check(texture != null and texture.resource_path.begins_with(bark.resource_path), parameter)
		var path: String = "res://photo_test_tree_photos/bark".path_join(
			PhotoBark.PICTURES[parameter]
		)
		var file: Image = Image.load_from_file(ProjectSettings.globalize_path(path))
		check_equal(texture.get_image().get_size(), file.get_size(), "its size")
		check(texture.get_image().has_mipmaps(), "From afar it would flicker.")
		check(texture.get_image().is_compressed(), "It takes up video memory.")
	_shut()


func test_photos_give_their_leaf_colors() -> void:
	_open()
	_files = LeafyPhotos.new(folder.path_join("leafy"))
	_panel.colmap = _files.colmap
	Widgets.choose(_panel._time, "quick")
	Widgets.choose(_panel._bark, false)
	_panel._height.value = 2.5
	_begin()
	await _wait()
	check(_made != null, "No tree was made: " + _panel.message.text)
	var leaves: ShaderMaterial = PhotoLeaves.of(_made) as ShaderMaterial
	if leaves == null:
		check(false, "It has drawn leaves: %s" % "; ".join(_panel.making.get_warnings()))
		_shut()
		return
	check_equal(leaves.resource_path, "res://photo_test_tree_leaves.res", "the leaves' file")
	_panel.say_where(_made, false)
	check(leaves.resource_path in _panel.message.text, "It says: " + _panel.message.text)
	check(not "drawn colors" in _panel.message.text, "It says: " + _panel.message.text)
	var measured: Dictionary = _made.provenance["report"]["leaf_colors"]
	var wanted: Color = LeafyPhotos.LEAF.srgb_to_linear()
	# Lit leaves are somewhat lighter than all are.
	var light: float = measured["albedo"][1] / wanted.g
	check(light > 1.0 and light < 1.4, "They are %.2f as light as they should be." % light)
	check_near(
		measured["albedo"][0] / measured["albedo"][1], wanted.r / wanted.g, 0.05, "red over green"
	)
	var again: TreeReconstruction = (
		ResourceLoader.load(TARGET, "", ResourceLoader.CACHE_MODE_IGNORE_DEEP) as TreeReconstruction
	)
	check(PhotoLeaves.is_made(PhotoLeaves.of(again)), "The tree's file has forgotten its leaves.")
	_shut()


func test_bark_that_is_not_wanted_is_drawn() -> void:
	_open()
	Widgets.choose(_panel._bark, false)
	Widgets.choose(_panel._leaf_colors, false)
	_begin()
	await _wait()
	check(_made != null, "No tree was made: " + _panel.message.text)
	check(not _made.provenance["report"].has("bark"), "It was looked for.")
	check(not _made.provenance["report"].has("leaf_colors"), "Leaves were looked for.")
	check(PhotoLeaves.of(_made) == null, "It has leaves of photos.")
	check(not "drawn bark" in "; ".join(_panel.making.get_warnings()), "It complains of it.")
	_shut()


func test_bark_goes_with_its_tree() -> void:
	var pictures: String = folder.path_join("bark")
	DirAccess.make_dir_recursive_absolute(pictures)
	check(PhotoBark.make(pictures, "oak") == null, "There are no pictures.")
	for name: String in PhotoBark.PICTURES.values():
		var picture: Image = Image.create_empty(8, 8, false, Image.FORMAT_RGB8)
		picture.fill(Color.SADDLE_BROWN)
		picture.save_png(pictures.path_join(name))
	var bark: ShaderMaterial = PhotoBark.make(pictures, "oak")
	var drawn: ShaderMaterial = load("res://addons/tree_reconstruction/presets/oak_bark.tres")
	check(bark.get_shader_parameter(&"albedo_texture") is PortableCompressedTexture2D, "pictures")
	check_equal(
		bark.get_shader_parameter(&"twig_color"),
		drawn.get_shader_parameter(&"twig_color"),
		"what young twigs look like"
	)
	PhotoFiles.write(pictures.path_join("normal.png"), "no picture".to_utf8_buffer())
	for complaint: String in ['"!success"', '"err" is true', '"image.is_null()"']:
		expect_error(complaint)
	check(PhotoBark.make(pictures, "oak") == null, "It made bark of words.")
	# Copies of a tree have its bark, and a tree that is made again keeps it.
	var own: TreeReconstruction = grown_tree(2)
	PhotoBark.give(own, bark)
	check_equal(PhotoBark.of(Session.LocalTrees.copy_of(own)), bark, "a copy's bark")
	var session: Session = _session_with(own)
	session.node.bark_material = bark
	session.replace_tree("Reconstruct Again", grown_tree(3))
	check_equal(PhotoBark.of(session.tree), bark, "the bark of the tree that was made again")
	check_equal(session.node.bark_material, bark, "that of its node")
	_undo.undo()
	check_equal(PhotoBark.of(session.tree), bark, "its bark after undo")
	_end(session)


func test_what_was_ended_goes_on() -> void:
	_open()
	_files.hold("exhaustive_matcher")
	_begin()
	while not "Comparing" in _panel.making.get_stage():
		await _frame()
	check(not _panel._browse.disabled == false, "Other photos can be chosen meanwhile.")
	_panel.end.pressed.emit()
	await _wait()
	check(_made == null, "It went on to a tree.")
	check(not FileAccess.file_exists(TARGET), "A tree was saved.")
	check(_panel.message.text.begins_with("Ended."), "It says: " + _panel.message.text)
	_files.let_go("exhaustive_matcher")
	_panel.show_folder(_files.photos)
	_panel._target.text = TARGET
	check(PhotoFolder.is_begun(_files.photos, TARGET), "It begins anew.")
	_panel.begin.pressed.emit()
	await _wait()
	check(_made != null, "No tree was made: " + _panel.message.text)
	var log: String = FileAccess.get_file_as_string("res://photo_test_tree_photos/photos.log")
	check_equal(log.count("Processed file [9/9]"), 1, "times that features were found")
	# Another tree of the same photos doesn't touch what this one is made of.
	check_equal(
		PhotoFolder.work_folder(_files.photos, "res://photo_test_tree_2.res"),
		"res://photo_test_tree_2_photos",
		"the folder of another tree"
	)
	_shut()


func test_what_goes_wrong_is_said() -> void:
	_open()
	_panel.show_folder(folder)
	check(_panel.begin.disabled, "It begins without photos.")
	check_sentence(_panel.message.text, "what it says of no photos")
	DirAccess.remove_absolute(_files.photos.path_join("photo 1.jpg"))
	DirAccess.remove_absolute(_files.photos.path_join("photo 2.jpg"))
	_panel.show_folder(_files.photos)
	check(_panel.begin.disabled, "It begins with too few photos.")
	check("only 7" in _panel.message.text, "It says: " + _panel.message.text)
	_files = PhotoFiles.new(folder.path_join("whole"))
	_panel.colmap = folder.path_join("nowhere/colmap")
	_begin()
	await _wait()
	check(_made == null, "It made a tree without COLMAP.")
	check("COLMAP" in _panel.message.text, "It says: " + _panel.message.text)
	check(_panel.begin.visible, "It can't be tried again.")
	_panel._target.text = "user://tree.res"
	_panel._update_buttons()
	check(_panel.begin.disabled, "It would write outside of the project.")
	_shut()


func test_heic_photos_are_converted() -> void:
	_open()
	# A JPEG by the name of a HEIC, and a program that calls itself a converter.
	for i: int in [2, 5, 8]:
		var jpeg: String = _files.photos.path_join("photo %d.jpg" % i)
		DirAccess.rename_absolute(jpeg, jpeg.get_basename() + ".HEIC")
	var converter: String = folder.path_join("converter")
	PhotoFiles.write(converter, '#!/bin/sh\nexec cp "$3" "$4"\n'.to_utf8_buffer())
	FileAccess.set_unix_permissions(converter, 0x1C0)
	OS.set_environment("HEIF_CONVERT", converter)
	_begin()
	check_equal(_panel.grid.item_count, 9, "photos that are shown")
	check_equal(_panel.grid.get_item_text(5), "photo 5.HEIC", "the name of a photo")
	await _wait()
	OS.unset_environment("HEIF_CONVERT")
	check(_made != null, "No tree was made: " + _panel.message.text)
	var work: String = "res://photo_test_tree_photos"
	check(FileAccess.file_exists(work + "/photos/photo 5.jpg"), "It was not converted.")
	check("2,006 features" in _panel.grid.get_item_tooltip(5), "Its features aren't told.")
	check("not found" in _panel.grid.get_item_tooltip(8), "A photo without a place isn't told.")
	check(_panel.grid.get_item_icon(5) != null, "What was converted has no picture.")
	check_equal(
		PhotoFolder.read_names(["IMG.HEIC", "IMG.avif", "a.heic", "a.png"]),
		PackedStringArray(["IMG.jpg", "IMG.avif.jpg", "a.jpg", "a.png"]),
		"names of what is read"
	)
	_shut()


func test_a_film_stands_for_its_photos() -> void:
	_open()
	var film: String = folder.path_join("phone/My Walk.MOV")
	DirAccess.make_dir_recursive_absolute(film.get_base_dir())
	PhotoFiles.write(film, "no film".to_utf8_buffer())
	for path: String in [film, film.get_base_dir()]:
		_panel.show_folder(path)
		check("film" in _panel.message.text, "It says: " + _panel.message.text)
		check(not _panel.begin.disabled, "It can't be begun: " + _panel.begin.tooltip_text)
	_panel.show_folder(film)
	check_equal(_panel._target.text, "res://my_walk.res", "the tree's file")
	_panel._target.text = TARGET
	_panel.begin.pressed.emit()
	await _wait()
	check(_made == null, "It made a tree of words.")
	check("ffmpeg" in _panel.message.text, "It says: " + _panel.message.text)
	_shut()


func test_every_control_says_what_it_is() -> void:
	_open()
	for control: Node in _panel.find_children("*", "Control", true, false):
		var asks: bool = (
			control is BaseButton
			or control is SpinBox
			or control is ItemList
			or control is TextEdit
			or (control is LineEdit and not control.get_parent() is SpinBox)
		)
		if asks:
			var tip: String = (control as Control).tooltip_text
			check(tip.ends_with("."), "%s has no tooltip." % _panel.get_path_to(control))
	_shut()


# A log is read while it is written, in any pieces.
func test_a_log_is_followed() -> void:
	var path: String = folder.path_join("photos.log")
	var whole: PackedByteArray = (
		(
			"Processed file [1/2]\n  Name:            größe.jpg\n  Features:        1200\n"
			+ "Processed file [2/2]\n  Name:            b.jpg\n  Features:        7\nend\n"
		)
		. to_utf8_buffer()
	)
	var log: PhotoLog = PhotoLog.new(path)
	check(not log.update(), "There is no log yet.")
	for end: int in range(1, whole.size() + 1, 7):
		PhotoFiles.write(path, whole.slice(0, end))
		log.update()
	PhotoFiles.write(path, whole)
	log.update()
	check_equal(log.lines.size(), 7, "lines")
	check_equal(
		log.features, {"größe.jpg": 1200, "b.jpg": 7} as Dictionary[String, int], "features"
	)
	PhotoFiles.write(path, "anew\n".to_utf8_buffer())
	check(log.update(), "A log that was begun anew isn't read.")


func test_options_are_checked() -> void:
	var worker: TreeReconstructor = TreeReconstructor.new()
	for wrong: Dictionary in [
		{"time": "never"},
		{"matcher": "eye"},
		{"order": 3},
		{"dense": "yes"},
		{"nonsense": 1},
		{"colmap": 1.5},
	]:
		check(worker.reconstruct_photos(folder, folder, wrong) == null, "It took %s." % wrong)
		check_sentence(worker.get_error_message(), str(wrong))
	check(worker.reconstruct_photos("", "") == null, "It took nothing for photos.")
	check_sentence(worker.get_error_message(), "nothing")
	for option: Dictionary in TreeReconstructor.get_photo_option_list():
		check_sentence(option.description, option.name)
