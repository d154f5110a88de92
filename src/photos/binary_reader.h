// Reads the little-endian values of COLMAP's binary files one after the other.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "error.h"

namespace treerec {

// Every method throws Error where the bytes end before. path: what sentences call the file; outlives it.
class BinaryReader {
  public:
    BinaryReader(const std::string& path, std::string_view bytes) : path_(path), bytes_(bytes) {}

    template <typename T>
    T value() {
        if (left() < sizeof(T)) fail();
        unsigned char raw[sizeof(T)];
        std::memcpy(raw, bytes_.data() + at_, sizeof(T));
        at_ += sizeof(T);
        uint64_t bits = 0;
        for (size_t i = sizeof(T); i-- > 0;)
            bits = bits << 8 | raw[i];
        T result;
        if constexpr (sizeof(T) == 8) {
            std::memcpy(&result, &bits, 8);
        } else if constexpr (sizeof(T) == 4) {
            const auto low = static_cast<uint32_t>(bits);
            std::memcpy(&result, &low, sizeof(T));
        } else {
            static_assert(sizeof(T) == 1);
            result = static_cast<T>(bits);
        }
        return result;
    }
    // Up to a null character.
    std::string text() {
        const size_t end = bytes_.find('\0', at_);
        if (end == std::string_view::npos) fail();
        std::string result(bytes_.substr(at_, end - at_));
        at_ = end + 1;
        return result;
    }
    void skip(uint64_t count, size_t size) {
        if (count > left() / size) fail();
        at_ += static_cast<size_t>(count) * size;
    }
    size_t left() const { return bytes_.size() - at_; }

  private:
    [[noreturn]] void fail() const {
        throw Error("The COLMAP model '" + path_ + "' is cut off; copy it again.");
    }

    const std::string& path_;
    std::string_view bytes_;
    size_t at_ = 0;
};

}  // namespace treerec
