#!/usr/bin/env bash
# Unpacks the zip of the demo project and opens it in the engine, as somebody who has nothing else: no build, no import
# but that of the editor when it opens it. ./dev test package calls it with GODOT set and the zips' paths. The last line is
# 'N passed, N failed'.
set -uo pipefail
cd "$(dirname "$0")/../.."
zip=$2
. tests/tools/checks.sh

work=$PWD/build/package/demo
rm -rf "$work"
mkdir -p "$work"
python3 -m zipfile -e "$zip" "$work"
project=$work/tree_reconstruction-demo
check 'everything lies in one folder' [ "$(ls "$work")" = tree_reconstruction-demo ]
for name in project.godot README.md LICENSE demo/result/tree.tscn addons/tree_reconstruction/LICENSE.GPL; do
    check "$name is there" [ -s "$project/$name" ]
done
! grep -rlE "$(printf '%s' "$PWD" | sed 's/[.]/\\./g')|/home/|/root/" "$project" --include='*.gd' --include='*.tscn' \
    --include='*.import' --include='*.godot' --include='*.cfg' --include='*.res'
check 'nothing in it names this machine' [ $? = 0 ]
log=$work/log
engine() { timeout 500 "$GODOT" --headless --path "$project" "$@" >"$log" 2>&1; }
# What the editor does when it opens the project, once.
engine --import
! grep -E '^(SCRIPT )?ERROR|Parse Error' "$log"
check 'the editor opens it without errors' [ $? = 0 ]
engine --script "$PWD/tests/package/demo.gd"
for scene in start one_tree scan_and_tree forest felling; do
    check "the scene $scene shows trees" grep -q "^$scene shows trees$" "$log"
done
check 'the tree has its scan' grep -q '^the tree has its scan$' "$log"
! grep -E '^(SCRIPT )?ERROR|Parse Error' "$log"
check 'without errors' [ $? = 0 ]
# A scene from the project's folder, as F5 plays it.
engine --quit-after 30
! grep -E '^(SCRIPT )?ERROR|Parse Error' "$log"
check 'F5 plays it without errors' [ $? = 0 ]
rm -rf "$work"
finish
