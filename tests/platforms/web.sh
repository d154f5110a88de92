#!/usr/bin/env bash
# Runs what was built for the web in Node.js, without the engine. ./dev test web calls it, with both templates built
# for exports without threads, and one for those with. The last line is 'N passed, N failed'.
set -uo pipefail
cd "$(dirname "$0")/../.."
. tests/tools/checks.sh
. tests/platforms/stand_in.sh

work=$PWD/build/web
rm -rf "$work"
mkdir -p "$work"
# As the engine's web templates with extensions, which have no exceptions; Debian's emscripten knows no fetch in Node.js.
main=(em++ -std=c++20 -Wall -Wextra -Werror -O1 -sMAIN_MODULE=1 -sSUPPORT_LONGJMP=wasm -sWASM_BIGINT
    -sALLOW_MEMORY_GROWTH -sNODERAWFS)
web() {
    local fetch=--no-experimental-fetch
    node $fetch -e 0 2>/dev/null || fetch=
    timeout 300 node $fetch "$@"
}

stand_in_table && "${main[@]}" -Ibuild/gdextension -I"$work" tests/platforms/stand_in_host.cpp -o "$work/stand_in_host.js"
check 'the stand-in for the engine is built' [ -s "$work/stand_in_host.js" ]
bin=project/addons/tree_reconstruction/bin
for target in template_debug template_release; do
    check_library "$target" "$PWD/$bin/libtree_reconstruction.web.$target.nothreads.wasm32.wasm" web "$work/stand_in_host.js"
done
# The stand-in has no threads, so what has them is only looked at.
threaded=$bin/libtree_reconstruction.web.template_release.threads.wasm32.wasm
shows='const m = new WebAssembly.Module(require("fs").readFileSync(process.argv[1]));
const names = WebAssembly.Module.exports(m).map((e) => e.name);
const memory = WebAssembly.Module.imports(m).some((i) => i.kind === "memory");
process.exit(memory && names.includes("tree_reconstruction_library_init") ? 0 : 1);'
check 'threads: is a module with its entry function, in the memory of another' web -e "$shows" "$threaded"

# What scons links to throw with.
pic=$(em-config CACHE)/sysroot/lib/wasm32-emscripten/pic
runtime_of=("$pic"/libc++abi-*except.a "$pic"/libunwind-*except.a)
throwing=()
for library in "${runtime_of[@]}"; do
    case $library in *noexcept.a | *-mt-*) ;; *) throwing+=("$library") ;; esac
done
"${main[@]}" tests/platforms/web_catches.cpp -o "$work/catches.js"
em++ -std=c++20 -O1 -fPIC -fwasm-exceptions -sSUPPORT_LONGJMP=wasm -sSIDE_MODULE=2 -sWASM_BIGINT \
    -sEXPORTED_FUNCTIONS=_web_throws tests/platforms/web_throws.cpp \
    build/gdextension/web.template_release.nothreads.wasm32/web_exceptions.o "${throwing[@]}" -o "$work/throws.wasm"
check 'a module may throw and catch in a program without exceptions' \
    [ "$(web "$work/catches.js" "$work/throws.wasm")" = caught ]

finish
