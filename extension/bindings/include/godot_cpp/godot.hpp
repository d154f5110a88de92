#pragma once

#include <godot_cpp/core/defs.hpp>
#include <godot_cpp/core/interface.hpp>

namespace godot {

enum ModuleInitializationLevel {
    MODULE_INITIALIZATION_LEVEL_CORE = GDEXTENSION_INITIALIZATION_CORE,
    MODULE_INITIALIZATION_LEVEL_SERVERS = GDEXTENSION_INITIALIZATION_SERVERS,
    MODULE_INITIALIZATION_LEVEL_SCENE = GDEXTENSION_INITIALIZATION_SCENE,
    MODULE_INITIALIZATION_LEVEL_EDITOR = GDEXTENSION_INITIALIZATION_EDITOR,
    MODULE_INITIALIZATION_LEVEL_MAX
};

// The library's start: what its entry function fills in and returns the success of.
class GDExtensionBinding {
    static void initialize_level(void* p_userdata, GDExtensionInitializationLevel p_level);
    static void deinitialize_level(void* p_userdata, GDExtensionInitializationLevel p_level);

  public:
    using Callback = void (*)(ModuleInitializationLevel p_level);

    class InitObject {
        GDExtensionInterfaceGetProcAddress get_proc_address;
        GDExtensionClassLibraryPtr library;
        GDExtensionInitialization* initialization;

      public:
        InitObject(GDExtensionInterfaceGetProcAddress p_get_proc_address,
                   GDExtensionClassLibraryPtr p_library, GDExtensionInitialization* r_initialization);

        void register_initializer(Callback p_callback) const;
        void register_terminator(Callback p_callback) const;
        // Called when the engine has started, all its servers with it.
        void register_startup_callback(GDExtensionMainLoopStartupCallback p_callback) const;
        void set_minimum_library_initialization_level(ModuleInitializationLevel p_level) const;
        GDExtensionBool init() const;
    };
};

}  // namespace godot
