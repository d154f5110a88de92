@tool
extends RefCounted
## What the library says of sketches and of their files: patterns as those of sentences.gd.

const PATTERNS: PackedStringArray = [
	(
		"At %s of %s places the species' twigs are too long for the crown: make the tree taller,"
		+ " or take the true depth."
	),
	# Of strokes.
	"This is only a dot; draw a line.",
	"A trunk has one line, or two for its sides; this is a further one.",
	"A tree has one trunk; this line does not stand beside the other one.",
	"This lies within the crown's outline and changes nothing of it.",
	"A tree has one crown, and this is a second outline; let it cross the first one.",
	"This is a small ring, as of an apple, a hole or a sun; it changes nothing of the tree.",
	"This outline encloses nothing; draw it around the crown.",
	"This outline crosses itself or runs to and fro; the line around all of it was taken.",
	"This looks like the ground and not like a branch.",
	"This grows from a branch of a branch; only branches of the trunk may have branches.",
	"This is short and begins far from the trunk; draw it from the trunk on.",
	"This branch begins far from the trunk; it was joined to it.",
	"This goes right through the trunk; it became two branches.",
	"This branch leaves the crown; it stays as it was drawn.",
	"The trunk leaves the crown; it stays as it was drawn.",
	# Of the whole sketch.
	"The trunk ends below the crown; it was extended into it.",
	"Trunk and crown were drawn in one stroke.",
	"No trunk was drawn; a straight one was made.",
	"No outline of the crown was drawn; one was made around the branches.",
	(
		"There are %s branches, too many to be turned 10 degrees apart within 60 degrees to either"
		+ " side; they stand closer together."
	),
	# Why no tree is made of it.
	(
		"Nothing is drawn yet. Draw a trunk from the ground up, some branches and the outline of the"
		+ " crown."
	),
	(
		"There are only dots in the drawing. Draw lines: a trunk from the ground up, some branches"
		+ " and the outline of the crown."
	),
	(
		"Nothing in the drawing looks like a trunk or like a crown's outline. Draw a trunk from the"
		+ " ground up, or the outline of the crown."
	),
	"The crown's outline encloses nothing; draw it around the crown.",
	"Nothing is drawn above the trunk's base; draw the tree from the ground up.",
	"The density of twigs must be from 0 to 4.",
	"The trunk's radius must be from 0 to a fifth of the tree's height.",
	"There are no twigs of %s for a sketch; use one of: %s.",
	# Of twigs of one's own.
	"The library has no twigs: keep some branches in it first.",
	"The library has %s twigs; a sketch takes at most %s.",
	"Twig %s of the library is no branch for a sketch. %s",
	"Twig %s of the library is %s m long; a sketch takes twigs from 0.01 to 20 m.",
	(
		"Twig %s of the library is too thick for its length: its radius is more than a quarter of"
		+ " it."
	),
	"There is no tree to take twigs of.",
	"The tree has no side branches to take twigs of.",
	"None of the tree's side branches is a twig for a sketch: they are too crooked or too large.",
	"This has no twigs: give a TwigLibrary or a TreeReconstruction.",
	"The sketch's own twigs",
	"%s: its twigs",
	"%s are larger than 16 MiB, which none of a sketch are.",
	"%s cannot be read as JSON.",
	"%s have no list of 'twigs'.",
	"%s have one that is no text.",
	"%s have a 'title' that is no text.",
	"%s have an 'arrangement' that is none of alternate, opposite and clustered.",
	"%s have 'angles' that are no list.",
	"%s have 'angles' that are not from 0 to 180 degrees, in ascending order.",
	"%s have a 'taper' that is no {...}.",
	"%s have a taper whose '%s' is not eleven numbers.",
	"%s have a taper whose '%s' does not fall from 1 to 0.",
	"%s have a '%s' that is no number.",
	"%s have a '%s' that is out of range, or none.",
	"%s has a 'trunk_radius' that is not from 0 to 40 m.",
	"%s has a 'density' that is not from 0 to 4.",
	"%s has a '%s' that is neither '%s' nor '%s'.",
	(
		"This build was made without CGAL and has no alpha shapes; let sections bound the crown"
		+ " instead."
	),
	"The sketch",
	"%s has a canvas whose sides are not from 0.001 to 1000000 pixels.",
	"%s has a canvas that is more than 100 times as long one way as the other.",
	"%s has a tree whose height is not from 0 to 200 metres.",
	"%s has %s strokes; at most %s make a tree.",
	"%s has strokes of %s points; at most %s are read. Draw with fewer, or thin them.",
	"%s has a stroke, number %s, that has no points.",
	"%s has a stroke, number %s, that has a point whose place is no number.",
	(
		"%s has a stroke, number %s, that has a point that lies more than 100 canvases away from the"
		+ " canvas."
	),
	(
		"%s has a stroke, number %s, that has %s pressures for %s points; it needs one for each, or"
		+ " none."
	),
	"%s has a stroke, number %s, that has a pressure that is not from 0 to 1.",
	# Of files with strokes.
	"%s is larger than 16 MiB, which no sketch is.",
	"%s cannot be read as JSON: something is wrong or missing in line %s, at its byte %s.",
	"%s has a number that is too large.",
	"%s is JSON, but no sketch: it has lists in lists in lists.",
	'%s is JSON, but no sketch: it does not begin with {"format": "treerec sketch".',
	"%s is no sketch: its format is %s, and not 'treerec sketch'.",
	"%s does not tell the version of its format, a whole number from 1 on.",
	(
		"%s was written by a newer version of this program (its format is version %s, and version %s"
		+ " is read here); update to open it."
	),
	"%s has a 'canvas' that is not [width, height] in pixels.",
	"%s has a 'species' that is no text.",
	"%s has a 'seed' that is no whole number from 0 on.",
	"%s has no list of 'strokes'.",
	"%s has a '%s' that is no number.",
	'%s has a stroke, number %s, that is no {"points": ...}.',
	"%s has a stroke, number %s, whose point %s is not [x, y], two numbers.",
	"%s has a stroke, number %s, whose 'pressure' is no list.",
	"%s has a stroke, number %s, that has a pressure that is no number.",
	"%s has a stroke, number %s, whose 'role' is no text.",
	(
		"%s has a stroke, number %s, whose role is unknown. A stroke's role is auto, outline, trunk"
		+ " or branch, and not %s."
	),
	"%s has a stroke, number %s, whose 'id' is no whole number from 0 to 4294967295.",
	"%s is larger than 64 MiB; a tree is drawn with a few strokes.",
	"%s is no SVG drawing: it begins with <%s>, and not with <svg>.",
	"%s is no SVG drawing: it has no <svg>.",
	"%s has groups in groups, more than 1000 deep.",
	"%s ends too early: its <%s> does not end.",
	"%s shows no lines: no path, line, polyline, polygon, circle or ellipse.",
	"%s has a transform that cannot be read: %s.",
	"%s has a viewBox that is not four numbers: %s.",
	"%s has an element <%s> whose %s is no length: %s.",
	"%s has a path that cannot be read from its character %s on: %s.",
	"%s has a <%s> whose points are not pairs of numbers: %s.",
	"%s has more than %s lines; a tree is drawn with a few strokes.",
	"%s has lines of more than %s points; a tree is drawn with a few strokes.",
	"%s is damaged: %s (line %s).",
	"a comment does not end",
	"a CDATA section does not end",
	"a processing instruction does not end",
	"its document type does not end",
	"it ends in the middle of an element",
	"it ends in the middle of an attribute",
	"an attribute has no quotes",
	"an element's attributes cannot be told apart",
	"an element has more than 1000 attributes",
	# Of drawings.
	"%s is a picture of a kind that can't be read here; save it as PNG or SVG.",
	"%s is compressed; save it as plain SVG, not as SVGZ.",
	"%s is text in UTF-16; save it as UTF-8.",
	"%s is no sketch: neither a sketch's JSON, nor an SVG drawing, nor a PNG or JPEG picture.",
	"%s has %s x %s pixels; save it with at most 100 million, 2000 a side are plenty.",
	"%s is a picture that is damaged, or of a kind that can't be read here; save it as PNG.",
	"%s has filled areas; draw the crown's outline, the trunk and the branches as lines.",
	"%s shows no lines, only specks.",
	"%s shows %s lines; a tree is drawn with a few. Draw a few dark lines on light paper.",
	"%s shows more lines than a drawing of a tree has. Draw a few dark lines on light paper.",
	"%s shows no drawing: all of it has nearly one color. Draw dark lines on light paper.",
	(
		"%s is no drawing of lines: too much of it differs from its paper. Draw dark lines on light"
		+ " paper."
	),
	# Of any file that is read.
	"'%s' is a folder; name a file in it.",
	"'%s' is not a regular file.",
	"'%s' cannot be opened; check that you may read it.",
	"'%s' could not be read to its end; check the disk it is on.",
	"'%s' is too large for this machine's memory (%s MiB); thin it first.",
]
