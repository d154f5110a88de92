@tool
extends RefCounted
## Work longer than a frame: on worker threads, with progress and cancel, finished on the main
## thread.

## A job began, went on, or ended.
signal changed


## One piece of work.
class Job:
	extends RefCounted

	## What the user reads.
	var title: String
	## What reports the progress, and is told to cancel, if it is given. Set it before starting.
	var worker: TreeReconstructor
	## 0 to 1.
	var progress: float = 0.0
	## What it is at.
	var stage: String = ""
	## The user has asked for its end. Work without a [member worker] looks at this.
	var cancelled: bool = false
	## Whether [member progress] says how far it is.
	var measured: bool = false

	var _work: Callable
	var _done: Callable
	var _task: int = -1
	var _result: Variant

	func _run() -> void:
		_result = _work.call(self)


var _jobs: Array[Job] = []


## Runs [param work], a function of its [Job], on a thread, and then, on the main thread, [param
## done] with what it returned and the job, unless it was cancelled.
func start(title: String, work: Callable, done: Callable, worker: TreeReconstructor = null) -> Job:
	var job: Job = Job.new()
	job.title = title
	job.worker = worker
	job.measured = worker != null
	job._work = work
	job._done = done
	_jobs.append(job)
	job._task = WorkerThreadPool.add_task(job._run, false, title)
	changed.emit()
	return job


## Shows work that goes on by itself on the main thread, for whoever does it: it sets the job's
## [member Job.progress] and [member Job.stage], looks at [member Job.cancelled], and ends with
## [method finish].
func begin(title: String) -> Job:
	var job: Job = Job.new()
	job.title = title
	job.measured = true
	_jobs.append(job)
	changed.emit()
	return job


## Ends what [method begin] began.
func finish(job: Job) -> void:
	_jobs.erase(job)
	changed.emit()


## The jobs at work, the oldest first.
func get_running() -> Array[Job]:
	return _jobs.duplicate()


## Asks a job to end soon. Its result is thrown away.
func cancel(job: Job) -> void:
	job.cancelled = true
	if job.worker != null and job in _jobs:
		job.worker.cancel()
	changed.emit()


## To be called once a frame.
func update() -> void:
	if _jobs.is_empty():
		return
	for job: Job in _jobs.duplicate():
		if job._task < 0:
			continue
		if WorkerThreadPool.is_task_completed(job._task):
			WorkerThreadPool.wait_for_task_completion(job._task)
			_jobs.erase(job)
			if not job.cancelled and job._done.is_valid():
				job._done.call(job._result, job)
		elif job.worker != null:
			job.progress = job.worker.get_progress()
			job.stage = job.worker.get_stage()
	changed.emit()


## Cancels all and waits for their ends, so that no thread runs on after the plugin.
func shut_down() -> void:
	for job: Job in _jobs:
		cancel(job)
	for job: Job in _jobs:
		if job._task >= 0:
			# A worker that asks the renderer for something waits until this thread looks.
			while not WorkerThreadPool.is_task_completed(job._task):
				RenderingServer.force_sync()
				OS.delay_msec(1)
			WorkerThreadPool.wait_for_task_completion(job._task)
	_jobs.clear()
	changed.emit()
