# For whatever starts the engine in a window: a shader cache of its own for each run.
#
# own_cache COMMAND…: runs it with a cache of Mesa's that nobody else has, and takes that away afterwards. An engine
# that is killed leaves its cache truncated, and the next one that reads it dies of SIGBUS.
own_cache() {
    local folder status=0
    folder=$(mktemp -d)
    MESA_SHADER_CACHE_DIR=$folder "$@" || status=$?
    rm -rf "$folder"
    return "$status"
}
