extends "suite.gd"
## Which files are scans, and what the Import dock's parameters become.

const Translations: GDScript = preload(
	"res://addons/tree_reconstruction/editor/translations/part.gd"
)
const ScanFiles: GDScript = preload("res://addons/tree_reconstruction/editor/import/scan_files.gd")
const OptionTips: GDScript = preload(
	"res://addons/tree_reconstruction/editor/import/option_tips.gd"
)
const ImportOptions: GDScript = preload(
	"res://addons/tree_reconstruction/editor/import/import_options.gd"
)

const ScanFinder: GDScript = preload(
	"res://addons/tree_reconstruction/editor/import/scan_finder.gd"
)


# Random points about a stem, one line each, with `format` for the three numbers of a line.
static func _points(format: String, count: int = 400) -> String:
	var random: RandomNumberGenerator = RandomNumberGenerator.new()
	random.seed = 3
	var lines: PackedStringArray = []
	for i: int in count:
		lines.append(format % [random.randfn(), random.randfn(), random.randf_range(0.0, 9.0)])
	return "\n".join(lines)


func test_text_clouds_are_told_by_their_lines() -> void:
	var plain: String = _points("%.4f %.4f %.4f")
	var clouds: Dictionary[String, String] = {
		"plain.txt": plain,
		"commas.csv": _points("%.4f,%.4f,%.4f"),
		"semicolons.txt": _points("%.4f;%.4f;%.4f"),
		"colors.txt": _points("%.4f %.4f %.4f 120 90 30"),
		"names.csv": "x,y,z,name\n" + _points("%.4f,%.4f,%.4f,bark"),
		"header.txt": '"X" "Y" "Z"\n' + plain,
		"slashes.txt": "//X Y Z\n" + plain,
		"count.txt": "400\n" + plain,
		"exported.txt": "# from a scanner in Kür\n" + plain,
		"east.csv": "Easting;Northing;Altitude\n" + _points("%.4f;%.4f;%.4f"),
		"windows.txt": plain.replace("\n", "\r\n"),
		"damaged.txt": plain.insert(plain.find("\n") + 1, "0.1 0.2\n"),
	}
	for name: String in clouds:
		check(ScanFiles.is_text_cloud(write_text(name, clouds[name])), name + " is no cloud")


func test_other_texts_are_left_alone() -> void:
	var series: PackedStringArray = []
	var table: PackedStringArray = []
	for i: int in 400:
		series.append("%.3f,%.3f,%.3f" % [i * 0.016, randf(), randf()])
		table.append("%d,%d,%d,%d" % [i, randi() % 9, randi() % 90, randi() % 5])
	var plain: String = _points("%.4f %.4f %.4f")
	var others: Dictionary[String, String] = {
		"README.txt": "A project.\n\n".repeat(200),
		"words.csv": "keys,en,de\n" + "A,hello,hallo\n".repeat(400),
		"series.csv": "\n".join(series),
		"table.csv": "\n".join(table),
		"named.csv": "speed,mass,drag\n" + _points("%.4f,%.4f,%.4f"),
		"skeleton.csv": "x,y,z,radius,parent\n" + _points("%.4f,%.4f,%.4f,0.1,4"),
		"qsm.csv": "start_x,start_y,start_z,radius,length\n" + _points("%.4f,%.4f,%.4f,0.1,0.4"),
		"two.txt": "0.25 0.75\n".repeat(400),
		"small.txt": _points("%.4f %.4f %.4f", 60),
		"same.txt": "1.25 2.5 3.75\n".repeat(400),
		"empty.txt": "",
		"blank.txt": "\n\n\n",
		"title.txt": "Chapter one\n" + plain,
		"mixed.txt": plain.replace("\n", "\nand\n"),
	}
	for name: String in others:
		check(not ScanFiles.is_text_cloud(write_text(name, others[name])), name + " is a cloud")
	var binary: String = folder.path_join("binary.txt")
	var file: FileAccess = FileAccess.open(binary, FileAccess.WRITE)
	file.store_buffer(plain.to_utf16_buffer())
	file.close()
	check(not ScanFiles.is_text_cloud(binary), "UTF-16 is a cloud")
	check(not ScanFiles.is_text_cloud(folder.path_join("missing.txt")), "no file is a cloud")


func test_real_scans_are_told() -> void:
	var scans: String = OS.get_environment("TREEREC_SCANS")
	if not DirAccess.dir_exists_absolute(scans.path_join("clouds")) or scans.is_empty():
		print("        skipped: no scans in TREEREC_SCANS")
		return
	for name: String in DirAccess.get_files_at(scans.path_join("clouds")):
		if name.get_extension() in ["txt", "csv", "xyz", "asc"]:
			check(
				ScanFiles.is_text_cloud(scans.path_join("clouds").path_join(name)),
				name + " is no cloud"
			)
	for name: String in DirAccess.get_files_at(scans.path_join("groundtruth")):
		check(
			not ScanFiles.is_text_cloud(scans.path_join("groundtruth").path_join(name)),
			name + " is a cloud"
		)
	check(not ScanFiles.is_text_cloud(scans.path_join("README.md")), "README.md is a cloud")


func test_a_ply_file_with_edges_is_a_skeleton() -> void:
	var tree: TreeReconstruction = grown_tree(4)
	var path: String = folder.path_join("skeleton.ply")
	check_equal(TreeReconstructor.new().export_file(tree, path), OK, "writing a skeleton")
	check(ScanFiles.is_skeleton(path), "our skeleton is a cloud")
	check(ScanFiles.is_skeleton("res://neuron.SWC"), "swc is a cloud")
	var head: String = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
	var cloud: String = write_text("cloud.ply", head + "end_header\nelement edge 5\n")
	check(not ScanFiles.is_skeleton(cloud), "a cloud is a skeleton")
	var none: String = write_text("none.ply", head + "element edge 0\nend_header\n")
	check(not ScanFiles.is_skeleton(none), "a cloud without edges is a skeleton")
	check(not ScanFiles.is_skeleton(write_text("x.ply", "nonsense")), "nonsense is a skeleton")
	check(not ScanFiles.is_skeleton(folder.path_join("y.ply")), "no file is a skeleton")


func test_stand_ins_lead_to_their_scans() -> void:
	var scan: String = write_text("scan.txt", "1 2 3")
	var path: String = folder.path_join("scan.treescan")
	check_equal(ScanFiles.write_stand_in(path, scan), OK, "writing")
	check("/" not in FileAccess.get_file_as_string(path), "the path is not relative")
	check_equal(ScanFiles.read_stand_in(path), {"scan": scan}, "the scan")
	DirAccess.remove_absolute(scan)
	for text: String in [FileAccess.get_file_as_string(path), "", "[scan]\npath=5\n"]:
		var answer: Dictionary = ScanFiles.read_stand_in(write_text("scan.treescan", text))
		check(not answer.has("scan"), "there is a scan in " + text)
		check_sentence(answer.get("error", ""), "the error")
	check(ScanFiles.read_stand_in(folder.path_join("gone.treescan")).has("error"), "no error")


func test_the_finder_looks_into_folders() -> void:
	var model: String = folder.path_join("oak/sparse/0")
	var hidden: String = folder.path_join("ignored")
	for path: String in [model, hidden]:
		DirAccess.make_dir_recursive_absolute(path)
	var points: String = _points("%.4f %.4f %.4f")
	var cloud: String = write_text("cloud.txt", points)
	write_text("README.txt", "Nothing.")
	write_text("oak/sparse/0/points3D.bin", "any")
	write_text("oak/sparse/0/images.txt", points)
	write_text("ignored/.gdignore", "")
	write_text("ignored/cloud.txt", points)
	var circle: bool = DirAccess.open(folder).create_link(folder, "again") == OK
	var look: ScanFinder.Look = ScanFinder.Look.new()
	look.folder(folder)
	check_equal(look.scans.get(cloud), folder.path_join("cloud"), "the cloud's place")
	check_equal(
		look.scans.get(model.path_join("points3D.bin")),
		folder.path_join("oak/oak"),
		"the model's place"
	)
	if not circle:
		check_equal(look.scans.size(), 2, "the scans")
	check(not look.scans.has(hidden.path_join("cloud.txt")), "An ignored folder was looked into.")
	check(not look.scans.has(model.path_join("images.txt")), "A model's images are a scan.")
	check_equal(look.seen[cloud][1], true, "what is remembered of the cloud")
	# What was seen is not read again while its time stays.
	var known: ScanFinder.Look = ScanFinder.Look.new()
	known.seen = {cloud: [FileAccess.get_modified_time(cloud), false]}
	known.folder(folder)
	check(not known.scans.has(cloud), "The cloud was read again.")
	for path: String in [
		"again",
		"oak/sparse/0/points3D.bin",
		"oak/sparse/0/images.txt",
		"oak/sparse/0",
		"oak/sparse",
		"oak",
		"ignored/.gdignore",
		"ignored/cloud.txt",
		"ignored",
	]:
		DirAccess.remove_absolute(folder.path_join(path))


func test_parameters_cover_all_options() -> void:
	for preset: int in ImportOptions.PRESETS.size():
		var values: Dictionary = {}
		for parameter: Dictionary in ImportOptions.list(preset, self):
			check(not values.has(parameter["name"]), "%s is there twice" % parameter["name"])
			values[parameter["name"]] = parameter["default_value"]
			check(
				(parameter["name"] as String).get_slice_count("/") == 2,
				"%s is in no group" % parameter["name"]
			)
		var options: Dictionary = ImportOptions.to_options(values)
		check((preset == 0) == options.is_empty(), "preset %d gives %s" % [preset, options])
		var named: int = values.size() - 3  # the unit is none, nor what only skeleton files have
		check_equal(named, TreeReconstructor.get_option_list().size() - 1, "the number of options")
	check_equal(ImportOptions.to_options({"advanced/prune": "paper"}), {"prune": "paper"}, "prune")
	# A group of options that nobody arranged would have no place in the dock.
	var groups: Dictionary = {}
	for parameter: Dictionary in ImportOptions.list(0, self):
		groups[(parameter["name"] as String).get_slice("/", 0)] = true
	check_equal(groups.keys(), ["scan", "cleaning", "skeleton", "leaves", "advanced"], "the groups")


func test_every_parameter_has_a_tooltip() -> void:
	for parameter: Dictionary in ImportOptions.list(0, self):
		var name: String = parameter["name"]
		if name not in ["scan/unit", "scan/tree_in_file", "scan/dialect"]:
			check_sentence(ImportOptions.get_description(name), "what is told of " + name)
		if name == "cleaning/remove_ground":
			check("walls" in ImportOptions.get_description(name), "It says nothing of walls.")
	var tooltip: String = OptionTips.to_tooltip("Up | Axis", 'With [b]tags[/b], "quotes" | bars.')
	var parts: PackedStringArray = tooltip.split("|", true, 3)
	check_equal(parts[2], "Up / Axis", "the name in a tooltip")
	check_equal(
		JSON.parse_string(parts[3])["description"],
		'With [lb]b]tags[lb]/b], "quotes" | bars.',
		"the text in a tooltip"
	)


func test_presets_set_what_exists() -> void:
	var names: PackedStringArray = []
	for parameter: Dictionary in ImportOptions.list(0, self):
		names.append(parameter["name"])
	for values: Dictionary in ImportOptions.PRESET_VALUES:
		for name: String in values:
			check(name in names, name + " of a preset is no parameter")
	check_equal(ImportOptions.PRESET_VALUES.size(), ImportOptions.PRESETS.size(), "the presets")


func test_units_become_scales() -> void:
	var unit: Dictionary = ImportOptions.Unit
	check_equal(ImportOptions.to_options({"scan/unit": unit.METRES}), {"scale": 1.0}, "metres")
	check_equal(ImportOptions.to_options({"scan/unit": unit.FEET}), {"scale": 0.3048}, "feet")
	var survey: Dictionary = ImportOptions.to_options({"scan/unit": unit.SURVEY_FEET})
	check_near(survey["scale"], 0.304800609601, 1e-12, "survey feet")
	check_equal(
		ImportOptions.to_options({"scan/unit": unit.GUESS, "scan/tree_height": 4.0}), {}, "a guess"
	)
	check_equal(
		ImportOptions.to_options({"scan/unit": unit.TREE_HEIGHT, "scan/tree_height": 4.0}),
		{"known_height": 4.0},
		"a height"
	)
	check_equal(
		ImportOptions.to_options(
			{"scan/unit": unit.TWO_PLACES, "scan/known_length": "(0, 0, 5431234.125), (0;0;2) 1.5"}
		),
		{"known_length": PackedFloat64Array([0, 0, 5431234.125, 0, 0, 2, 1.5])},
		"a length"
	)
	check(is_nan(ImportOptions.parse_numbers("1 two 3")[1]), "a word is a number")


# As many as there are values, in any language, and no comma in one.
func test_units_are_in_the_editor_s_language() -> void:
	var name: StringName = &"tree_reconstruction_test"
	var object: RefCounted = RefCounted.new()
	object.set_translation_domain(name)
	var wanted: Dictionary[String, String] = {
		"en": "Metres", "ja": "メートル", "zh_CN": "米", "zh_TW": "公尺"
	}
	for language: String in wanted:
		Translations.fill(TranslationServer.get_or_add_domain(name), language)
		for parameter: Dictionary in ImportOptions.list(0, object):
			if parameter["name"] == "scan/unit":
				var units: PackedStringArray = (parameter["hint_string"] as String).split(",")
				check_equal(units.size(), ImportOptions.Unit.size(), "units")
				var metres: String = units[ImportOptions.Unit.METRES]
				check_equal(metres, wanted[language], "metres in " + language)
	TranslationServer.remove_domain(name)


# Until the parameter had its name, "delaunay" was the word for what is geodesic now.
func test_old_files_keep_their_method() -> void:
	var path: String = write_scan("old.xyz")
	var default_of: Callable = func(at: String) -> String:
		for parameter: Dictionary in ImportOptions.list(0, self, at):
			if parameter["name"] == "skeleton/algorithm":
				return parameter["default_value"]
		return ""
	check_equal(default_of.call(path), "geodesic", "a new file")
	var wanted: Dictionary[String, String] = {
		"delaunay": "geodesic", "flood": "flood", "x": "geodesic"
	}
	for word: String in wanted:
		var config: ConfigFile = ConfigFile.new()
		config.set_value("params", "skeleton/method", word)
		config.save(path + ".import")
		check_equal(default_of.call(path), wanted[word], "of a file that says " + word)
	# One that has the new name, too, goes by that.
	var both: ConfigFile = ConfigFile.new()
	both.set_value("params", "skeleton/method", "flood")
	both.set_value("params", "skeleton/algorithm", "delaunay")
	both.save(path + ".import")
	check_equal(default_of.call(path), "geodesic", "the default beside the new name")
	DirAccess.remove_absolute(path + ".import")
	var setting: String = "importer_defaults/tree_reconstruction.scan"
	var before: Variant = ProjectSettings.get_setting(setting, null)
	ProjectSettings.set_setting(setting, {"skeleton/method": "flood"})
	check_equal(default_of.call(path), "flood", "by the project's defaults")
	ProjectSettings.set_setting(setting, before)
	check_equal(
		ImportOptions.to_options({"skeleton/algorithm": "delaunay"}),
		{"skeleton": "delaunay"},
		"the new meaning"
	)


func test_old_trees_keep_their_method() -> void:
	var tree: TreeReconstruction = TreeReconstruction.new()
	tree.provenance = {"options": {"skeleton": "delaunay"}, "report": {"format_version": 1.0}}
	check_equal(tree.provenance["options"], {"skeleton": "geodesic"}, "of before")
	tree.provenance = {"options": {"skeleton": "delaunay"}, "report": {"format_version": 2.0}}
	check_equal(tree.provenance["options"], {"skeleton": "delaunay"}, "of today")
	var path: String = write_scan("scan.xyz")
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	for method: String in ["geodesic", "delaunay"]:
		var made: TreeReconstruction = reconstructor.reconstruct_file(path, {"skeleton": method})
		check(made != null, reconstructor.get_error_message())
		if made != null:
			check_equal(made.provenance["options"]["skeleton"], method, "what is kept")
			check_near(made.measure()["height"], 3.5, 0.3, method)


func test_every_preset_reconstructs() -> void:
	var scan: String = write_scan("scan.xyz")
	for preset: int in ImportOptions.PRESETS.size():
		var values: Dictionary = {}
		for parameter: Dictionary in ImportOptions.list(preset, self):
			values[parameter["name"]] = parameter["default_value"]
		var reconstructor: TreeReconstructor = TreeReconstructor.new()
		var tree: TreeReconstruction = reconstructor.reconstruct_file(
			scan, ImportOptions.to_options(values)
		)
		check(
			tree != null,
			"%s: %s" % [ImportOptions.PRESETS[preset], reconstructor.get_error_message()]
		)
		if tree != null:
			check_near(tree.measure()["height"], 3.5, 0.3, ImportOptions.PRESETS[preset])


func test_only_what_matters_is_shown() -> void:
	var unit: Dictionary = ImportOptions.Unit
	var guess: Dictionary = {"scan/unit": unit.GUESS, "skeleton/algorithm": "geodesic"}
	var height: Dictionary = {"scan/unit": unit.TREE_HEIGHT, "skeleton/algorithm": "flood"}
	for name: String in ["scan/tree_height", "skeleton/voxel"]:
		check(not ImportOptions.is_visible("a.las", false, name, guess), name + " is shown")
		check(ImportOptions.is_visible("a.las", false, name, height), name + " is hidden")
	check(not ImportOptions.is_visible("a.las", false, "scan/columns", guess), "columns of LAS")
	check(ImportOptions.is_visible("a.xyz", false, "scan/columns", guess), "columns of text")
	check(ImportOptions.is_visible("a.las", false, "scan/classes", guess), "classes of LAS")
	check(not ImportOptions.is_visible("a.xyz", false, "scan/classes", guess), "classes of text")
	check(ImportOptions.is_visible("a.treefile", true, "scan/tree_in_file", guess), "of many trees")
	check(ImportOptions.is_visible("a.lstring", true, "scan/dialect", guess), "of an L-string")
	check(not ImportOptions.is_visible("a.treefile", true, "scan/dialect", guess), "of no L-string")
	check(not ImportOptions.is_visible("a.las", false, "scan/dialect", guess), "of a cloud's")
	check(not ImportOptions.is_visible("a.las", false, "scan/tree_in_file", guess), "of one cloud")
	check(not ImportOptions.is_visible("a.swc", true, "skeleton/spacing", guess), "of a skeleton")
	check(ImportOptions.is_visible("a.swc", true, "scan/up_axis", guess), "the axis of a skeleton")
