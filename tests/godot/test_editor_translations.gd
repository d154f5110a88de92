extends "suite.gd"
## The languages of the editor's part. That they are complete, tests/tools/editor_strings.py checks.

const Translations: GDScript = preload(
	"res://addons/tree_reconstruction/editor/translations/part.gd"
)

const Sentences: GDScript = preload(
	"res://addons/tree_reconstruction/editor/translations/sentences.gd"
)
const _DOMAIN: StringName = &"tree_reconstruction_test"


func test_the_editor_s_language_chooses() -> void:
	var domain: TranslationDomain = TranslationDomain.new()
	var wanted: Dictionary[String, String] = {
		"ja": "葉",
		"ja_JP": "葉",
		"zh_CN": "树叶",
		"zh_Hans": "树叶",
		"zh_TW": "樹葉",
		"zh_Hant": "樹葉",
		"en": "Leaves",
		"de": "Leaves",
	}
	for language: String in wanted:
		Translations.fill(domain, language)
		check_equal(domain.get_translations().size(), 3, "the number of translations")
		check_equal(domain.translate("Leaves", ""), StringName(wanted[language]), language)


func test_words_of_objects_are_translated() -> void:
	var name: StringName = &"tree_reconstruction_test"
	Translations.fill(TranslationServer.get_or_add_domain(name), "ja")
	var object: RefCounted = RefCounted.new()
	object.set_translation_domain(name)
	check_equal(object.tr("Leaves"), "葉", "a word")
	check_equal(object.tr("no such word"), "no such word", "an unknown word")
	TranslationServer.remove_domain(name)


func test_sentences_of_the_library_are_translated() -> void:
	Translations.fill(TranslationServer.get_or_add_domain(_DOMAIN), "ja")
	var wanted: Dictionary[String, String] = {
		"Nothing was cut away.": "何も切り取られませんでした。",
		"Cut away 214 nodes.": "ノード 214 個を切り取りました。",
		"Grafted 1 branch of 12 nodes in all, clear of other branches.":
		"枝 1 本（合計 ノード 12 個）を接ぎ木しました。ほかの枝とはぶつかりません。",
		"'a %s b.ply' is empty.": "'a %s b.ply' は空です。",
		(
			"The tree has drawn bark. The photos show the bark with pixels of 8.2 mm, and a picture of it"
			+ " needs 6.0 mm or less: take some from nearer by, or larger ones."
		):
		(
			"木の樹皮は描かれたものです。写真での樹皮の 1 ピクセルは 8.2 mm ですが、樹皮の画像には 6.0 mm 以下が必要です。"
			+ "もっと近くから何枚か撮るか、より大きな写真を使ってください。"
		),
		"Cut away nodes.": "Cut away nodes.",
		"Something else.": "Something else.",
		"": "",
	}
	for sentence: String in wanted:
		check_equal(Sentences.translate(sentence, _DOMAIN), wanted[sentence], sentence)
	check_equal(
		Sentences.translate_list("few points, a long bridge", _DOMAIN), "点が少ない, 長い隙間をまたぐ", "a list"
	)
	Translations.fill(TranslationServer.get_or_add_domain(_DOMAIN), "en")
	check_equal(
		Sentences.translate("Cut away 3 nodes.", _DOMAIN), "Cut away 3 nodes.", "what is English"
	)
	TranslationServer.remove_domain(_DOMAIN)


# The program's options are none of the editor.
func test_options_are_named_as_in_the_editor() -> void:
	var several: String = "'a.txt' holds 3 trees; the largest, tree 2 with 40 nodes, was taken."
	several += " Ask for another one by its number (%s)."
	var classes: String = "'a.las' holds no points of the classes that were asked for; "
	var unit: String = "The file names its coordinate system without its unit; its units were taken"
	unit += " for metres. If they are feet, set the unit (%sin the Import dock: Unit)."
	var said: Dictionary[String, String] = {
		several % "--tree": several % "in the Import dock: Tree in File",
		classes + "leave out --classes.": classes + "clear Classes in the Import dock.",
		unit % "--unit us-ft or --unit ft; ": unit % "",
	}
	for language: String in ["en", "ja", "zh_CN", "zh_TW"]:
		Translations.fill(TranslationServer.get_or_add_domain(_DOMAIN), language)
		for sentence: String in said:
			var told: String = Sentences.translate(sentence, _DOMAIN)
			check(not "--" in told, "%s: %s" % [language, told])
			if language == "en":
				check_equal(told, said[sentence], "what is told")
			else:
				check(told != said[sentence], "It is not translated into %s." % language)
		for option: String in Sentences.IN_EDITOR:
			check(not "--" in Sentences.translate(option, _DOMAIN), option)
	# As the reader itself says it.
	var reader: TreeReconstructor = TreeReconstructor.new()
	var rows: String = ""
	for stem: int in 2:
		for i: int in 3000:
			rows += "%f %f %f\n" % [stem * 4.0 + 0.1 * cos(i), 0.1 * sin(i), i * 0.001]
	var made: TreeReconstruction = reader.reconstruct_file(write_text("two.xyz", rows))
	check(made != null, reader.get_error_message())
	var warnings: PackedStringArray = reader.get_report()["warnings"]
	check("--one-tree" in " ".join(warnings), "It says nothing of several trees: %s" % warnings)
	for warning: String in warnings:
		check(not " --" in Sentences.translate(warning, _DOMAIN).replace("(", " "), warning)
	TranslationServer.remove_domain(_DOMAIN)


# What the editor's tools and menus do to a tree, and what they may be refused.
func test_all_that_edits_say_is_known() -> void:
	Translations.fill(TranslationServer.get_or_add_domain(_DOMAIN), "ja")
	var made: TreeReconstruction = grown_tree(7)
	var tip: int = made.get_leaves()[0]
	var inner: int = made.get_node_parent(tip)
	var root: int = made.get_root()
	var twig: String = "node=%d twig=oak" % tip
	var commands: PackedStringArray = [
		"prune factor=1",
		"prune_order order=1",
		"prune_order order=90",
		"cut node=%d" % root,
		"cut node=%d" % inner,
		"cut node=999999",
		"move nodes=%d by=0.1,0,0" % tip,
		"grow node=%d" % tip,
		"grow node=%d count=4" % tip,
		"twig node=%d side=left" % inner,
		"graft " + twig,
		"graft_many nodes=leaves twigs=oak",
		"graft_many nodes=leaves twigs=oak most=1",
		"lighten nodes=40",
		"smooth_radii",
		"smooth_paths",
		"relax angle=5",
		"turn node=%d axis=0,1,0 angle=20" % inner,
		"scale node=%d factor=0.8" % inner,
		"mirror node=%d normal=1,0,0" % inner,
		"sag",
		"thicken factor=1.1",
		"subdivide length=0.05",
		"insert node=%d" % inner,
		"delete node=%d" % root,
		"attach node=%d to=%d" % [inner, tip],
		'lstring node=%d string="!(0.01) F(0.3) F(0.2)"' % inner,
	]
	var said: int = 0
	for command: String in commands:
		var preview: Dictionary = made.preview_edit(command)
		for sentence: String in [preview["error"], preview["message"]]:
			if sentence.is_empty():
				continue
			said += 1
			check(
				Sentences.translate(sentence, _DOMAIN) != sentence,
				"'%s' says what nobody translates: %s" % [command, sentence]
			)
	check(said >= commands.size() - 2, "Only %d sentences were said." % said)
	var files: Dictionary[String, String] = {
		"none.xyz": "",
		"words.xyz": "no numbers\nat all\n",
		"none.ply": "",
		"words.las": "words",
		"plane.xyz": "",
	}
	for i: int in 400:
		files["plane.xyz"] += "%f %f 0\n" % [i % 20, i / 20.0]
	for file: String in files:
		var reader: TreeReconstructor = TreeReconstructor.new()
		check(reader.reconstruct_file(write_text(file, files[file])) == null, file + " is read.")
		var sentence: String = reader.get_error_message()
		check(Sentences.translate(sentence, _DOMAIN) != sentence, "Of %s: %s" % [file, sentence])
	TranslationServer.remove_domain(_DOMAIN)
