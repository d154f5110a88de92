#!/usr/bin/env bash
# Runs what was built for Linux on ARM under qemu and compares it with what was built here. ./dev test arm64 calls it,
# with everything built for both. The last line is 'N passed, N failed'.
set -uo pipefail
cd "$(dirname "$0")/../.."
. tests/tools/checks.sh
. tests/platforms/stand_in.sh

work=$PWD/build/arm64
rm -rf "$work"
mkdir -p "$work/here" "$work/there"
arm() { timeout 900 qemu-aarch64-static -L /usr/aarch64-linux-gnu "$@"; }

stand_in_table &&
    aarch64-linux-gnu-g++ -std=c++20 -Wall -Wextra -Werror -O1 -Ibuild/gdextension -I"$work" \
        tests/platforms/stand_in_host.cpp -o "$work/stand_in_host"
check 'the stand-in for the engine is built' [ -x "$work/stand_in_host" ]
for target in editor template_debug template_release; do
    library=project/addons/tree_reconstruction/bin/libtree_reconstruction.linux.$target.arm64.so
    check_library "$target" "$library" arm "$work/stand_in_host"
done

# The same bytes as here.
build/linux.editor.x86_64/digests >"$work/here/digests"
arm build/linux.editor.arm64/digests >"$work/there/digests"
check "digests: $(wc -l <"$work/here/digests") things that a game makes are the same" \
    cmp "$work/here/digests" "$work/there/digests"
diff "$work/here/digests" "$work/there/digests" | head -n 20

both() {
    (cd "$work/here" && ../../../build/linux.editor.x86_64/treerec "$@" --quiet >>log 2>&1)
    (cd "$work/there" && arm ../../../build/linux.editor.arm64/treerec "$@" --quiet >>log 2>&1)
}
both synth -o . --seed 2
both reconstruct scan.ply -o made.glb
both reconstruct scan.ply -o made.txt
both lstring made.txt -o made.lstring
for file in scan.ply made.glb made.txt made.lstring; do
    check "treerec writes the same $file" cmp "$work/here/$file" "$work/there/$file"
done
tail -n 3 "$work/there/log"

finish
