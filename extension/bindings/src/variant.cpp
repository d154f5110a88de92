#include <godot_cpp/classes/object.hpp>
#include <godot_cpp/core/error_macros.hpp>
#include <godot_cpp/core/print_string.hpp>
#include <godot_cpp/variant/variant.hpp>

#include <cstring>
#include <utility>

namespace godot {

namespace internal {

// Conversions of every type from and to Variant, fetched once. The table needs no lock: its entries are
// constants.
struct Conversions {
    GDExtensionVariantFromTypeConstructorFunc from[Variant::VARIANT_MAX] = {};
    GDExtensionTypeFromVariantConstructorFunc to[Variant::VARIANT_MAX] = {};

    Conversions() {
        for (int i = 1; i < Variant::VARIANT_MAX; i++) {
            from[i] = api.get_variant_from_type_constructor(GDExtensionVariantType(i));
            to[i] = api.get_variant_to_type_constructor(GDExtensionVariantType(i));
        }
    }
};

static const Conversions& conversions() {
    static const Conversions table;
    return table;
}

}  // namespace internal

using internal::api;

Variant::Variant() {
    api.variant_new_nil(opaque);
}

Variant::Variant(int p_type, const void* p_value) {
    internal::conversions().from[p_type](opaque, const_cast<void*>(p_value));
}

void Variant::convert(int p_type, void* r_value) const {
    internal::conversions().to[p_type](r_value, const_cast<uint8_t*>(opaque));
}

Variant::Variant(const Variant& p_other) {
    api.variant_new_copy(opaque, p_other.opaque);
}

Variant::Variant(Variant&& p_other) noexcept : Variant() {
    std::swap(opaque, p_other.opaque);
}

Variant::~Variant() {
    api.variant_destroy(opaque);
}

Variant& Variant::operator=(const Variant& p_other) {
    Variant copy(p_other);
    std::swap(opaque, copy.opaque);
    return *this;
}

Variant& Variant::operator=(Variant&& p_other) noexcept {
    std::swap(opaque, p_other.opaque);
    return *this;
}

template <typename T>
T Variant::converted(int p_type) const {
    alignas(T) uint8_t raw[sizeof(T)];
    convert(p_type, raw);
    T* value = reinterpret_cast<T*>(raw);
    T result(std::move(*value));
    value->~T();
    return result;
}

Variant::Variant(bool p_value) {
    const GDExtensionBool value = p_value;
    internal::conversions().from[BOOL](opaque, const_cast<GDExtensionBool*>(&value));
}

Variant::Variant(int64_t p_value) : Variant(INT, &p_value) {}

Variant::Variant(double p_value) : Variant(FLOAT, &p_value) {}

Variant::Variant(const char* p_value) : Variant(String(p_value)) {}

Variant::Variant(const Object* p_value) {
    void* owner = p_value == nullptr ? nullptr : p_value->_owner;
    internal::conversions().from[OBJECT](opaque, &owner);
}

Variant::operator bool() const {
    return booleanize();
}

Variant::operator int64_t() const {
    int64_t value = 0;
    convert(INT, &value);
    return value;
}

Variant::operator double() const {
    double value = 0;
    convert(FLOAT, &value);
    return value;
}

#define GODOT_VARIANT_CONVERSION(m_type, m_enum)                                    \
    Variant::Variant(const ::godot::m_type& p_value) : Variant(m_enum, &p_value) {} \
    Variant::operator ::godot::m_type() const {                                     \
        return converted<::godot::m_type>(m_enum);                                  \
    }
GODOT_BUILTIN_TYPES(GODOT_VARIANT_CONVERSION)
#undef GODOT_VARIANT_CONVERSION

Object* Variant::get_validated_object() const {
    const GDObjectInstanceID id = api.variant_get_object_instance_id(opaque);
    return id == 0 ? nullptr : internal::get_object_instance_binding(api.object_get_instance_from_id(id));
}

Variant::Type Variant::get_type() const {
    return Type(api.variant_get_type(opaque));
}

String Variant::get_type_name(Type p_type) {
    String name;
    api.variant_get_type_name(GDExtensionVariantType(p_type), name._native_ptr());
    return name;
}

bool Variant::can_convert_strict(Type p_from, Type p_to) {
    return api.variant_can_convert_strict(GDExtensionVariantType(p_from), GDExtensionVariantType(p_to));
}

String Variant::stringify() const {
    String text;
    api.variant_stringify(opaque, text._native_ptr());
    return text;
}

bool Variant::booleanize() const {
    return api.variant_booleanize(opaque);
}

uint32_t Variant::hash() const {
    return uint32_t(api.variant_hash(opaque));
}

void Variant::clear() {
    *this = Variant();
}

Variant Variant::get(const Variant& p_key, bool* r_valid) const {
    Variant value;
    GDExtensionBool valid = false;
    api.variant_get(opaque, p_key.opaque, value.opaque, &valid);
    if (r_valid != nullptr) {
        *r_valid = valid;
    }
    return value;
}

void Variant::set(const Variant& p_key, const Variant& p_value, bool* r_valid) {
    GDExtensionBool valid = false;
    api.variant_set(opaque, p_key.opaque, p_value.opaque, &valid);
    if (r_valid != nullptr) {
        *r_valid = valid;
    }
}

void Variant::callp(const StringName& p_method, const Variant** p_args, int p_count, Variant& r_return,
                    GDExtensionCallError& r_error) {
    r_return.clear();
    api.variant_call(opaque, p_method._native_ptr(),
                     reinterpret_cast<const GDExtensionConstVariantPtr*>(p_args), p_count, r_return.opaque,
                     &r_error);
}

void Variant::evaluate(Operator p_operator, const Variant& p_a, const Variant& p_b, Variant& r_return,
                       bool& r_valid) {
    GDExtensionBool valid = false;
    Variant result;
    api.variant_evaluate(GDExtensionVariantOperator(p_operator), p_a.opaque, p_b.opaque, result.opaque,
                         &valid);
    r_return = std::move(result);
    r_valid = valid;
}

bool Variant::operator==(const Variant& p_other) const {
    Variant result;
    bool valid = false;
    evaluate(OP_EQUAL, *this, p_other, result, valid);
    return valid && result.booleanize();
}

bool Variant::operator<(const Variant& p_other) const {
    Variant result;
    bool valid = false;
    evaluate(OP_LESS, *this, p_other, result, valid);
    return valid && result.booleanize();
}

String::String(const char* p_text) {
    api.string_new_with_latin1_chars(opaque, p_text == nullptr ? "" : p_text);
}

String::String(const char32_t* p_text) {
    api.string_new_with_utf32_chars(opaque, p_text == nullptr ? U"" : p_text);
}

String String::utf8(const char* p_text, int64_t p_length) {
    String text;
    api.string_new_with_utf8_chars_and_len2(text.opaque, p_text, p_length);
    return text;
}

CharString String::utf8() const {
    std::string bytes(size_t(api.string_to_utf8_chars(opaque, nullptr, 0)), '\0');
    api.string_to_utf8_chars(opaque, bytes.data(), int64_t(bytes.size()));
    return CharString(std::move(bytes));
}

CharString String::ascii() const {
    std::string bytes(size_t(api.string_to_latin1_chars(opaque, nullptr, 0)), '\0');
    api.string_to_latin1_chars(opaque, bytes.data(), int64_t(bytes.size()));
    return CharString(std::move(bytes));
}

char32_t String::operator[](int64_t p_index) const {
    return *api.string_operator_index_const(opaque, p_index);
}

String String::operator+(const String& p_other) const {
    String sum(*this);
    return sum += p_other;
}

String String::operator%(const Variant& p_values) const {
    Variant result;
    bool valid = false;
    Variant::evaluate(Variant::OP_MODULE, *this, p_values, result, valid);
    return result;
}

String& String::operator+=(const String& p_other) {
    api.string_operator_plus_eq_string(opaque, p_other.opaque);
    return *this;
}

StringName::StringName(const char* p_text) {
    api.string_name_new_with_latin1_chars(opaque, p_text == nullptr ? "" : p_text, false);
}

uintptr_t StringName::_key() const {
    uintptr_t key = 0;
    std::memcpy(&key, opaque, sizeof(key));
    return key;
}

Array::Array(std::initializer_list<Variant> p_values) : Array() {
    resize(int64_t(p_values.size()));
    int64_t index = 0;
    for (const Variant& value : p_values) {
        (*this)[index++] = value;
    }
}

Variant& Array::operator[](int64_t p_index) {
    return *static_cast<Variant*>(api.array_operator_index(opaque, p_index));
}

const Variant& Array::operator[](int64_t p_index) const {
    return *static_cast<const Variant*>(api.array_operator_index_const(opaque, p_index));
}

void Array::set_typed(uint32_t p_type, const StringName& p_class_name, const Variant& p_script) {
    api.array_set_typed(opaque, GDExtensionVariantType(p_type), p_class_name._native_ptr(),
                        p_script._native_ptr());
}

Variant& Dictionary::operator[](const Variant& p_key) {
    return *static_cast<Variant*>(api.dictionary_operator_index(opaque, p_key._native_ptr()));
}

const Variant& Dictionary::operator[](const Variant& p_key) const {
    return *static_cast<const Variant*>(api.dictionary_operator_index_const(opaque, p_key._native_ptr()));
}

void _err_print(const char* p_function, const char* p_file, int p_line, const char* p_condition,
                const String& p_message, bool p_is_warning) {
    const CharString message = p_message.utf8();
    if (p_is_warning) {
        api.print_warning(message.get_data(), p_function, p_file, p_line, false);
    } else if (p_condition[0] == '\0') {
        api.print_error(message.get_data(), p_function, p_file, p_line, false);
    } else if (message.length() == 0) {
        api.print_error(p_condition, p_function, p_file, p_line, false);
    } else {
        api.print_error_with_message(p_condition, message.get_data(), p_function, p_file, p_line, false);
    }
}

void _err_print_index(const char* p_function, const char* p_file, int p_line, int64_t p_index, int64_t p_size,
                      const char* p_index_text, const char* p_size_text, const String& p_message) {
    const String condition =
        vformat("Index %s = %d is out of bounds (%s = %d).", p_index_text, p_index, p_size_text, p_size);
    _err_print(p_function, p_file, p_line, condition.utf8().get_data(), p_message);
}

}  // namespace godot
