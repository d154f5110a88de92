@tool
extends RefCounted
## The tools, in the order of the toolbar.

const Session := preload("../session.gd")
const Tool := preload("tool.gd")
const _TOOLS: Array[GDScript] = [
	preload("select.gd"),
	preload("move.gd"),
	preload("prune.gd"),
	preload("cut.gd"),
	preload("slice.gd"),
	preload("grow.gd"),
	preload("twig_left.gd"),
	preload("twig_right.gd"),
	preload("pick.gd"),
	preload("graft.gd"),
	preload("smooth.gd"),
	preload("simplify.gd"),
	preload("leaf_rule.gd"),
	preload("length.gd"),
	preload("complete.gd"),
	preload("draw_branch.gd"),
	preload("paint_bark.gd"),
	preload("doubt.gd"),
	preload("unfit.gd"),
	preload("flood.gd"),
]


## Makes them all for a session.
static func add_to(session: Session) -> void:
	for script: GDScript in _TOOLS:
		var tool: Tool = script.new()
		tool.session = session
		tool.set_translation_domain(session.get_translation_domain())
		session.tools[tool.get_id()] = tool
