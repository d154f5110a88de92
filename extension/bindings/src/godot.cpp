#include <godot_cpp/classes/engine_classes.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/godot.hpp>

#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <unordered_set>

namespace godot {

namespace internal {

Interface api;

namespace {

GDExtensionBinding::Callback initializer = nullptr;
GDExtensionBinding::Callback terminator = nullptr;
GDExtensionMainLoopStartupCallback startup = nullptr;
GDExtensionInitializationLevel minimum_level = GDEXTENSION_INITIALIZATION_CORE;

// What must be released while the engine is still there. The names stay where they are, and get their text
// back if the library is initialized again without having been unloaded.
std::mutex cache_mutex;
std::unordered_map<std::string, std::unique_ptr<StringName>> interned_names;
std::unordered_set<void*> singletons;

// See Wrapped::announce().
struct Construction {
    const StringName* extension_class = nullptr;
    const GDExtensionInstanceBindingCallbacks* callbacks = nullptr;
    void* recreated_owner = nullptr;
};
thread_local Construction next_construction;

// The callbacks of the most derived listed class that the object is of.
const GDExtensionInstanceBindingCallbacks* find_binding(void* p_owner) {
    for (const EngineClass& candidate : engine_classes) {
        // Classes of the editor have no tag in exported games.
        void* tag = api.classdb_get_class_tag(candidate.get_name()._native_ptr());
        if (tag != nullptr && api.object_cast_to(p_owner, tag) != nullptr) {
            return candidate.callbacks;
        }
    }
    return &EngineBinding<Object>::callbacks;
}

}  // namespace

const char* Interface::load(GDExtensionInterfaceGetProcAddress p_get_proc_address,
                            GDExtensionClassLibraryPtr p_library) {
    library = p_library;
#define GODOT_LOAD_FUNCTION(m_name, m_type)                                               \
    m_name = reinterpret_cast<GDExtensionInterface##m_type>(p_get_proc_address(#m_name)); \
    if (m_name == nullptr) {                                                              \
        return #m_name;                                                                   \
    }
    GODOT_INTERFACE_FUNCTIONS(GODOT_LOAD_FUNCTION)
#undef GODOT_LOAD_FUNCTION
    return nullptr;
}

const StringName& intern(const char* p_name) {
    const std::lock_guard lock(cache_mutex);
    std::unique_ptr<StringName>& name = interned_names[p_name];
    if (name == nullptr) {
        name = std::make_unique<StringName>(p_name);
    }
    return *name;
}

Object* get_object_instance_binding(void* p_owner) {
    if (p_owner == nullptr) {
        return nullptr;
    }
    void* binding = api.object_get_instance_binding(p_owner, api.library, nullptr);
    if (binding == nullptr) {
        binding = api.object_get_instance_binding(p_owner, api.library, find_binding(p_owner));
    }
    return static_cast<Object*>(static_cast<Wrapped*>(binding));
}

Object* get_singleton(const StringName& p_name) {
    void* owner = api.global_get_singleton(p_name._native_ptr());
    if (owner == nullptr) {
        return nullptr;
    }
    Object* singleton = get_object_instance_binding(owner);  // Not under the lock, which intern() takes too.
    const std::lock_guard lock(cache_mutex);
    singletons.insert(owner);
    return singleton;
}

}  // namespace internal

using internal::api;

void Wrapped::announce(const StringName* p_extension_class,
                       const GDExtensionInstanceBindingCallbacks* p_callbacks, void* p_recreated_owner) {
    internal::next_construction = {p_extension_class, p_callbacks, p_recreated_owner};
}

Wrapped::Wrapped(const char* p_engine_class) {
    // Taken at once: the constructors that follow may make further objects.
    const internal::Construction construction = std::exchange(internal::next_construction, {});
    if (construction.recreated_owner != nullptr) {
        _owner = construction.recreated_owner;
    } else {
        _owner = api.classdb_construct_object2(internal::intern(p_engine_class)._native_ptr());
    }
    if (construction.extension_class != nullptr) {
        api.object_set_instance(_owner, construction.extension_class->_native_ptr(), this);
    }
    if (construction.callbacks == nullptr) {
        ERR_PRINT(vformat("A %s was made without memnew() or Ref::instantiate().", p_engine_class));
        return;
    }
    api.object_set_instance_binding(_owner, api.library, this, construction.callbacks);
}

void Wrapped::_post_initialize() {
    static_cast<Object*>(this)->notification(Object::NOTIFICATION_POSTINITIALIZE);
}

PropertyInfo::PropertyInfo(const GDExtensionPropertyInfo* p_info)
    : type(Variant::Type(p_info->type)),
      name(*static_cast<const StringName*>(p_info->name)),
      class_name(*static_cast<const StringName*>(p_info->class_name)),
      hint(p_info->hint),
      hint_string(*static_cast<const String*>(p_info->hint_string)),
      usage(p_info->usage) {}

GDExtensionPropertyInfo PropertyInfo::_to_gdextension() const {
    // The C interface lacks const, but the engine only reads.
    return {GDExtensionVariantType(type),
            const_cast<void*>(name._native_ptr()),
            const_cast<void*>(class_name._native_ptr()),
            hint,
            const_cast<void*>(hint_string._native_ptr()),
            usage};
}

void PropertyInfo::_update(GDExtensionPropertyInfo* p_info) const {
    p_info->type = GDExtensionVariantType(type);
    *static_cast<StringName*>(p_info->name) = name;
    *static_cast<StringName*>(p_info->class_name) = class_name;
    p_info->hint = hint;
    *static_cast<String*>(p_info->hint_string) = hint_string;
    p_info->usage = usage;
}

void GDExtensionBinding::initialize_level(void*, GDExtensionInitializationLevel p_level) {
    ClassDB::current_level = p_level;
    if (p_level == internal::minimum_level) {
        for (auto& [text, name] : internal::interned_names) {
            *name = StringName(text.c_str());
        }
    }
    if (internal::initializer != nullptr) {
        internal::initializer(ModuleInitializationLevel(p_level));
    }
}

void GDExtensionBinding::deinitialize_level(void*, GDExtensionInitializationLevel p_level) {
    if (internal::terminator != nullptr) {
        internal::terminator(ModuleInitializationLevel(p_level));
    }
    ClassDB::unregister_level(p_level);
    if (p_level != internal::minimum_level) {
        return;
    }
    // Singletons outlive this library, and would call into it when they are freed.
    for (void* singleton : internal::singletons) {
        api.object_free_instance_binding(singleton, api.library);
    }
    internal::singletons.clear();
    for (auto& [text, name] : internal::interned_names) {
        *name = StringName();
    }
}

GDExtensionBinding::InitObject::InitObject(GDExtensionInterfaceGetProcAddress p_get_proc_address,
                                           GDExtensionClassLibraryPtr p_library,
                                           GDExtensionInitialization* r_initialization)
    : get_proc_address(p_get_proc_address), library(p_library), initialization(r_initialization) {}

void GDExtensionBinding::InitObject::register_initializer(Callback p_callback) const {
    internal::initializer = p_callback;
}

void GDExtensionBinding::InitObject::register_terminator(Callback p_callback) const {
    internal::terminator = p_callback;
}

void GDExtensionBinding::InitObject::register_startup_callback(
    GDExtensionMainLoopStartupCallback p_callback) const {
    internal::startup = p_callback;
}

void GDExtensionBinding::InitObject::set_minimum_library_initialization_level(
    ModuleInitializationLevel p_level) const {
    internal::minimum_level = GDExtensionInitializationLevel(p_level);
}

GDExtensionBool GDExtensionBinding::InitObject::init() const {
    const char* missing = api.load(get_proc_address, library);
    if (missing != nullptr) {
        // Without the interface there may be no way to print through the engine.
        if (api.print_error != nullptr) {
            const std::string text =
                std::string("This extension needs Godot 4.6 or newer: the engine lacks ") + missing;
            api.print_error(text.c_str(), __func__, __FILE__, __LINE__, true);
        }
        return false;
    }
    if (internal::startup != nullptr) {
        const auto register_callbacks = reinterpret_cast<GDExtensionInterfaceRegisterMainLoopCallbacks>(
            get_proc_address("register_main_loop_callbacks"));
        const GDExtensionMainLoopCallbacks callbacks{internal::startup, nullptr, nullptr};
        register_callbacks(library, &callbacks);
    }
    initialization->minimum_initialization_level = internal::minimum_level;
    initialization->userdata = nullptr;
    initialization->initialize = initialize_level;
    initialization->deinitialize = deinitialize_level;
    return true;
}

}  // namespace godot
