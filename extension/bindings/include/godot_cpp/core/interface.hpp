#pragma once

#include <gdextension_interface.h>

// The engine's C functions in use, looked up by name once at start-up: their name and the type of the
// pointer.
#define GODOT_INTERFACE_FUNCTIONS(X)                                                                     \
    X(print_error, PrintError)                                                                           \
    X(print_error_with_message, PrintErrorWithMessage)                                                   \
    X(print_warning, PrintWarning)                                                                       \
    X(variant_new_copy, VariantNewCopy)                                                                  \
    X(variant_new_nil, VariantNewNil)                                                                    \
    X(variant_destroy, VariantDestroy)                                                                   \
    X(variant_call, VariantCall)                                                                         \
    X(variant_evaluate, VariantEvaluate)                                                                 \
    X(variant_set, VariantSet)                                                                           \
    X(variant_get, VariantGet)                                                                           \
    X(variant_hash, VariantHash)                                                                         \
    X(variant_booleanize, VariantBooleanize)                                                             \
    X(variant_stringify, VariantStringify)                                                               \
    X(variant_get_type, VariantGetType)                                                                  \
    X(variant_get_type_name, VariantGetTypeName)                                                         \
    X(variant_can_convert_strict, VariantCanConvertStrict)                                               \
    X(variant_get_object_instance_id, VariantGetObjectInstanceId)                                        \
    X(get_variant_from_type_constructor, GetVariantFromTypeConstructor)                                  \
    X(get_variant_to_type_constructor, GetVariantToTypeConstructor)                                      \
    X(variant_get_ptr_operator_evaluator, VariantGetPtrOperatorEvaluator)                                \
    X(variant_get_ptr_builtin_method, VariantGetPtrBuiltinMethod)                                        \
    X(variant_get_ptr_constructor, VariantGetPtrConstructor)                                             \
    X(variant_get_ptr_destructor, VariantGetPtrDestructor)                                               \
    X(variant_get_ptr_utility_function, VariantGetPtrUtilityFunction)                                    \
    X(string_new_with_latin1_chars, StringNewWithLatin1Chars)                                            \
    X(string_new_with_utf8_chars_and_len2, StringNewWithUtf8CharsAndLen2)                                \
    X(string_new_with_utf32_chars, StringNewWithUtf32Chars)                                              \
    X(string_to_utf8_chars, StringToUtf8Chars)                                                           \
    X(string_to_latin1_chars, StringToLatin1Chars)                                                       \
    X(string_operator_index_const, StringOperatorIndexConst)                                             \
    X(string_operator_plus_eq_string, StringOperatorPlusEqString)                                        \
    X(string_name_new_with_latin1_chars, StringNameNewWithLatin1Chars)                                   \
    X(array_operator_index, ArrayOperatorIndex)                                                          \
    X(array_operator_index_const, ArrayOperatorIndexConst)                                               \
    X(array_set_typed, ArraySetTyped)                                                                    \
    X(dictionary_operator_index, DictionaryOperatorIndex)                                                \
    X(dictionary_operator_index_const, DictionaryOperatorIndexConst)                                     \
    X(packed_byte_array_operator_index, PackedByteArrayOperatorIndex)                                    \
    X(packed_byte_array_operator_index_const, PackedByteArrayOperatorIndexConst)                         \
    X(packed_int32_array_operator_index, PackedInt32ArrayOperatorIndex)                                  \
    X(packed_int32_array_operator_index_const, PackedInt32ArrayOperatorIndexConst)                       \
    X(packed_int64_array_operator_index, PackedInt64ArrayOperatorIndex)                                  \
    X(packed_int64_array_operator_index_const, PackedInt64ArrayOperatorIndexConst)                       \
    X(packed_float32_array_operator_index, PackedFloat32ArrayOperatorIndex)                              \
    X(packed_float32_array_operator_index_const, PackedFloat32ArrayOperatorIndexConst)                   \
    X(packed_float64_array_operator_index, PackedFloat64ArrayOperatorIndex)                              \
    X(packed_float64_array_operator_index_const, PackedFloat64ArrayOperatorIndexConst)                   \
    X(packed_string_array_operator_index, PackedStringArrayOperatorIndex)                                \
    X(packed_string_array_operator_index_const, PackedStringArrayOperatorIndexConst)                     \
    X(packed_vector2_array_operator_index, PackedVector2ArrayOperatorIndex)                              \
    X(packed_vector2_array_operator_index_const, PackedVector2ArrayOperatorIndexConst)                   \
    X(packed_vector3_array_operator_index, PackedVector3ArrayOperatorIndex)                              \
    X(packed_vector3_array_operator_index_const, PackedVector3ArrayOperatorIndexConst)                   \
    X(packed_vector4_array_operator_index, PackedVector4ArrayOperatorIndex)                              \
    X(packed_vector4_array_operator_index_const, PackedVector4ArrayOperatorIndexConst)                   \
    X(packed_color_array_operator_index, PackedColorArrayOperatorIndex)                                  \
    X(packed_color_array_operator_index_const, PackedColorArrayOperatorIndexConst)                       \
    X(object_method_bind_call, ObjectMethodBindCall)                                                     \
    X(object_method_bind_ptrcall, ObjectMethodBindPtrcall)                                               \
    X(object_destroy, ObjectDestroy)                                                                     \
    X(global_get_singleton, GlobalGetSingleton)                                                          \
    X(object_get_instance_binding, ObjectGetInstanceBinding)                                             \
    X(object_set_instance_binding, ObjectSetInstanceBinding)                                             \
    X(object_free_instance_binding, ObjectFreeInstanceBinding)                                           \
    X(object_set_instance, ObjectSetInstance)                                                            \
    X(object_cast_to, ObjectCastTo)                                                                      \
    X(object_get_instance_from_id, ObjectGetInstanceFromId)                                              \
    X(ref_set_object, RefSetObject)                                                                      \
    X(classdb_construct_object2, ClassdbConstructObject2)                                                \
    X(classdb_get_method_bind, ClassdbGetMethodBind)                                                     \
    X(classdb_get_class_tag, ClassdbGetClassTag)                                                         \
    X(classdb_register_extension_class5, ClassdbRegisterExtensionClass5)                                 \
    X(classdb_register_extension_class_method, ClassdbRegisterExtensionClassMethod)                      \
    X(classdb_register_extension_class_integer_constant, ClassdbRegisterExtensionClassIntegerConstant)   \
    X(classdb_register_extension_class_property, ClassdbRegisterExtensionClassProperty)                  \
    X(classdb_register_extension_class_property_indexed, ClassdbRegisterExtensionClassPropertyIndexed)   \
    X(classdb_register_extension_class_property_group, ClassdbRegisterExtensionClassPropertyGroup)       \
    X(classdb_register_extension_class_property_subgroup, ClassdbRegisterExtensionClassPropertySubgroup) \
    X(classdb_register_extension_class_signal, ClassdbRegisterExtensionClassSignal)                      \
    X(classdb_unregister_extension_class, ClassdbUnregisterExtensionClass)

namespace godot::internal {

#define GODOT_DECLARE_FUNCTION(m_name, m_type) GDExtensionInterface##m_type m_name = nullptr;

struct Interface {
    GDExtensionClassLibraryPtr library = nullptr;  // Also the token of our instance bindings.
    GODOT_INTERFACE_FUNCTIONS(GODOT_DECLARE_FUNCTION)

    // The name of a function that this engine lacks, or null when all were found.
    const char* load(GDExtensionInterfaceGetProcAddress p_get_proc_address,
                     GDExtensionClassLibraryPtr p_library);
};

#undef GODOT_DECLARE_FUNCTION

extern Interface api;

}  // namespace godot::internal
