@tool
extends EditorPlugin
## Runs the scenarios of one folder, one after another, in the editor that it finds itself in.
##
## tests/editor/run.sh starts the editor with TREE_EDITOR_TEST naming its temporary folder and
## TREE_EDITOR_SCENARIOS the scripts to run. Each of them extends scenario.gd and has a run();
## what it does goes out to the X server through User, and what it finds comes back as lines of
## this plugin: 'ok …' and 'FAILED …' for every step, counted by run.sh.

const User: GDScript = preload("./user.gd")
const ErrorCollector: GDScript = preload("./error_collector.gd")

var _user: User
var _errors: ErrorCollector


func _enter_tree() -> void:
	_errors = ErrorCollector.new()
	OS.add_logger(_errors)
	_user = User.new()
	scene_saved.connect(_on_scene_saved)
	_start.call_deferred()


func _exit_tree() -> void:
	_user.leave()
	OS.remove_logger(_errors)


func _notification(what: int) -> void:
	if what == NOTIFICATION_APPLICATION_FOCUS_IN and _user != null:
		_user.is_worked_in = true
	elif what == NOTIFICATION_APPLICATION_FOCUS_OUT and _user != null:
		_user.is_worked_in = false


func _on_scene_saved(_path: String) -> void:
	_user.saves += 1


func _start() -> void:
	if OS.get_environment("TREE_EDITOR_TEST").is_empty():
		return
	await _user.meet(OS.get_environment("TREE_EDITOR_TEST"))
	_user.seldom.begin()
	while not _is_ready():
		await get_tree().process_frame
	await _user.say("-- the editor is open after %.1f s" % (Time.get_ticks_msec() / 1000.0))
	for path: String in OS.get_environment("TREE_EDITOR_SCENARIOS").split(" ", false):
		await _run(path)
	_user.seldom.end()
	_user.end()


func _is_ready() -> bool:
	var files: EditorFileSystem = EditorInterface.get_resource_filesystem()
	return not files.is_scanning() and files.get_filesystem() != null


func _run(path: String) -> void:
	var title: String = path.get_file().get_basename()
	# Here, not with this script: scenarios may name the classes of the addon, which is loaded later.
	var script: GDScript = load(path) as GDScript
	if script == null or not script.can_instantiate():
		await _user.say("FAILED  %s does not compile." % title)
		return
	var scenario: RefCounted = script.new()
	scenario.set(&"user", _user)
	scenario.set(&"errors", _errors)
	scenario.set(&"title", title)
	scenario.set(&"tree", get_tree())
	@warning_ignore("unsafe_method_access")
	await scenario.run()
	@warning_ignore("unsafe_method_access")
	await scenario.finish()
