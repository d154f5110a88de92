@tool
extends RefCounted
## What the Import dock shows of [TreeReconstructor]'s options: in groups, with presets, and back
## again. Options that this file does not know appear under Advanced by themselves.

## New ones come last: files keep their numbers.
enum Unit {
	GUESS,
	METRES,
	CENTIMETRES,
	MILLIMETRES,
	FEET,
	INCHES,
	OTHER,
	TREE_HEIGHT,
	TWO_PLACES,
	SURVEY_FEET,
}

const PRESETS: PackedStringArray = ["Laser scan", "Photogrammetry", "Leaf-off", "Leafy", "Fast"]

## By [constant PRESETS]: what differs from the defaults, which are for laser scans.
const PRESET_VALUES: Array[Dictionary] = [
	{},
	# Pictures leave gaps where the reconstruction of their points failed.
	{"skeleton/complete": true, "advanced/outlier_deviations": 4.0},
	# Thin twigs are easily taken for leaves.
	{"leaves/tell_leaves": false, "skeleton/complete": true},
	# The twigs inside of a leafy crown are hardly seen: what is short there is noise.
	{
		"leaves/tell_leaves": true,
		"skeleton/complete": true,
		"advanced/minimum_branch": 0.3,
	},
	{"skeleton/spacing": 0.03, "cleaning/remove_outliers": false},
]
const _METRES: Dictionary[Unit, float] = {
	Unit.METRES: 1.0,
	Unit.CENTIMETRES: 0.01,
	Unit.MILLIMETRES: 0.001,
	Unit.FEET: 0.3048,
	Unit.INCHES: 0.0254,
	Unit.SURVEY_FEET: 1200.0 / 3937.0,
}
# Where a project keeps what it imports with if nothing else is said.
const _PROJECT_DEFAULTS: String = "importer_defaults/tree_reconstruction.scan"
# The old name of skeleton/algorithm, from when "delaunay" was the word for what is geodesic now.
const _OLD_METHOD: String = "skeleton/method"
# Which option stands where, in the order of the dock.
const _PLACES: Dictionary[String, String] = {
	"scan/up_axis": "up",
	"scan/unit": "",
	"scan/metres_per_unit": "scale",
	"scan/tree_height": "known_height",
	"scan/known_length": "known_length",
	"scan/columns": "columns",
	"scan/classes": "classes",
	"scan/tree_in_file": "",
	"scan/dialect": "",
	"cleaning/remove_outliers": "remove_outliers",
	"cleaning/remove_fragments": "remove_fragments",
	"cleaning/remove_ground": "remove_ground",
	"cleaning/remove_extreme_colors": "remove_extreme_colors",
	"cleaning/separate_trees": "separate_trees",
	"cleaning/tree_number": "tree_number",
	"skeleton/algorithm": "skeleton",
	"skeleton/voxel": "voxel",
	"skeleton/spacing": "spacing",
	"skeleton/complete": "complete",
	"leaves/preset": "leaves",
	"leaves/tell_leaves": "tell_leaves",
}
# For debugging the flood; nothing is kept of them in a file.
const _HIDDEN: PackedStringArray = ["flood_steps"]
# Shown only where another parameter has one of these values.
const _NEEDS: Dictionary[String, Array] = {
	"scan/metres_per_unit": ["scan/unit", [Unit.OTHER]],
	"scan/tree_height": ["scan/unit", [Unit.TREE_HEIGHT]],
	"scan/known_length": ["scan/unit", [Unit.TWO_PLACES]],
	"cleaning/tree_number": ["cleaning/separate_trees", [true]],
	"skeleton/voxel": ["skeleton/algorithm", ["flood"]],
	"advanced/flood": ["skeleton/algorithm", ["flood"]],
	"advanced/spanning_tree": ["skeleton/algorithm", ["delaunay"]],
	"advanced/tree_position": ["cleaning/separate_trees", [true]],
	"advanced/white_above": ["cleaning/remove_extreme_colors", [true]],
	"advanced/black_below": ["cleaning/remove_extreme_colors", [true]],
	"advanced/neighbours": ["cleaning/remove_outliers", [true]],
	"advanced/outlier_deviations": ["cleaning/remove_outliers", [true]],
}
const _OF_SKELETONS: PackedStringArray = ["scan/up_axis", "scan/tree_in_file", "leaves/preset"]
const _LAS_FORMATS: PackedStringArray = ["las", "laz", "treescan"]
const _TEXT_FORMATS: PackedStringArray = ["xyz", "pts", "asc", "treescan"]


## The parameters of a preset, as [method EditorImportPlugin._get_import_options] returns them, with
## their choices in the language of [param of]. What a file at [param path] was imported with under
## an old name is the default of the new one.
static func list(preset: int, of: Object, path: String = "") -> Array[Dictionary]:
	var options: Dictionary[String, Dictionary] = {}
	for option: Dictionary in TreeReconstructor.get_option_list():
		options[option["name"]] = option
	var parameters: Array[Dictionary] = []
	for place: String in _PLACES:
		if place == "scan/unit":
			parameters.append(_parameter(place, Unit.GUESS, PROPERTY_HINT_ENUM, _units(of)))
		elif place == "scan/tree_in_file":
			parameters.append(_parameter(place, 0, PROPERTY_HINT_RANGE, "0,100,1,or_greater"))
		elif place == "scan/dialect":
			parameters.append(
				_parameter(
					place, LSystem.DIALECT_TOLD, PROPERTY_HINT_ENUM, "Turtle,Paper,As It Says"
				)
			)
		elif place == "scan/known_length":
			# Text takes what other programs copy, and keeps the digits of large coordinates.
			var example: String = "x, y, z, x, y, z, metres"
			parameters.append(_parameter(place, "", PROPERTY_HINT_PLACEHOLDER_TEXT, example))
		elif options.has(_PLACES[place]):
			parameters.append(_of_option(place, options[_PLACES[place]]))
		options.erase(_PLACES[place])
	for name: String in options:
		if name not in _HIDDEN:
			parameters.append(_of_option("advanced/" + name, options[name]))
	var values: Dictionary = PRESET_VALUES[clampi(preset, 0, PRESETS.size() - 1)]
	for parameter: Dictionary in parameters:
		if values.has(parameter["name"]):
			parameter["default_value"] = values[parameter["name"]]
		if parameter["name"] == "skeleton/algorithm":
			var old: String = _old_method(path)
			if old in (parameter["hint_string"] as String).split(","):
				parameter["default_value"] = old
	return parameters


# The skeleton method as files and the project's defaults have it that are from before the parameter
# had its name, in the words of today; empty where there is none.
static func _old_method(path: String) -> String:
	var values: Dictionary = ProjectSettings.get_setting(_PROJECT_DEFAULTS, {})
	var config: ConfigFile = ConfigFile.new()
	if not path.is_empty() and FileAccess.file_exists(path + ".import"):
		if config.load(path + ".import") != OK:
			# The engine reads it too, and says so.
			return ""
		values = {}
		for name: String in [_OLD_METHOD, "skeleton/algorithm"]:
			if config.has_section_key("params", name):
				values[name] = config.get_value("params", name)
	if values.has("skeleton/algorithm") or not values.get(_OLD_METHOD) is String:
		return ""
	var word: String = values[_OLD_METHOD]
	return "geodesic" if word == "delaunay" else word


# In the order of Unit. The values are numbers, so that the words may be any.
static func _units(of: Object) -> String:
	var words: PackedStringArray = [
		of.tr("Guess"),
		of.tr("Metres"),
		of.tr("Centimetres"),
		of.tr("Millimetres"),
		of.tr("Feet"),
		of.tr("Inches"),
		of.tr("Other Unit"),
		of.tr("From the Tree's Height"),
		of.tr("From a Known Length"),
		of.tr("US Survey Feet"),
	]
	return ",".join(words)


## Whether the dock shows the parameter for this file.
static func is_visible(path: String, skeleton: bool, name: String, values: Dictionary) -> bool:
	if name == "scan/dialect":
		return path.is_empty() or path.get_extension().to_lower() == "lstring"
	if skeleton:
		return name in _OF_SKELETONS
	if name == "scan/tree_in_file":
		return path.is_empty()
	if name == "scan/classes":
		return path.is_empty() or path.get_extension().to_lower() in _LAS_FORMATS
	if name == "scan/columns":
		return path.is_empty() or path.get_extension().to_lower() in _TEXT_FORMATS
	var need: Array = _NEEDS.get(name, [])
	if need.is_empty() or not values.has(need[0]):
		return true
	return values[need[0]] in need[1]


## What the option behind a parameter does, in a sentence of the library; empty where there is none.
static func get_description(parameter: String) -> String:
	var name: String = _PLACES.get(parameter, parameter.trim_prefix("advanced/"))
	for option: Dictionary in TreeReconstructor.get_option_list():
		if option["name"] == name:
			return option["description"]
	return ""


## The parameters as options for [method TreeReconstructor.reconstruct_file]: those that differ
## from its defaults.
static func to_options(values: Dictionary) -> Dictionary:
	var options: Dictionary = {}
	for option: Dictionary in TreeReconstructor.get_option_list():
		var name: String = option["name"]
		var place: Variant = _PLACES.find_key(name)
		var value: Variant = values.get("advanced/" + name if place == null else place)
		if value == null or name in ["scale", "known_height", "known_length"]:
			continue
		if value != option["default"]:
			options[name] = value
	_add_scale(values, options)
	return options


static func _add_scale(values: Dictionary, options: Dictionary) -> void:
	var unit: Unit = values.get("scan/unit", Unit.GUESS)
	match unit:
		Unit.GUESS:
			pass
		Unit.OTHER:
			options["scale"] = values.get("scan/metres_per_unit", 0.0)
		Unit.TREE_HEIGHT:
			options["known_height"] = values.get("scan/tree_height", 0.0)
		Unit.TWO_PLACES:
			options["known_length"] = parse_numbers(values.get("scan/known_length", ""))
		_:
			options["scale"] = _METRES[unit]


## The numbers in a text, whatever stands between them. A word that is no number becomes NaN, so
## that the reconstruction refuses it.
static func parse_numbers(text: String) -> PackedFloat64Array:
	var numbers: PackedFloat64Array = []
	for separator: String in [",", ";", "\t", "(", ")"]:
		text = text.replace(separator, " ")
	for word: String in text.split(" ", false):
		numbers.append(word.to_float() if word.is_valid_float() else NAN)
	return numbers


static func _of_option(place: String, option: Dictionary) -> Dictionary:
	return _parameter(place, option["default"], option["hint"], option["hint_string"])


static func _parameter(place: String, value: Variant, hint: int, hint_string: String) -> Dictionary:
	return {
		"name": place, "default_value": value, "property_hint": hint, "hint_string": hint_string
	}
