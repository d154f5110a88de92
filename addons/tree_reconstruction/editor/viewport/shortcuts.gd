@tool
extends RefCounted
## The keys of the viewport, which users find and change in the editor's settings under Shortcuts,
## "tree_reconstruction".

const Session: GDScript = preload("../session.gd")
const _SECTION: String = "tree_reconstruction/"
const NONE: StringName = &""

# What each action is called in the settings, and its keys. The tools' follow from the tools.
const _KEYS: Dictionary[StringName, Array] = {
	&"edit_skeleton": [KEY_TAB],
	&"show_points": [KEY_P],
	&"show_voxels": [KEY_V],
	&"show_skeleton": [KEY_S],
	&"show_mesh": [KEY_T],
	&"show_leaves": [KEY_L],
	&"show_wind": [KEY_E],
	&"show_axes": [KEY_X],
	&"show_grid": [KEY_G],
	&"view_front": [KEY_KP_1],
	&"view_rear": [KEY_MASK_CTRL | KEY_KP_1],
	&"view_right": [KEY_KP_3],
	&"view_left": [KEY_MASK_CTRL | KEY_KP_3],
	&"view_top": [KEY_KP_7],
	&"view_bottom": [KEY_MASK_CTRL | KEY_KP_7],
	&"view_home": [KEY_KP_0],
	&"view_selection": [KEY_F],
	&"turntable": [KEY_O],
	&"compare_photos": [KEY_F4],
	&"edit_sketch": [],
	&"screenshot": [KEY_F9],
	&"select_all": [KEY_MASK_CTRL | KEY_A],
	&"grow_selection": [KEY_EQUAL, KEY_KP_ADD, KEY_PLUS],
	&"shrink_selection": [KEY_MINUS, KEY_KP_SUBTRACT],
	&"delete_selected": [KEY_DELETE],
	&"cancel": [KEY_ESCAPE],
}

# What older versions called actions in the settings, where users may have set their own keys.
const _OLD_NAMES: Dictionary[StringName, StringName] = {&"tool_draw_branch": &"tool_limb"}

# By the action: what stands in for the editor's settings in tests, too.
var _shortcuts: Dictionary[StringName, Shortcut] = {}
var _settings: EditorSettings


## Adds the shortcuts to [param settings], or, without them, keeps the defaults for itself.
func _init(session: Session, settings: EditorSettings) -> void:
	_settings = settings
	for action: StringName in _KEYS:
		_add(action, _KEYS[action])
	for id: StringName in session.tools:
		_add(name_of_tool(id), [session.tools[id].call(&"get_key")])


## The name of the action that chooses a tool.
static func name_of_tool(id: StringName) -> StringName:
	return StringName("tool_" + id)


## Every action that has a shortcut.
func get_actions() -> Array[StringName]:
	return _shortcuts.keys()


## The shortcut of an action, as the user has set it.
func get_shortcut(action: StringName) -> Shortcut:
	if _settings != null and _settings.has_shortcut(_SECTION + action):
		return _settings.get_shortcut(_SECTION + action)
	return _shortcuts.get(action)


## The action that an event asks for, or [constant NONE].
func find(event: InputEvent) -> StringName:
	for action: StringName in _shortcuts:
		var shortcut: Shortcut = get_shortcut(action)
		if shortcut != null and shortcut.matches_event(event):
			return action
	return NONE


## A tooltip with the action's key behind it.
func describe(text: String, action: StringName) -> String:
	var keys: String = get_key_text(action)
	return text if keys.is_empty() else "%s (%s)" % [text, keys]


## The action's key as the user reads it; empty without one.
func get_key_text(action: StringName) -> String:
	var shortcut: Shortcut = get_shortcut(action)
	return shortcut.get_as_text() if shortcut != null and shortcut.has_valid_event() else ""


func _add(action: StringName, keys: Array) -> void:
	var shortcut: Shortcut = Shortcut.new()
	var events: Array = []
	for key: int in keys:
		if key & KEY_CODE_MASK == KEY_NONE:
			continue
		var event: InputEventKey = InputEventKey.new()
		event.keycode = (key & KEY_CODE_MASK) as Key
		event.command_or_control_autoremap = key & KEY_MASK_CTRL != 0
		events.append(event)
	shortcut.events = events
	shortcut.resource_name = action.capitalize()
	_shortcuts[action] = shortcut
	if _settings != null and not _settings.has_shortcut(_SECTION + action):
		var old: StringName = _OLD_NAMES.get(action, NONE)
		if old != NONE and _settings.has_shortcut(_SECTION + old):
			shortcut.events = _settings.get_shortcut(_SECTION + old).events
		_settings.add_shortcut(_SECTION + action, shortcut)
