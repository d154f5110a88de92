#pragma once

#include <godot_cpp/classes/ref_counted.hpp>

#include <utility>

namespace godot {

// Shared ownership of a RefCounted object. T may be incomplete where a Ref<T> is only named, passed on or
// dropped: every wrapped class derives singly from RefCounted, so the pointer may be read as one.
template <typename T>
class Ref {
    T* reference = nullptr;

    static RefCounted* counted(T* p_object) { return reinterpret_cast<RefCounted*>(p_object); }

    struct Adopt {};
    Ref(Adopt, T* p_object) : reference(p_object) {}

  public:
    Ref() = default;
    Ref(std::nullptr_t) {}
    Ref(const Ref& p_other) : reference(p_other.reference) {
        if (reference != nullptr) {
            counted(reference)->reference();
        }
    }
    Ref(Ref&& p_other) noexcept : reference(std::exchange(p_other.reference, nullptr)) {}
    template <typename U>
    Ref(const Ref<U>& p_other) : Ref(_shared(Object::cast_to<T>(p_other.ptr()))) {}
    // Also takes charge of a new object, whose first owner inherits the count that it was born with.
    Ref(T* p_object) : reference(p_object) {
        if (reference != nullptr && !counted(reference)->init_ref()) {
            reference = nullptr;
        }
    }
    Ref(const Variant& p_value) : Ref(_shared(Object::cast_to<T>(p_value.get_validated_object()))) {}
    ~Ref() { unref(); }

    Ref& operator=(Ref p_other) noexcept {
        std::swap(reference, p_other.reference);
        return *this;
    }

    void unref() {
        if (reference != nullptr && counted(reference)->unreference()) {
            memdelete(counted(reference));
        }
        reference = nullptr;
    }
    void instantiate() { *this = Ref(memnew(T)); }

    T* ptr() const { return reference; }
    T* operator->() const { return reference; }
    T* operator*() const { return reference; }
    bool is_valid() const { return reference != nullptr; }
    bool is_null() const { return reference == nullptr; }
    operator Variant() const { return Variant(reinterpret_cast<const Object*>(reference)); }

    template <typename U>
    bool operator==(const Ref<U>& p_other) const {
        return static_cast<const void*>(reference) == static_cast<const void*>(p_other.ptr());
    }
    bool operator==(const T* p_other) const { return reference == p_other; }
    bool operator==(std::nullptr_t) const { return reference == nullptr; }
    bool operator<(const Ref& p_other) const { return reference < p_other.reference; }

    // One more owner of an object that others own already.
    static Ref _shared(T* p_object) {
        if (p_object != nullptr) {
            counted(p_object)->reference();
        }
        return Ref(Adopt(), p_object);
    }
    // The owner that an engine call counted for us in its return value.
    static Ref _adopted(T* p_object) { return Ref(Adopt(), p_object); }
};

}  // namespace godot
