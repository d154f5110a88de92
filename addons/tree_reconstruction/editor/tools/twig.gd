@tool
extends "wood_tool.gd"
## Adds a short twig to the left or right of the view, to graft onto (the thesis' algorithm 5).

var _left: bool


func _init(left: bool) -> void:
	_left = left


func get_id() -> StringName:
	return &"twig_left" if _left else &"twig_right"


func get_title() -> String:
	return tr("Twig to the left") if _left else tr("Twig to the right")


func get_tooltip() -> String:
	if _left:
		return tr(
			(
				"Adds a short twig to the left of the view to each selected node at once, and to nodes"
				+ " that you click then. Twigs are there to graft onto."
			)
		)
	return tr(
		(
			"Adds a short twig to the right of the view to each selected node at once, and to nodes"
			+ " that you click then. Twigs are there to graft onto."
		)
	)


func get_icon() -> String:
	return (
		"res://addons/tree_reconstruction/icons/tools/%s.svg"
		% ("twig_left" if _left else "twig_right")
	)


func get_key() -> Key:
	return KEY_BRACKETLEFT if _left else KEY_BRACKETRIGHT


func get_defaults() -> Dictionary[StringName, Variant]:
	return {&"length": 0.0}


func make_settings() -> Control:
	_restore()
	var strip: Strip = Strip.new()
	strip.add_number(
		tr("Length (m)"),
		tr("How long the twig is. 0: what suits the wood that it grows from."),
		0.0,
		1.0,
		0.01,
		values[&"length"],
		set_setting.bind(&"length")
	)
	strip.add_button(
		tr("Add to the selected nodes"),
		tr("Adds a twig to each selected node, as the tool's key does."),
		accept
	)
	return strip


func start() -> void:
	super()
	if not session.selection.is_empty():
		# Once everybody knows that it is chosen.
		accept.call_deferred()


func get_command_at(id: int) -> String:
	var command: String = (
		"twig node=%d side=%s length=%s"
		% [id, "left" if _left else "right", String.num(values[&"length"], 4)]
	)
	if _eye != null:
		command += (
			" view=%s up=%s"
			% [words_of(view_direction(Vector3.FORWARD)), words_of(view_direction(Vector3.UP))]
		)
	return command


func _finish(edit: TreeEdit) -> void:
	if edit != null:
		session.select(edit.get_result_nodes())
	super(edit)
