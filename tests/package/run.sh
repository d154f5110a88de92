#!/usr/bin/env bash
# Unpacks the zip that users get into an empty project and opens that in the engine. ./dev test package calls it with
# GODOT set and the zips' paths. The last line is 'N passed, N failed'.
set -uo pipefail
cd "$(dirname "$0")/../.."
zip=$1
. tests/tools/checks.sh

work=$PWD/build/package/project
rm -rf "$work"
mkdir -p "$work"
python3 -m zipfile -e "$zip" "$work"
check 'everything lies in addons/tree_reconstruction' \
    [ "$(ls "$work") $(ls "$work/addons")" = 'addons tree_reconstruction' ]
addon=$work/addons/tree_reconstruction
for name in LICENSE LICENSE.GPL README.md plugin.cfg tree_reconstruction.gdextension; do
    check "$name is there" [ -s "$addon/$name" ]
done
named=$(sed -n 's/^[a-z]*\..*"\(bin\/.*\)"$/\1/p' "$addon/tree_reconstruction.gdextension" | sort)
there=$(cd "$addon" && ls bin/* | sort)
check 'the manifest names the libraries that are there' [ "$named" = "$there" ]
! grep -rlE "$(printf '%s' "$PWD" | sed 's/[.]/\\./g')|/home/|/root/|res://demo" "$addon" --include='*.gd' --include='*.tres' \
    --include='*.import' --include='*.gdextension' --include='*.gdshader*' --include='*.cfg'
check 'no text in it names this machine or the demo project' [ $? = 0 ]
for library in "$addon"/bin/*template*; do
    carries=0
    tests/platforms/carries_editor.sh "$library" || carries=$?
    check "$(basename "$library") carries nothing of the reconstruction" [ "$carries" = 1 ]
done
for library in "$addon"/bin/*.editor.*; do
    check "$(basename "$library") carries it" tests/platforms/carries_editor.sh "$library"
done

cat >"$work/project.godot" <<'END'
config_version=5

[application]

config/name="Empty"
config/features=PackedStringArray("4.6")

[editor_plugins]

enabled=PackedStringArray("res://addons/tree_reconstruction/plugin.cfg")
END
cp tests/package/plant.gd "$work/"
log=$work/../log
engine() { timeout 300 "$GODOT" --headless --path "$work" "$@" >"$log" 2>&1; }
# The first import only finds the extension.
engine --import
engine --import
! grep -E '^(SCRIPT )?ERROR|Parse Error' "$log"
check 'the engine imports it without errors' [ $? = 0 ]
engine --script res://plant.gd
check 'a script of the project plants a tree and bakes it' grep -q '^planted$' "$log"
! grep -E '^(SCRIPT )?ERROR|Parse Error' "$log"
check 'without errors' [ $? = 0 ]
# What has been baked needs no addon.
rm -rf "$addon" "$work/.godot" "$work/plant.gd"
sed -i '/editor_plugins/,$d' "$work/project.godot"
cp tests/package/visit.gd "$work/"
engine --import
engine --script res://visit.gd
check 'the baked tree opens where there is no addon' grep -q '^visited$' "$log"
! grep -E '^(SCRIPT )?ERROR|Parse Error' "$log"
check 'without errors there' [ $? = 0 ]
finish
