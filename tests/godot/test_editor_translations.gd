extends "suite.gd"
## The languages of the editor's part. That they are complete, tests/tools/editor_strings.py checks.

const Translations: GDScript = preload(
	"res://addons/tree_reconstruction/editor/translations/part.gd"
)


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
