#include "wind_globals.h"

#include <godot_cpp/classes/project_settings.hpp>
#include <godot_cpp/classes/rendering_server.hpp>
#include <godot_cpp/core/error_macros.hpp>
#include <godot_cpp/variant/string.hpp>
#include <godot_cpp/variant/typed_array.hpp>
#include <godot_cpp/variant/vector2.hpp>
#include <godot_cpp/variant/vector4.hpp>

using namespace godot;

Dictionary get_wind_globals() {
    Dictionary globals;
    globals["tree_wind_strength"] = 0.4;
    globals["tree_wind_direction"] = Vector2(1.0f, 0.35f);
    globals["tree_wind_speed"] = 1.0;
    globals["tree_wind_gustiness"] = 0.8;
    globals["tree_wind_shift"] = 0.0;
    for (int i = 0; i < 4; i++) {
        globals[vformat("tree_push_%d", i)] = Vector4();
    }
    return globals;
}

static RenderingServer::GlobalShaderParameterType type_of(const Variant& p_value) {
    switch (p_value.get_type()) {
        case Variant::VECTOR2:
            return RenderingServer::GLOBAL_VAR_TYPE_VEC2;
        case Variant::VECTOR4:
            return RenderingServer::GLOBAL_VAR_TYPE_VEC4;
        default:
            return RenderingServer::GLOBAL_VAR_TYPE_FLOAT;
    }
}

void add_wind_globals() {
    RenderingServer* server = RenderingServer::get_singleton();
    ERR_FAIL_COND_MSG(server == nullptr, "There is no rendering server yet for the wind's shader globals.");
    const Dictionary globals = get_wind_globals();
    const Array names = globals.keys();
    // The library is loaded again where it was built anew. The server must not be asked for its list in a
    // game.
    static const char* const kAdded = "tree_wind_globals_added";
    if (server->has_meta(kAdded)) {
        return;
    }
    server->set_meta(kAdded, true);
    for (int64_t i = 0; i < names.size(); i++) {
        const String name = names[i];
        if (ProjectSettings::get_singleton()->has_setting("shader_globals/" + name)) {
            continue;
        }
        server->global_shader_parameter_add(name, type_of(globals[name]), globals[name]);
    }
}
