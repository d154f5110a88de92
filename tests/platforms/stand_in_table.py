#!/usr/bin/env python3
"""Prints, as C++ rows, each function that the engine offers to extensions: its name and one of its type that does nothing.

    stand_in_table.py build/gdextension/gdextension_interface.h > stand_in_table.inc
"""
import re
import sys

with open(sys.argv[1], encoding="utf-8") as header:
    text = header.read()
rows = []
for name, rest in re.findall(r"@name (\w+)(.*?\));", text, re.DOTALL):
    found = re.search(r"typedef [\w ]+?\*? ?\(\*(GDExtension\w+)\)\([^)]*\)$", rest.split("*/", 1)[1].strip())
    if not found:
        sys.exit("stand_in_table.py: the type of %s isn't understood" % name)
    rows.append('    {"%s", function<%s>(Stub<%s>::give)},' % (name, found.group(1), found.group(1)))
if len(rows) < 150 or len(rows) != text.count("@name"):
    sys.exit("stand_in_table.py: %d functions were found of %d" % (len(rows), text.count("@name")))
print("\n".join(rows))
