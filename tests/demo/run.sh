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
./dev godot --headless --path project --script "$PWD/tests/demo/check_demo.gd" -- "$PWD/build/demo" 2>&1 |
    grep -E '^(ok|FAILED|SCRIPT ERROR|[0-9]+ passed)'
exit "${PIPESTATUS[0]}"
