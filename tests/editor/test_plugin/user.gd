@tool
extends RefCounted
## Hands and voice: a mouse and a keyboard that work through the X server, as a user's do.
##
## run.sh listens at the other end of a socket: it presses (xdotool), takes pictures and prints
## what is said. Every function here returns when the editor has had time to take the events: some
## frames. Places on the screen are in pixels; the editor's window begins at (0, 0), and dialogs
## are drawn in it.

const LEFT: int = 1
const MIDDLE: int = 2
const RIGHT: int = 3
const WHEEL_UP: int = 4
const WHEEL_DOWN: int = 5
# What the editor needs to take what xdotool sent: one frame to get the events, one to act, and
# one for what was deferred.
const _FRAMES: int = 4
# The engine reads the X server's events in a thread of its own, which a busy machine may hold up:
# milliseconds that what was done is waited for.
const _MOST_WAIT: int = 5000
# Seconds that anything may take after something was waited for in vain.
const _PATIENCE_LEFT: int = 30

const Seldom: GDScript = preload("./seldom.gd")

## How often the editor is drawn.
var seldom: Seldom = Seldom.new()
## Whether the engine takes the editor for the program that its user works in. plugin.gd keeps it.
## It looks through the project when it becomes true, and that it is false it only finds after a
## quarter of a second without focus: whoever comes back sooner was never away.
var is_worked_in: bool = false
## How often a scene was saved. plugin.gd counts.
var saves: int = 0

# Seconds that anything may take.
var _patience: int = maxi(OS.get_environment("TREE_EDITOR_PATIENCE").to_int(), 5)

var _server: TCPServer = TCPServer.new()
var _peer: StreamPeerTCP
var _heard: String = ""
# Keys and buttons that the editor has seen let go, and where it has seen the mouse.
var _let_go: int = 0
var _mouse: Vector2 = Vector2.INF


## Waits until run.sh has come to the socket whose number is left in `folder`.
func meet(folder: String) -> void:
	_window().window_input.connect(_on_input)
	_server.listen(0, "127.0.0.1")
	var path: String = folder.path_join("port")
	var file: FileAccess = FileAccess.open(path + ".part", FileAccess.WRITE)
	file.store_line(str(_server.get_local_port()))
	file.close()
	DirAccess.rename_absolute(path + ".part", path)
	while not _server.is_connection_available():
		await _frame()
	_peer = _server.take_connection()
	_peer.set_no_delay(true)
	await go()
	await come()


## Seconds that anything may take.
func patience() -> int:
	return _patience


## Something was waited for in vain: what comes after it is often broken, too, and a broken editor
## should be told of before whoever runs all tests ends them.
func lose_patience() -> void:
	_patience = mini(_patience, _PATIENCE_LEFT)


## Brings the keyboard's focus to the editor.
func come() -> void:
	await _focus("editor", true)


## Takes the focus away, as somebody does who works in another program.
func go() -> void:
	await _focus("elsewhere", false)


## The end of all scenarios of this editor. It goes on running: run.sh closes it as a user would.
func end() -> void:
	# Nothing may wait for a frame after this: it might never come, and would leak.
	_peer.put_data("end\n".to_utf8_buffer())


func leave() -> void:
	if _window().window_input.is_connected(_on_input):
		_window().window_input.disconnect(_on_input)
	if _peer != null:
		_peer.disconnect_from_host()
	_server.stop()


## Lets run.sh do something: its name and its arguments, none of which has a tab or a line break.
func ask(words: PackedStringArray) -> void:
	_peer.put_data(("\t".join(words) + "\n").to_utf8_buffer())
	# The mouse and the keys take less time than a frame takes to be drawn.
	var end: int = Time.get_ticks_msec() + (500 if words[0] == "x" else 0)
	while not "\n" in _heard:
		if Time.get_ticks_msec() < end:
			OS.delay_msec(1)
		else:
			await _frame()
		_peer.poll()
		if _peer.get_available_bytes() > 0:
			_heard += _peer.get_utf8_string(_peer.get_available_bytes())
	_heard = _heard.substr(_heard.find("\n") + 1)


func say(line: String) -> void:
	await ask(["say", line.replace("\n", " ").replace("\t", " ")])


## Keeps what the screen shows as build/editor/NN-name.png.
func picture(name: String) -> void:
	seldom.suspended = true
	await frames(_FRAMES)
	await ask(["picture", name])
	seldom.suspended = false


## Returns when all that is seen is as it is now.
func drawn() -> void:
	seldom.suspended = true
	await frames(_FRAMES)
	seldom.suspended = false


func frames(count: int) -> void:
	for i: int in count:
		await _frame()


## Returns when the editor has seen the mouse there: what is under it is known then.
func move(to: Vector2) -> void:
	await glide(to)
	await frames(2)


## Returns when the editor has seen the mouse there, on its way to somewhere else.
func glide(to: Vector2) -> void:
	await ask(["x", "mousemove", str(roundi(to.x)), str(roundi(to.y))])
	await _seen(func() -> bool: return _mouse.distance_to(to.round()) < 1.5, "the mouse")


## Clicks. `modifiers` is something like "shift" or "ctrl+alt".
func click(at: Vector2, button: int = LEFT, modifiers: String = "", times: int = 1) -> void:
	await move(at)
	var press: PackedStringArray = ["click", "--repeat", str(times), "--delay", "40", str(button)]
	await _x(_held(modifiers, press))


## Presses at the first place, goes through the others, and lets go at the last. Between two of them
## the mouse is seen on the way, the less often the more of them there are: each time costs a frame.
func drag(places: PackedVector2Array, button: int = LEFT, modifiers: String = "") -> void:
	await move(places[0])
	for modifier: String in modifiers.split("+", false):
		await _x(["keydown", modifier])
	await _x(["mousedown", str(button)])
	var steps: int = clampi(ceili(20.0 / maxi(places.size() - 1, 1)), 1, 5)
	for i: int in range(1, places.size()):
		for step: int in range(1, steps + 1):
			await glide(places[i - 1].lerp(places[i], float(step) / steps))
	await frames(2)
	await _x(["mouseup", str(button)])
	for modifier: String in modifiers.split("+", false):
		await _x(["keyup", modifier])


## Presses a key by its name in X: "ctrl+z", "Delete", "bracketleft".
func key(name: String) -> void:
	await _x(["key", name])


func type(text: String) -> void:
	await _x(["type", "--delay", "10", text])


func _held(modifiers: String, what: PackedStringArray) -> PackedStringArray:
	var words: PackedStringArray = []
	for modifier: String in modifiers.split("+", false):
		words.append_array(["keydown", modifier])
	words.append_array(what)
	for modifier: String in modifiers.split("+", false):
		words.append_array(["keyup", modifier])
	return words


func _x(words: PackedStringArray) -> void:
	var wanted: int = _let_go + _count_let_go(words)
	await ask(PackedStringArray(["x"]) + words)
	await _seen(func() -> bool: return _let_go >= wanted, " ".join(words))
	await frames(_FRAMES)


# How many keys and buttons are let go by what is asked of xdotool.
static func _count_let_go(words: PackedStringArray) -> int:
	var count: int = words.count("keyup") + words.count("mouseup")
	if words[0] == "key":
		count += words[1].get_slice_count("+")
	elif words[0] == "type":
		count += words[-1].length()
	var click: int = words.find("click")
	if click >= 0:
		count += words[click + 2].to_int()
	return count


# What never comes (a key that the window's own end takes) is no failure here: what should come of
# it is waited for, too.
func _seen(condition: Callable, what: String) -> void:
	var end: int = Time.get_ticks_msec() + _MOST_WAIT
	while not condition.call():
		if Time.get_ticks_msec() > end:
			print("The editor did not see: ", what)
			return
		await _frame()


func _on_input(event: InputEvent) -> void:
	if event is InputEventMouse:
		_mouse = (event as InputEventMouse).position
	if (event is InputEventKey or event is InputEventMouseButton) and not event.is_pressed():
		_let_go += 1


# The engine takes its window for focused from the beginning, whether it is or not, and overlooks
# the first focus that it does get. So where nothing comes of it, it is tried from the other side.
func _focus(where: String, here: bool) -> void:
	var next: int = 0
	var again: bool = false
	var end: int = Time.get_ticks_msec() + 1000 * _patience
	while _window().has_focus() != here or is_worked_in != here:
		if Time.get_ticks_msec() >= next:
			if again:
				await ask(["focus", "elsewhere" if here else "editor"])
				await (Engine.get_main_loop() as SceneTree).create_timer(0.6).timeout
			await ask(["focus", where])
			again = true
			next = Time.get_ticks_msec() + 3000
		if Time.get_ticks_msec() > end:
			lose_patience()
			await say("FAILED  the keyboard's focus does not go to the %s" % where)
			return
		await _frame()


func _frame() -> void:
	await (Engine.get_main_loop() as SceneTree).process_frame


func _window() -> Window:
	return EditorInterface.get_base_control().get_window()
