@tool
extends Logger
## Keeps the errors that the engine reports, or the warnings, until they are taken. The editor's
## tests use it, too.

## Warnings instead of errors, by their sentences alone.
var of_warnings: bool = false

var _mutex: Mutex = Mutex.new()
var _errors: PackedStringArray = []


func _log_error(
	function: String,
	file: String,
	line: int,
	code: String,
	rationale: String,
	_editor_notify: bool,
	error_type: int,
	_backtraces: Array[ScriptBacktrace]
) -> void:
	if (error_type == ERROR_TYPE_WARNING) != of_warnings:
		return
	_mutex.lock()
	var text: String = rationale if not rationale.is_empty() else code
	_errors.append(text if of_warnings else "%s (%s, %s:%d)" % [text, function, file, line])
	_mutex.unlock()


## All errors since the last call.
func take() -> PackedStringArray:
	_mutex.lock()
	var taken: PackedStringArray = _errors
	_errors = []
	_mutex.unlock()
	return taken
