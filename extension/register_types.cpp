#include "register_types.h"

#include <gdextension_interface.h>

#include <godot_cpp/core/class_db.hpp>

#include "geometry/parallel.h"
#include "l_system.h"
#include "leaf_rule.h"
#include "tree_edit.h"
#include "tree_reconstruction/tree_reconstruction.h"
#include "tree_sketch.h"
#include "wind_globals.h"

#ifdef TREEREC_EDITOR
#include "class_reference.h"
#include "exchange/ready_pictures.h"
#include "tree_reconstructor/tree_fidelity.h"
#include "tree_reconstructor/tree_reconstructor.h"
#endif

using namespace godot;

#ifdef TREEREC_EDITOR
static GDExtensionInterfaceGetProcAddress get_proc_address = nullptr;

static void load_class_reference() {
    using LoadXml = void (*)(const char* p_text, GDExtensionInt p_length);
    const auto load =
        reinterpret_cast<LoadXml>(get_proc_address("editor_help_load_xml_from_utf8_chars_and_len"));
    if (load == nullptr) {
        return;  // An engine without an editor.
    }
    for (const std::string_view text : kClassReference) {
        load(text.data(), int64_t(text.size()));
    }
}
#endif

void initialize_tree_reconstruction(ModuleInitializationLevel p_level) {
    switch (p_level) {
        case MODULE_INITIALIZATION_LEVEL_SCENE:
            GDREGISTER_CLASS(LeafRule)
            GDREGISTER_CLASS(TreeEdit)
            GDREGISTER_CLASS(TreeReconstruction)
            GDREGISTER_CLASS(LSystem)
            GDREGISTER_CLASS(TreeSketch)
#ifdef TREEREC_EDITOR
            GDREGISTER_CLASS(TreeFidelity)
            GDREGISTER_CLASS(
                TreeReconstructor)  // Here, since scripts run by the editor's program use it too.
            treerec::use_ready_pictures();
#endif
            break;
        case MODULE_INITIALIZATION_LEVEL_EDITOR:
#ifdef TREEREC_EDITOR
            load_class_reference();
#endif
            break;
        default:
            break;
    }
}

void terminate_tree_reconstruction(ModuleInitializationLevel p_level) {
    if (p_level == MODULE_INITIALIZATION_LEVEL_SCENE) {
        treerec::end_idle_threads();
    }
}

extern "C" GDExtensionBool GDE_EXPORT tree_reconstruction_library_init(
    GDExtensionInterfaceGetProcAddress p_get_proc_address, GDExtensionClassLibraryPtr p_library,
    GDExtensionInitialization* r_initialization) {
#ifdef TREEREC_EDITOR
    get_proc_address = p_get_proc_address;
#endif
    const GDExtensionBinding::InitObject binding(p_get_proc_address, p_library, r_initialization);
    binding.register_initializer(initialize_tree_reconstruction);
    binding.register_terminator(terminate_tree_reconstruction);
    binding.register_startup_callback(add_wind_globals);
    binding.set_minimum_library_initialization_level(MODULE_INITIALIZATION_LEVEL_SCENE);
    return binding.init();
}
