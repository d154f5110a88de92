// Loads the extension's library as the engine does, with an engine that knows the names of all
// functions (stand_in_table.py, from the real one's own list) and does next to nothing in them. Shows that
// the library loads, finds everything it asks for, and starts and ends. Tells what it registers.
#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#endif

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <set>
#include <string>
#include <type_traits>

#include "gdextension_interface.h"

namespace {

int asked = 0, missing = 0, methods = 0, references = 0;
alignas(16) unsigned char nothing[1 << 16];

// A function of the very type: WebAssembly calls no other.
template <typename Function>
struct Stub;
template <typename Returned, typename... Arguments>
struct Stub<Returned (*)(Arguments...)> {
    static Returned give(Arguments...) {
        if constexpr (std::is_void_v<Returned>)
            return;
        else if constexpr (std::is_function_v<std::remove_pointer_t<Returned>>)
            return Stub<Returned>::give;
        else if constexpr (std::is_pointer_v<Returned>)
            return reinterpret_cast<Returned>(nothing);
        else
            return {};
    }
};
template <typename Function>
GDExtensionInterfaceFunctionPtr function(Function given) {
    return reinterpret_cast<GDExtensionInterfaceFunctionPtr>(given);
}

struct Offered {
    const char* name;
    GDExtensionInterfaceFunctionPtr function;
};
const Offered kOffered[] = {
#include "stand_in_table.inc"
};

// The few that do something. A name is the pointer to its letters, the same one for the same letters.
void* allocate(size_t size) {
    return std::calloc(1, size);
}
void* allocate2(size_t size, GDExtensionBool) {
    return std::calloc(1, size);
}
void make_name(void* name, const char* letters, GDExtensionBool) {
    static std::set<std::string> known;
    const char* const kept = known.insert(letters).first->c_str();
    std::memcpy(name, &kept, sizeof kept);
}
void copy_name(void* name, const void* const* from) {
    std::memcpy(name, from[0], sizeof(const char*));
}
void compare_names(GDExtensionConstTypePtr one, GDExtensionConstTypePtr other, GDExtensionTypePtr equal) {
    *static_cast<GDExtensionBool*>(equal) = std::memcmp(one, other, sizeof(const char*)) == 0;
}
GDExtensionPtrConstructor constructor_of(GDExtensionVariantType type, int32_t which) {
    const bool copies = type == GDEXTENSION_VARIANT_TYPE_STRING_NAME && which == 1;
    return copies ? reinterpret_cast<GDExtensionPtrConstructor>(copy_name)
                  : Stub<GDExtensionPtrConstructor>::give;
}
GDExtensionPtrOperatorEvaluator comparison_of(GDExtensionVariantOperator which, GDExtensionVariantType one,
                                              GDExtensionVariantType other) {
    const bool names =
        which == GDEXTENSION_VARIANT_OP_EQUAL && one == other && one == GDEXTENSION_VARIANT_TYPE_STRING_NAME;
    return names ? compare_names : Stub<GDExtensionPtrOperatorEvaluator>::give;
}
const char* letters_of(const void* name) {
    const char* letters = nullptr;
    std::memcpy(&letters, name, sizeof letters);
    return letters ? letters : "";
}
void register_class(void*, const void* name, const void* parent, const void*) {
    std::printf("class %s of %s\n", letters_of(name), letters_of(parent));
}
void* load(const char* path) {
#ifdef _WIN32
    return reinterpret_cast<void*>(LoadLibraryA(path));
#else
    return dlopen(path, RTLD_NOW);
#endif
}
const char* why_not() {
#ifdef _WIN32
    static char text[32];
    std::snprintf(text, sizeof text, "error %lu", GetLastError());
    return text;
#else
    return dlerror();
#endif
}
void* entry_of(void* library) {
    constexpr const char* kEntry = "tree_reconstruction_library_init";
#ifdef _WIN32
    return reinterpret_cast<void*>(GetProcAddress(static_cast<HMODULE>(library), kEntry));
#else
    return dlsym(library, kEntry);
#endif
}
void unload(void* library) {
#ifdef _WIN32
    FreeLibrary(static_cast<HMODULE>(library));
#else
    dlclose(library);
#endif
}
void register_method(void*, const void*, const void*) {
    methods++;
}
void load_reference(const char* text, GDExtensionInt) {
    if (text) references++;
}
void print_error(const char* text, const char*, const char*, int32_t, GDExtensionBool) {
    std::printf("error %s\n", text);
}

const Offered kOwn[] = {
    {"mem_alloc", function(allocate)},
    {"mem_alloc2", function(allocate2)},
    {"string_name_new_with_latin1_chars", function(make_name)},
    {"variant_get_ptr_constructor", function(constructor_of)},
    {"variant_get_ptr_operator_evaluator", function(comparison_of)},
    {"classdb_register_extension_class5", function(register_class)},
    {"classdb_register_extension_class_method", function(register_method)},
    {"editor_help_load_xml_from_utf8_chars_and_len", function(load_reference)},
    {"print_error", function(print_error)},
};

GDExtensionInterfaceFunctionPtr get_proc_address(const char* name) {
    asked++;
    for (const Offered& own : kOwn)
        if (std::strcmp(own.name, name) == 0) return own.function;
    for (const Offered& offered : kOffered)
        if (std::strcmp(offered.name, name) == 0) return offered.function;
    std::printf("missing %s\n", name);
    missing++;
    return nullptr;
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::fprintf(stderr, "usage: stand_in_host LIBRARY\n");
        return 2;
    }
    void* const library = load(arguments[1]);
    if (!library) {
        std::printf("not loaded: %s\n", why_not());
        return 1;
    }
    const auto entry = reinterpret_cast<GDExtensionInitializationFunction>(entry_of(library));
    if (!entry) {
        std::printf("no entry function\n");
        return 1;
    }
    GDExtensionInitialization initialization = {};
    static int token = 0;
    const bool started = entry(get_proc_address, &token, &initialization) != 0;
    std::printf("entry %s, %d functions asked for, %d missing\n", started ? "started" : "refused", asked,
                missing);
    if (!started || missing || !initialization.initialize || !initialization.deinitialize) return 1;
    for (int level = initialization.minimum_initialization_level;
         level < GDEXTENSION_MAX_INITIALIZATION_LEVEL; level++)
        initialization.initialize(initialization.userdata,
                                  static_cast<GDExtensionInitializationLevel>(level));
    std::printf("registered %d methods, %d pages of the class reference\n", methods, references);
    std::fflush(stdout);
    for (int level = GDEXTENSION_MAX_INITIALIZATION_LEVEL - 1;
         level >= int(initialization.minimum_initialization_level); level--)
        initialization.deinitialize(initialization.userdata,
                                    static_cast<GDExtensionInitializationLevel>(level));
    unload(library);
    std::printf("ended\n");
    return 0;
}
