#pragma once

#include <godot_cpp/classes/object.hpp>
#include <godot_cpp/core/property_info.hpp>

namespace godot {

class ObjectDB {
  public:
    // Null when there is no such object any more.
    static Object* get_instance(uint64_t p_object_id) {
        return internal::get_object_instance_binding(internal::api.object_get_instance_from_id(p_object_id));
    }
};

}  // namespace godot
