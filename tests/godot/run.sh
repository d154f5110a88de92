#!/usr/bin/env bash
# Runs the engine's tests without a screen: those that need no picture, what collides with the engine's other physics,
# and the renderers that work here, as many at once as there are cores. ./dev test godot calls it, with GODOT set and
# project/ built and imported. The last line is 'N passed, N failed'.
set -uo pipefail
cd "$(dirname "$0")/../.."
. tests/tools/screen.sh
. tests/tools/own_cache.sh
# Mesa's shaders on the processor: to optimize them takes longer than to draw these few pictures with them as they are.
export GALLIVM_PERF=nopt
passed=0
failed=0
screen=
jolt=build/jolt_project # which physics it is, the engine reads when it starts: a project of its own
logs=$(mktemp -d) # what each run says, by its title
export logs
cleanup() {
    [ -z "$screen" ] || kill "$screen" 2>/dev/null
    rm -rf "$logs" "$jolt"
}
trap cleanup EXIT

# run TITLE ARGUMENTS…: one run of the engine, on $project. Its own log is not the project's, of which there is one.
run() {
    local title=$1
    shift
    own_cache timeout 1200 "$GODOT" --path "${project:-project}" --log-file "$logs/$title.engine" --script "$PWD/tests/godot/run.gd" "$@" \
        >"$logs/$title" 2>&1
}
# render TITLE DRIVER METHOD: the tests look into viewports of their own; the window costs less the smaller it is.
render() {
    run "$1" --rendering-driver "$2" --rendering-method "$3" --resolution 160x120 --audio-driver Dummy -- --rendering
}
export -f run render own_cache

# count TITLE: adds up that run and looks for what the engine says when it ends.
count() {
    local log=$logs/$1 last
    echo "-- $1"
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

# What collides, with the engine's other physics.
rm -rf "$jolt"
cp -r project "$jolt"
printf '[physics]\n\n3d/physics_engine="Jolt Physics"\n' >"$jolt/override.cfg"

start_screen 1280x720 "$logs/screen" || cat "$logs/screen"
titles=(headless Jolt gl_compatibility forward_plus)
# Its shaders and buffers are nearly those of Forward+.
[ -z "${TREEREC_LONG:-}" ] || titles+=(mobile)
xargs -P "$(nproc)" -I{} bash -c '{} || true' <<END
render forward_plus vulkan forward_plus
${TREEREC_LONG:+render mobile vulkan mobile}
run headless --headless
render gl_compatibility opengl3 gl_compatibility
project=$jolt run Jolt --headless -- --only=test_collision
END
for title in "${titles[@]}"; do
    case $title in
    mobile | forward_plus)
        grep -q '^Vulkan ' "$logs/$title" || {
            echo "-- $title: skipped, no Vulkan driver here."
            continue
        }
        ;;
    esac
    count "$title"
done
# As many caches as runs, and the user's own is none of them.
caches=$(sed -n 's/^shader cache: \(..*\)/\1/p' "$logs"/*.engine | sort -u | grep -cvxF "${MESA_SHADER_CACHE_DIR:-none}")
if [ "$caches" = "$(grep -l '^shader cache:' "$logs"/*.engine | wc -l)" ]; then
    passed=$((passed + 1))
    echo "ok      each run had a shader cache of its own"
else
    failed=$((failed + 1))
    echo "FAILED  only $caches runs had a shader cache of their own"
fi
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
