@tool
extends RefCounted
## Hears of the changes of a forest's trees.

var _heard: Array[TreeReconstruction] = []


## Listens to [param trees], which may hold [code]null[/code], and to no others: [param heard] is
## called with the one that has changed.
func listen(trees: Array[TreeReconstruction], heard: Callable) -> void:
	for one: TreeReconstruction in _heard:
		one.changed.disconnect(heard.bind(one))
	_heard = []
	for one: TreeReconstruction in trees:
		if one != null and not _heard.has(one):
			one.changed.connect(heard.bind(one))
			_heard.append(one)
