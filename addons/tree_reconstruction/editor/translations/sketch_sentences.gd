@tool
extends RefCounted
## What the library says of sketches: patterns as those of sentences.gd.

const PATTERNS: PackedStringArray = [
	"The crown's outline encloses nothing.",
	"Nothing of the drawing stands above the trunk's foot.",
	"The density of twigs must be within 0 and 4.",
	"The trunk's radius must be within 0 and a fifth of the tree's height.",
	(
		"There are %s branches: they can't be turned at least 10 degrees apart within 60 to either"
		+ " side, and stand closer."
	),
]
