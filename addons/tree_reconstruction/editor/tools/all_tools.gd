@tool
extends RefCounted
## The tools, in the order of the toolbar.

const Session: GDScript = preload("../session.gd")
const Tool: GDScript = preload("tool.gd")
const _TOOLS: Array[GDScript] = [
	preload("select.gd"),
]


## Makes them all for a session.
static func add_to(session: Session) -> void:
	for script: GDScript in _TOOLS:
		var tool: Tool = script.new()
		tool.session = session
		tool.set_translation_domain(session.get_translation_domain())
		session.tools[tool.get_id()] = tool
