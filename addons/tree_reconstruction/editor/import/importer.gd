@tool
extends EditorImportPlugin
## Imports scans, and skeletons made elsewhere, as a [TreeReconstruction].

## A scan could not be imported. Emitted on the main thread.
signal failed(path: String, sentence: String)
## A scan was imported. Emitted on the main thread.
signal imported(path: String, summary: String)

const ImportOptions: GDScript = preload("./import_options.gd")
const ScanFiles: GDScript = preload("./scan_files.gd")
const Sentences: GDScript = preload("../translations/sentences.gd")

# A new number imports all scans again.
const _FORMAT_VERSION: int = 1
# A reconstruction uses several threads itself, and the memory of its scan.
const _CORES_PER_SCAN: int = 4

var _slots: Semaphore = Semaphore.new()


func _init() -> void:
	for i: int in maxi(1, int(OS.get_processor_count() / float(_CORES_PER_SCAN))):
		_slots.post()


func _get_importer_name() -> String:
	return "tree_reconstruction.scan"


func _get_visible_name() -> String:
	return tr("Tree from Scan")


func _get_recognized_extensions() -> PackedStringArray:
	return ScanFiles.SCANS + ScanFiles.SKELETONS + PackedStringArray([ScanFiles.STAND_IN])


func _get_save_extension() -> String:
	return "res"


func _get_resource_type() -> String:
	return "TreeReconstruction"


func _get_format_version() -> int:
	return _FORMAT_VERSION


func _get_priority() -> float:
	return 1.0


func _get_import_order() -> int:
	# Before scenes, which may hold trees.
	return 0


func _get_preset_count() -> int:
	return ImportOptions.PRESETS.size()


func _get_preset_name(preset_index: int) -> String:
	var names: PackedStringArray = [
		tr("Laser scan"), tr("Photogrammetry"), tr("Leaf-off"), tr("Leafy"), tr("Fast")
	]
	return names[preset_index]


func _get_import_options(path: String, preset_index: int) -> Array[Dictionary]:
	return ImportOptions.list(preset_index, self, path)


func _get_option_visibility(path: String, option_name: StringName, options: Dictionary) -> bool:
	return ImportOptions.is_visible(path, ScanFiles.is_skeleton(path), option_name, options)


func _can_import_threaded() -> bool:
	return true


func _import(
	source_file: String,
	save_path: String,
	options: Dictionary,
	_platform_variants: Array[String],
	_gen_files: Array[String]
) -> Error:
	_slots.wait()
	var error: Error = _make(source_file, "%s.%s" % [save_path, _get_save_extension()], options)
	_slots.post()
	return error


func _make(source_file: String, target: String, options: Dictionary) -> Error:
	var scan: String = source_file
	if source_file.get_extension().to_lower() == ScanFiles.STAND_IN:
		var found: Dictionary = ScanFiles.read_stand_in(source_file)
		if found.has("error"):
			return _fail(source_file, found["error"])
		scan = found["scan"]
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	var tree: TreeReconstruction
	if ScanFiles.is_skeleton(scan):
		var up: String = options.get("scan/up_axis", "auto")
		var number: int = options.get("scan/tree_in_file", 0)
		var dialect: LSystem.Dialect = options.get("scan/dialect", LSystem.DIALECT_TOLD)
		tree = reconstructor.import_skeleton(scan, "z" if up == "auto" else up, number, dialect)
		var leaves: String = options.get("leaves/preset", "auto")
		if tree != null and leaves != "auto":
			tree.leaf_preset = leaves
	else:
		tree = reconstructor.reconstruct_file(scan, ImportOptions.to_options(options))
	if tree == null:
		return _fail(source_file, reconstructor.get_error_message())
	tree.resource_name = source_file.get_file().get_basename()
	var error: Error = ResourceSaver.save(tree, target, ResourceSaver.FLAG_COMPRESS)
	if error != OK:
		return _fail(source_file, tr("The tree could not be saved: %s.") % error_string(error))
	_tell.call_deferred(source_file, _summary(tree, reconstructor.get_report()))
	return OK


func _fail(source_file: String, sentence: String) -> Error:
	sentence = Sentences.translate(sentence, get_translation_domain())
	sentence = sentence.replace(ProjectSettings.globalize_path("res://"), "res://")
	if source_file not in sentence:
		sentence = "'%s': %s" % [source_file, sentence]
	push_error(sentence)
	failed.emit.call_deferred(source_file, sentence)
	return ERR_CANT_CREATE


func _tell(source_file: String, summary: String) -> void:
	print("%s: %s" % [source_file, summary])
	imported.emit(source_file, summary)


# What came of the scan, in a line, and what the user should know of it.
func _summary(tree: TreeReconstruction, report: Dictionary) -> String:
	var text: String = (
		tr("a tree of %.1f m with %d nodes") % [tree.get_aabb().size.y, tree.get_node_count()]
	)
	if report.has("fidelity"):
		var fidelity: Dictionary = report["fidelity"]
		text += (
			tr(", %.0f %% of the scan within 2 cm of it") % (100.0 * float(fidelity["explained"]))
		)
	text += "."
	for warning: String in report.get("warnings", []):
		text += " " + Sentences.translate(warning, get_translation_domain())
	return text
