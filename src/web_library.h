// What emscripten's C++ library may lack, read before every file of a web build: numbers to text and back
// came to it late, and Debian's version has no bit_cast. Elsewhere nothing includes this.
#pragma once

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <type_traits>

namespace std {

#ifndef __cpp_lib_bit_cast
template <typename To, typename From>
inline To bit_cast(const From& from) noexcept {
    static_assert(sizeof(To) == sizeof(From) && is_trivially_copyable_v<From>);
    To to;
    memcpy(&to, &from, sizeof to);
    return to;
}
#endif

#ifndef __cpp_lib_smart_ptr_for_overwrite
template <typename Array>
inline unique_ptr<Array> make_unique_for_overwrite(size_t count) {
    return unique_ptr<Array>(new remove_extent_t<Array>[count]);
}
#endif

#ifndef __cpp_lib_to_chars
#if _LIBCPP_VERSION < 14000
// The shortest text that reads back as the same number.
template <typename Number, enable_if_t<is_floating_point_v<Number>, int> = 0>
inline to_chars_result to_chars(char* first, char* last, Number value) {
    char text[40];
    int size = 0;
    for (int digits = 1; digits <= 17; digits++) {
        size = snprintf(text, sizeof text, "%.*g", digits, static_cast<double>(value));
        if (value != value || static_cast<Number>(strtod(text, nullptr)) == value) break;
    }
    if (last - first < size) return {last, errc::value_too_large};
    return {copy_n(text, size, first), errc()};
}

template <typename Number, enable_if_t<is_floating_point_v<Number>, int> = 0>
inline to_chars_result to_chars(char* first, char* last, Number value, chars_format format, int precision) {
    const char* const how = format == chars_format::fixed        ? "%.*f"
                            : format == chars_format::scientific ? "%.*e"
                                                                 : "%.*g";
    const int size = snprintf(nullptr, 0, how, precision, static_cast<double>(value));
    string text(static_cast<size_t>(size) + 1, '\0');
    snprintf(text.data(), text.size(), how, precision, static_cast<double>(value));
    if (last - first < size) return {last, errc::value_too_large};
    return {copy_n(text.data(), size, first), errc()};
}
#endif

// The C locale is the only one there. No leading space, plus or hexadecimal, as the standard has it.
template <typename Number, enable_if_t<is_floating_point_v<Number>, int> = 0>
inline from_chars_result from_chars(const char* first, const char* last, Number& value) {
    const char* const digits = first != last && *first == '-' ? first + 1 : first;
    if (digits == last || *digits == '+' || *digits == ' ' || (*digits >= '\t' && *digits <= '\r'))
        return {first, errc::invalid_argument};
    // A number's text ends where no more of it can follow.
    const char* end = digits;
    while (end != last &&
           (isalnum(static_cast<unsigned char>(*end)) || *end == '.' || *end == '+' || *end == '-'))
        end++;
    if (digits + 1 < end && digits[0] == '0' && (digits[1] == 'x' || digits[1] == 'X')) end = digits + 1;
    const string text(first, end);
    char* read = nullptr;
    const double found = strtod(text.c_str(), &read);
    if (read == text.c_str()) return {first, errc::invalid_argument};
    const char* const after = first + (read - text.c_str());
    const auto number = static_cast<Number>(found);
    const bool told = text.find_first_of("iInN") != string::npos;  // inf and nan
    if (!told &&
        (number - number != 0 || (number == 0 && text.find_first_of("123456789") < text.find_first_of("eE"))))
        return {after, errc::result_out_of_range};
    value = number;
    return {after, errc()};
}
#endif

}  // namespace std
