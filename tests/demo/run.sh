#!/usr/bin/env bash
# Runs ./dev demo on the bundled sample and checks everything that it leaves in build/demo. The last line is
# 'N passed, N failed'.
set -uo pipefail
cd "$(dirname "$0")/../.."
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! ./dev demo >"$log" 2>&1; then
    tail -n 30 "$log"
    echo "FAILED  ./dev demo"
    echo "0 passed, 1 failed"
    exit 1
fi
if ! tail -n 1 "$log" | grep -q build/demo; then
    echo "FAILED  the last line does not say where to look: $(tail -n 1 "$log")"
    echo "0 passed, 1 failed"
    exit 1
fi
./dev godot --headless --path project --script "$PWD/tests/demo/check_demo.gd" -- "$PWD/build/demo" >"$log" 2>&1
grep -E '^(ok|FAILED|SCRIPT ERROR)' "$log"
counts=$(grep -E '^[0-9]+ passed, [0-9]+ failed$' "$log" | tail -n 1)
counts=${counts:-0 passed, 1 failed}
passed=${counts%% *}
failed=${counts#*, }
failed=${failed%% *}

# What other programs will read: a binary and a text model with leaves, one without, and a bare stem.
scan=build/sample/scan.ply
bin/treerec reconstruct "$scan" -o build/demo_check.gltf --leaves maple --levels 4 --quiet &&
    bin/treerec reconstruct "$scan" -o build/demo_check_bare.glb --leaves none --quiet &&
    node tests/tools/validate_gltf.mjs build/demo/tree.glb build/demo_check.gltf build/demo_check_bare.glb
if [ $? = 0 ]; then
    echo "ok      Khronos' validator finds nothing"
    passed=$((passed + 1))
else
    echo "FAILED  Khronos' validator"
    failed=$((failed + 1))
fi
rm -rf build/demo_check*
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
