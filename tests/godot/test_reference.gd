extends "./suite.gd"
## The class reference covers every class and member, in whole sentences.

const CLASSES: PackedStringArray = [
	"LSystem", "LeafRule", "TreeEdit", "TreeFidelity", "TreeReconstruction", "TreeReconstructor"
]
const HERE: String = "../../extension/doc_classes/%s.xml"


func test_every_member_is_described() -> void:
	for name: String in CLASSES:
		check(ClassDB.class_exists(name), "There is no class %s." % name)
		var texts: Dictionary[String, String] = _read(name)
		check_sentence(texts.get("brief_description", ""), name + "'s brief description")
		check_sentence(texts.get("description", ""), name + "'s description")
		var accessors: Dictionary[String, bool] = {}
		for property: Dictionary in ClassDB.class_get_property_list(name, true):
			if property.usage & (PROPERTY_USAGE_GROUP | PROPERTY_USAGE_CATEGORY):
				continue
			accessors[ClassDB.class_get_property_getter(name, property.name)] = true
			accessors[ClassDB.class_get_property_setter(name, property.name)] = true
			_check_text(texts, name, "member", property.name)
		for method: Dictionary in ClassDB.class_get_method_list(name, true):
			if not accessors.has(method.name) and not method.name.begins_with("_"):
				_check_text(texts, name, "method", method.name)
		for event: Dictionary in ClassDB.class_get_signal_list(name, true):
			_check_text(texts, name, "signal", event.name)
		for constant: String in ClassDB.class_get_integer_constant_list(name, true):
			_check_text(texts, name, "constant", constant)


func test_every_option_is_described() -> void:
	var text: String = _read("TreeReconstructor").get("method reconstruct_file", "")
	for option: Dictionary in TreeReconstructor.get_option_list():
		check(
			text.contains("[code]%s[/code]" % option.name),
			"reconstruct_file's description does not name the option %s." % option.name
		)


func test_classes_are_links() -> void:
	var base: String = (get_script() as Script).resource_path.get_base_dir()
	for name: String in CLASSES:
		var text: String = FileAccess.get_file_as_string(
			base.path_join(HERE % name).simplify_path()
		)
		for class_called: String in CLASSES + PackedStringArray(["TreeInstance3D"]):
			check(
				not text.contains("[code]%s[/code]" % class_called),
				"%s.xml names %s without a link." % [name, class_called]
			)


func _check_text(
	texts: Dictionary[String, String], of: String, kind: String, member: String
) -> void:
	var text: String = texts.get(kind + " " + member, "")
	check(text.length() > 10 and text.ends_with("."), "%s.%s (%s): '%s'" % [of, member, kind, text])


# "method build_mesh" and so on -> the description.
func _read(name: String) -> Dictionary[String, String]:
	var texts: Dictionary[String, String] = {}
	var base: String = (get_script() as Script).resource_path.get_base_dir()
	var parser: XMLParser = XMLParser.new()
	check_equal(
		parser.open(base.path_join(HERE % name).simplify_path()), OK, "opening " + name + ".xml"
	)
	var owner: String = ""
	var element: String = ""
	while parser.read() == OK:
		match parser.get_node_type():
			XMLParser.NODE_ELEMENT:
				element = parser.get_node_name()
				if element in ["method", "member", "signal", "constant"]:
					owner = element + " " + parser.get_named_attribute_value("name")
			XMLParser.NODE_TEXT:
				var text: String = parser.get_node_data().strip_edges()
				if text.is_empty():
					continue
				if element == "description" and owner.is_empty():
					texts["description"] = text
				elif element == "brief_description":
					texts["brief_description"] = text
				elif not owner.is_empty():
					texts[owner] = text
			XMLParser.NODE_ELEMENT_END:
				if parser.get_node_name() in ["method", "member", "signal", "constant"]:
					owner = ""
	return texts


func test_scripts_are_documented() -> void:
	var script: Script = load("res://addons/tree_reconstruction/nodes/tree_instance_3d.gd")
	var lines: PackedStringArray = script.source_code.split("\n")
	var depth_ended: bool = false
	for i: int in lines.size():
		var line: String = lines[i]
		depth_ended = depth_ended or line.begins_with("class ")
		if depth_ended:
			break
		var public: bool = (
			line.begins_with("@export") and not line.begins_with("@export_group")
			or line.begins_with("func ") and not line.begins_with("func _")
			or line.begins_with("signal ")
			or line.begins_with("static var ")
		)
		if public:
			check(lines[i - 1].begins_with("##"), "Undocumented: " + line)
