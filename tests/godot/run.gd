extends SceneTree
## Runs the tests of this folder in the engine:
##
##     godot --headless --path project --script tests/godot/run.gd [-- --rendering] [--only=SUITE]
##
## Suites named render_*.gd need a window and run only with --rendering, the others (test_*.gd) only
## without. The last line is 'N passed, N failed'; the exit code is 1 if any failed.

const ErrorCollector := preload("./error_collector.gd")
const Suite: GDScript = preload("./suite.gd")
# A test that takes longer has hung, though frames go on. The longest takes a fifth of it.
const MOST_MSEC: int = 400_000

var _passed: int = 0
var _failed: int = 0
var _errors: ErrorCollector = ErrorCollector.new()
var _running: String = ""
var _kept: Array[Shader] = []
var _started: int = 0


func _initialize() -> void:
	_run.call_deferred()


func _process(_delta: float) -> bool:
	if _running.is_empty() or Time.get_ticks_msec() - _started < MOST_MSEC:
		return false
	print("FAILED  %s" % _running)
	print(
		"        It did not end within %d s; the tests after it were not run." % (MOST_MSEC / 1e3)
	)
	_end(_failed + 1)
	return true


func _run() -> void:
	var here: String = (get_script() as Script).resource_path.get_base_dir()
	var prefix: String = "render_" if "--rendering" in OS.get_cmdline_user_args() else "test_"
	for argument: String in OS.get_cmdline_user_args():
		if argument.begins_with("--only="):
			prefix = argument.trim_prefix("--only=")
	var folder: String = OS.get_cache_dir().path_join(
		"treerec_godot_tests_%d" % OS.get_process_id()
	)
	print("shader cache: ", OS.get_environment("MESA_SHADER_CACHE_DIR"))
	OS.add_logger(_errors)
	if "--rendering" in OS.get_cmdline_user_args():
		_keep_shaders()
	for file: String in DirAccess.get_files_at(here):
		if file.begins_with(prefix) and file.get_extension() == "gd":
			await _run_file(here.path_join(file), folder)
	OS.remove_logger(_errors)
	_kept.clear()
	_remove(folder)
	_end(_failed)


# What the engine has compiled of a shader goes with its last material: each test would begin anew.
func _keep_shaders() -> void:
	var shaders: String = "res://addons/tree_reconstruction/shaders"
	for file: String in ResourceLoader.list_directory(shaders):
		if file.get_extension() == "gdshader":
			_kept.append(load(shaders.path_join(file)))


func _end(failed: int) -> void:
	print("%d passed, %d failed" % [_passed, failed])
	quit(1 if failed > 0 or _passed == 0 else 0)


func _run_file(path: String, folder: String) -> void:
	var script: GDScript = load(path) as GDScript
	if script == null or not script.can_instantiate():
		_failed += 1
		print("FAILED: %s does not compile." % path.get_file())
		return
	for method: Dictionary in script.get_script_method_list():
		var name: String = method.name
		if not name.begins_with("test_"):
			continue
		var test: Suite = script.new()
		test.tree = self
		test.folder = folder
		_remove(folder)
		DirAccess.make_dir_recursive_absolute(folder)
		_errors.take()
		_running = "%s: %s" % [path.get_file().get_basename(), name]
		_started = Time.get_ticks_msec()
		await test.call(name)
		_judge(_running, test, _started)
		_running = ""
		# What the test freed goes before the next one starts.
		await process_frame


func _judge(title: String, test: Suite, started: int) -> void:
	var reasons: PackedStringArray = test.failures
	var expected: PackedStringArray = test.expected_errors
	for error: String in _errors.take():
		var known: bool = false
		for part: String in expected:
			known = known or part in error
		if not known:
			reasons.append("The engine reported: " + error)
		else:
			test.seen_errors.append(error)
	for part: String in expected:
		if not test.has_seen(part):
			reasons.append("No error said '%s'." % part)
	var took: int = Time.get_ticks_msec() - started
	if reasons.is_empty():
		_passed += 1
		print("ok      %s%s" % [title, "" if took < 1000 else " (%d ms)" % took])
		return
	_failed += 1
	print("FAILED  %s" % title)
	for reason: String in reasons:
		print("        " + reason)


func _remove(folder: String) -> void:
	if not DirAccess.dir_exists_absolute(folder):
		return
	for inside: String in DirAccess.get_directories_at(folder):
		_remove(folder.path_join(inside))
	for file: String in DirAccess.get_files_at(folder):
		DirAccess.remove_absolute(folder.path_join(file))
	DirAccess.remove_absolute(folder)
