#!/usr/bin/env bash
# Runs what was built for Windows under Wine and compares it with what was built here. ./dev test windows calls it,
# with everything built for both. The last line is 'N passed, N failed'.
set -uo pipefail
cd "$(dirname "$0")/../.."
. tests/tools/checks.sh
. tests/platforms/stand_in.sh

work=$PWD/build/windows
rm -rf "$work/here" "$work/there"
mkdir -p "$work/here" "$work/there"
export WINEPREFIX=$work/wine WINEDEBUG=-all
windows() { timeout 500 wine "$@" </dev/null 2>"$work/errors"; }

stand_in_table &&
    x86_64-w64-mingw32-g++-posix -std=c++20 -Wall -Wextra -Werror -O1 -static -Ibuild/gdextension -I"$work" \
        tests/platforms/stand_in_host.cpp -o "$work/stand_in_host.exe"
check 'the stand-in for the engine is built' [ -x "$work/stand_in_host.exe" ]

for target in editor template_debug template_release; do
    library=project/addons/tree_reconstruction/bin/libtree_reconstruction.windows.$target.x86_64.dll
    check_library "$target" "$library" windows "$work/stand_in_host.exe"
    x86_64-w64-mingw32-objdump -p "$library" >"$work/$target.headers"
    # The names of what it exports; newer binutils write their ordinals before them.
    shown=$(sed -nE '/^\[Ordinal\/Name Pointer\] Table/,/^$/s/^\t\[ *[0-9]+\] (\+base\[ *[0-9]+\] +[0-9a-f]+ +)?//p' \
        "$work/$target.headers" | tr '\n' ' ')
    check "$target: shows its entry function alone ($shown)" [ "$shown" = 'tree_reconstruction_library_init ' ]
    check "$target: and nothing without a name" \
        [ "$(grep -cE '\+base\[ *[0-9]+\] +[0-9a-f]+ +Export RVA' "$work/$target.headers")" = 1 ]
    strangers=$(sed -n 's/.*DLL Name: //p' "$work/$target.headers" | grep -viE '^(kernel32|msvcrt|api-ms-win-.*)\.dll$')
    check "$target: needs nothing but Windows ($strangers)" [ -z "$strangers" ]
done

# The unit tests of what must be the same everywhere.
windows build/windows.editor.x86_64/unit_tests.exe --gtest_brief=1 | tr -d '\r' >"$work/unit.log"
check "unit tests: $(grep -aE 'PASSED' "$work/unit.log" | tail -n 1)" grep -q '  PASSED  ' "$work/unit.log"
check 'unit tests: none fails' [ "$(grep -c '  FAILED  ' "$work/unit.log")" = 0 ]
grep -A5 'Failure' "$work/unit.log" | head -n 40

# The same bytes as here.
build/linux.editor.x86_64/digests >"$work/here/digests"
windows build/windows.editor.x86_64/digests.exe | tr -d '\r' >"$work/there/digests"
check "digests: $(wc -l <"$work/here/digests") things that a game makes are the same" \
    cmp "$work/here/digests" "$work/there/digests"
diff "$work/here/digests" "$work/there/digests" | head -n 20

both() {
    (cd "$work/here" && ../../../build/linux.editor.x86_64/treerec "$@" --quiet >>log 2>&1)
    (cd "$work/there" && windows ../../../build/windows.editor.x86_64/treerec.exe "$@" --quiet >>log 2>&1)
}
both synth -o . --seed 2
both reconstruct scan.ply -o made.glb
both reconstruct scan.ply -o made.obj
both reconstruct scan.ply -o made.txt
both reconstruct scan.ply -o flood.ply --skeleton flood
both lstring made.txt -o made.lstring
for file in scan.ply made.glb made.obj made.mtl made.txt flood.ply made.lstring; do
    check "treerec.exe writes the same $file" cmp "$work/here/$file" "$work/there/$file"
done
tail -n 3 "$work/there/log"

finish
