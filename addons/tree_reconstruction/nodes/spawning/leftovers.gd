@tool
extends RefCounted
## What worker threads still do for forests that no longer want it. To wait for it would hold a
## frame up.

# With what they work on.
static var _tasks: Dictionary[int, Variant] = {}


## Leaves a task alone that has been told to end, and keeps what it works on till then.
static func leave(task: int, object: Variant) -> void:
	_tasks[task] = object


## Frees what [param held] alone holds, on a worker where [param threaded] says that there are any.
static func drop(held: Array, threaded: bool) -> void:
	if threaded:
		leave(WorkerThreadPool.add_task(held.clear, false, "Free what was of a forest"), held)
	else:
		held.clear()


## Lets go of what has ended. To be called now and then.
static func tidy() -> void:
	for task: int in _tasks.keys():
		if WorkerThreadPool.is_task_completed(task):
			WorkerThreadPool.wait_for_task_completion(task)
			_tasks.erase(task)


## Waits for all of it.
static func wait() -> void:
	for task: int in _tasks.keys():
		WorkerThreadPool.wait_for_task_completion(task)
		_tasks.erase(task)
