@tool
extends "looking.gd"
## What every scenario extends: a run() that goes through steps, each of which is what a user does
## and what should come of it.
##
## A step passes when all its checks hold and the editor reported no error that expect_error() did
## not announce. What the next line needs is waited for with `if not await until(…): return`.

const User: GDScript = preload("./user.gd")
const ErrorCollector: GDScript = preload("./error_collector.gd")

# What the editor reports by itself where there is no window manager, no sound and no network.
const _NOISE: PackedStringArray = []

# A condition rests so many times as long as it took.
const _REST: int = 4
# Of a sun whose shadows were switched off.
const _CASTS: StringName = &"editor_test_casts_shadows"

var user: User
var errors: ErrorCollector
var title: String

var _step: String = ""
var _failures: PackedStringArray = []
var _expected: PackedStringArray = []
var _seen: PackedStringArray = []
var _started: int = 0


## What the scenario does.
func run() -> void:
	check(false, "This scenario has no run().")


## Ends the step before and begins one that does what `what` says.
func step(what: String) -> void:
	await _judge()
	cast_shadows(false)
	_step = what
	_started = Time.get_ticks_msec()


## Called by the plugin after run().
func finish() -> void:
	await _judge()


## Fails the step with `message` unless `condition` holds.
func check(condition: bool, message: String) -> bool:
	if not condition:
		var place: String = ""
		for frame: Dictionary in get_stack():
			if not str(frame.source).ends_with("/scenario.gd"):
				place = " (%s:%d)" % [str(frame.source).get_file(), frame.line]
				break
		_failures.append(message + place)
	return condition


## Fails the step unless `given` equals `wanted`.
func check_equal(given: Variant, wanted: Variant, what: String) -> bool:
	return check(
		typeof(given) == typeof(wanted) and given == wanted,
		"%s is %s instead of %s" % [what, str(given).left(200), str(wanted).left(200)]
	)


## Fails the step where something has made the editor larger than its window.
func check_fits() -> void:
	var base: Control = EditorInterface.get_base_control()
	for node: Node in base.find_children("*", "Control", true, false):
		var control: Control = node as Control
		if not control.is_visible_in_tree() or not control.get_parent() is Container:
			continue
		# What is in a list that scrolls may be larger.
		if control.get_window() == base.get_window() and not _is_in_scroll(control):
			var over: Vector2 = control.get_global_rect().end - base.size
			check(over.y < 4.0, "%s ends %d px below the window" % [control.get_path(), over.y])
			if over.y >= 4.0:
				return


## Announces that the editor will report an error containing `part`; the step fails if it does
## not.
func expect_error(part: String) -> void:
	_expected.append(part)


## Whether an announced error has come.
func has_seen(part: String) -> bool:
	_sort_errors()
	return part in _seen


## Waits until `condition` holds. Fails the step, with a picture, where that takes too long. What it
## waits for needs the cores, too: a condition that looks through the editor is asked less often.
func until(condition: Callable, what: String) -> bool:
	var end: int = Time.get_ticks_msec() + 1000 * user.patience()
	var next: int = 0
	while true:
		var now: int = Time.get_ticks_msec()
		if now >= next:
			if condition.call():
				return true
			next = now + _REST * (Time.get_ticks_msec() - now)
		if now > end:
			user.lose_patience()
			check(false, "In vain waited until " + what)
			await user.picture("FAILED-" + title)
			return false
		await tree.process_frame
	return false


## Double-clicks, again if nothing comes of it: the engine takes two presses for one double click
## only where it handles both within 0.4 s, and a busy machine may not.
func double_click(at: Vector2, condition: Callable, what: String) -> bool:
	for i: int in 3:
		await user.click(at, User.LEFT, "", 2)
		var end: int = Time.get_ticks_msec() + 4000
		while Time.get_ticks_msec() < end:
			if condition.call():
				return true
			await tree.process_frame
	return await until(condition, what)


## Whether the editor's own suns cast shadows. Without a graphics card a frame takes up to half as
## long again with them: the engine draws what stands there for each of four parts of the view.
func cast_shadows(wanted: bool) -> void:
	var base: Control = EditorInterface.get_base_control()
	for node: Node in base.find_children("*", "DirectionalLight3D", true, false):
		var sun: DirectionalLight3D = node as DirectionalLight3D
		if sun.owner == null and sun.shadow_enabled:
			sun.set_meta(_CASTS, true)
		if sun.has_meta(_CASTS):
			sun.shadow_enabled = wanted


## Waits until the editor's camera has come to where it goes.
func view_rests() -> bool:
	var places: Array[Transform3D] = []
	return await until(
		func() -> bool:
			var now: Transform3D = view().get_camera_3d().global_transform
			if not places.is_empty() and places[-1] != now:
				places.clear()
			places.append(now)
			return places.size() > 8,
		"the view rests"
	)


func picture(name: String) -> void:
	await user.picture(name)


## Clicks on the middle of a control that can be seen.
func press(control: Control, button: int = User.LEFT, times: int = 1) -> void:
	if check(control != null and control.is_visible_in_tree(), "There is nothing to press."):
		await user.click(middle(control), button, "", times)


## Takes an entry of the menu that opens, as a mouse finds it: by going down until it is lit.
func choose(text: String) -> bool:
	if not await until(func() -> bool: return open_menu() != null, "a menu opens"):
		return false
	var menu: PopupMenu = open_menu()
	var wanted: int = -1
	for i: int in menu.item_count:
		if menu.get_item_text(i).begins_with(text):
			wanted = i
	if not check(wanted >= 0, "The menu has no '%s'." % text):
		await user.key("Escape")
		return false
	# From a guess, for entries are about as high as each other, down and up. Again and again: a
	# menu that has just opened takes no notice of a mouse until it has moved for a while.
	var row: float = float(menu.size.y) / menu.item_count
	var guess: float = menu.position.y + (wanted + 0.5) * row
	for attempt: int in 10:
		for away: int in range(0, int(maxf(row, 1.0)) * 4, 3):
			for side: float in [away, -away]:
				var at: Vector2 = Vector2(menu.position.x + menu.size.x * 0.4, guess + side)
				if not Rect2(menu.position, menu.size).has_point(at):
					continue
				await user.move(at)
				if not check(menu.visible, "The menu closed before '%s' was taken." % text):
					return false
				if menu.get_focused_item() == wanted and await _take_entry(menu, at):
					return true
	await user.picture("FAILED-" + title)
	await user.key("Escape")
	return check(false, "The mouse finds no '%s' in the menu." % text)


# Whether a click there takes an entry, or opens a menu of its own.
func _take_entry(menu: PopupMenu, at: Vector2) -> bool:
	var taken: Array[bool] = [false]
	var note: Callable = func(_entry: int) -> void: taken[0] = true
	menu.index_pressed.connect(note)
	await user.click(at)
	var end: int = Time.get_ticks_msec() + 3000
	while not taken[0] and open_menu() == menu and Time.get_ticks_msec() < end:
		await tree.process_frame
	if is_instance_valid(menu):
		menu.index_pressed.disconnect(note)
	return taken[0] or open_menu() != menu


## The place of an entry of a list or tree of the editor on the screen; scrolls to it.
func item_place(list: Tree, item: TreeItem) -> Vector2:
	item.uncollapse_tree()
	list.scroll_to_item(item)
	await user.frames(3)
	for y: int in range(4, int(list.size.y), 6):
		for x: float in [0.35, 0.5, 0.2, 0.7]:
			var at: Vector2 = Vector2(list.size.x * x, y + 4.0)
			if list.get_item_at_position(at) == item:
				return list.get_screen_transform() * at
	check(false, "The entry '%s' cannot be seen." % item.get_text(0))
	return Vector2.ZERO


## Clicks on the entry that `find` returns. Lists move while the editor looks through files, so the
## mouse goes there first, and looks.
func click_entry(list: Tree, find: Callable, button: int = User.LEFT) -> bool:
	for attempt: int in 20:
		var item: TreeItem = find.call()
		if item != null:
			await user.move(await item_place(list, item))
			item = find.call()
			if item != null and list.get_item_at_position(list.get_local_mouse_position()) == item:
				await user.click(await item_place(list, item), button)
				return true
		await user.frames(10)
	return check(false, "The mouse can't get hold of an entry of a list.")


## Makes a scene of `root`, which is freed, saves it and opens it.
func open_scene(root: Node, path: String) -> bool:
	var packed: PackedScene = PackedScene.new()
	packed.pack(root)
	root.free()
	ResourceSaver.save(packed, path)
	EditorInterface.get_resource_filesystem().update_file(path)
	EditorInterface.open_scene_from_path(path)
	return await until(func() -> bool: return scene_path() == path, path + " is open")


## Saves the edited scene with Ctrl+S. The engine takes some frames for it, and writes whatever
## scene is open then.
func save_scene() -> bool:
	var before: int = user.saves
	await user.key("ctrl+s")
	if not await until(func() -> bool: return user.saves > before, "a scene is saved"):
		return false
	return await until(func() -> bool: return not is_unsaved(), "the scene is saved")


## Bytes by which two states of a tree are told apart.
func bytes(of: Resource) -> PackedByteArray:
	return var_to_bytes(of.get(&"skeleton"))


func _judge() -> void:
	if _step.is_empty():
		return
	_sort_errors()
	for part: String in _expected:
		if not part in _seen:
			_failures.append("No error said '%s'." % part)
	var took: float = (Time.get_ticks_msec() - _started) / 1000.0
	var line: String = "%s: %s (%.1f s)" % [title, _step, took]
	await user.say(("ok      " if _failures.is_empty() else "FAILED  ") + line)
	for failure: String in _failures:
		await user.say("        " + failure)
	_step = ""
	_failures = []
	_expected = []
	_seen = []


func _is_in_scroll(control: Control) -> bool:
	var above: Node = control.get_parent()
	while above != null:
		if above is ScrollContainer or above is SubViewport:
			return true
		above = above.get_parent()
	return false


# Those that were announced, and those that fail the step.
func _sort_errors() -> void:
	for error: String in errors.take():
		var known: bool = false
		for part: String in _expected:
			if part in error:
				known = true
				_seen.append(part)
		for part: String in _NOISE:
			known = known or part in error
		if not known:
			_failures.append("The editor reported: " + error)
