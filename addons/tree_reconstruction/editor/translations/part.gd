@tool
extends RefCounted
## The plugin's part that gives its words the editor's language, which need not be the game's.
##
## They live in a domain of their own: [code]tr()[/code] of objects in it, and the texts of
## controls below a root in it. tests/tools/editor_strings.py keeps the files beside this one up
## to date.

const _FOLDER: String = "res://addons/tree_reconstruction/editor/translations/"
const _FILES: PackedStringArray = ["zh_CN.po", "zh_TW.po", "ja.po"]

var _domain: StringName


func enter(_plugin: EditorPlugin, session: RefCounted) -> void:
	_domain = session.get_translation_domain()
	fill(TranslationServer.get_or_add_domain(_domain), EditorInterface.get_editor_language())


func exit() -> void:
	TranslationServer.remove_domain(_domain)


## Puts all languages into a domain and chooses one. Where there is none of that name, the words
## stay English.
static func fill(domain: TranslationDomain, language: String) -> void:
	domain.clear()
	domain.set_locale_override(language)
	for file: String in _FILES:
		var translation: Translation = load(_FOLDER + file) as Translation
		if translation != null:
			domain.add_translation(translation)
