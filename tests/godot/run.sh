#!/usr/bin/env bash
# Runs the engine's tests without a screen: first those that need no picture, then the renderers that work
# here. ./dev test godot calls it, with GODOT set and project/ built and imported. The last line is
# 'N passed, N failed'.
set -uo pipefail
cd "$(dirname "$0")/../.."
passed=0
failed=0
log=$(mktemp)
trap 'rm -f "$log"' EXIT

# count TITLE: adds up the run in $log and looks for what the engine says when it ends.
count() {
    local last
    last=$(grep -E '^[0-9]+ passed, [0-9]+ failed$' "$log" | tail -n 1)
    if [ -z "$last" ]; then
        tail -n 40 "$log"
        echo "FAILED  $1: the tests did not end"
        failed=$((failed + 1))
        return
    fi
    grep -E '^(ok|FAILED|        )' "$log"
    passed=$((passed + ${last%% *}))
    last=${last#*, }
    failed=$((failed + ${last%% *}))
    if grep -E 'ObjectDB instances (were )?leaked|resources still in use|were leaked at exit|Leaked instance:' "$log"; then
        echo "FAILED  $1: something leaked"
        failed=$((failed + 1))
    else
        passed=$((passed + 1))
        echo "ok      $1: nothing leaked"
    fi
}

echo "-- headless"
timeout 900 "$GODOT" --headless --path project --script "$PWD/tests/godot/run.gd" >"$log" 2>&1
count headless

# What collides, with the engine's other physics. The setting is read when the engine starts.
echo "-- headless, Jolt"
override=project/override.cfg
trap 'rm -f "$log" "$override"' EXIT
printf '[physics]\n\n3d/physics_engine="Jolt Physics"\n' >"$override"
timeout 200 "$GODOT" --headless --path project --script "$PWD/tests/godot/run.gd" -- --only=test_collision >"$log" 2>&1
rm -f "$override"
count Jolt

for renderer in "opengl3 gl_compatibility" "vulkan mobile" "vulkan forward_plus"; do
    read -r driver method <<<"$renderer"
    echo "-- $method"
    timeout 900 xvfb-run -a -s '-screen 0 1280x720x24' "$GODOT" --path project --rendering-driver "$driver" \
        --rendering-method "$method" --audio-driver Dummy --script "$PWD/tests/godot/run.gd" -- --rendering >"$log" 2>&1
    if [ "$driver" = vulkan ] && ! grep -q '^Vulkan ' "$log"; then
        echo "Skipped: no Vulkan driver here."
        continue
    fi
    count "$method"
done
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
