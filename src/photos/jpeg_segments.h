// The segments before a JPEG's pixels (ITU T.81, B.1). Internal to photos/.
#pragma once

#include <array>
#include <cstddef>
#include <istream>

namespace treerec {

// Calls look(marker, size) for each, with the stream at its first byte behind the size and `size` bytes of it
// promised, until it returns false, the picture begins, or the bytes are none of a JPEG. in: at its
// beginning.
template <typename Look>
void each_jpeg_segment(std::istream& in, const Look& look) {
    std::array<char, 4> head{};
    const auto byte = [&](size_t i) { return static_cast<unsigned char>(head[i]); };
    if (!in.read(head.data(), 2) || byte(0) != 0xFF || byte(1) != 0xD8) return;
    while (in.read(head.data(), 4) && byte(0) == 0xFF) {
        if (byte(1) == 0xFF) {  // filling
            in.seekg(-3, std::ios::cur);
            continue;
        }
        const size_t size = size_t{byte(2)} << 8U | byte(3);
        // The picture begins, or ends.
        if (byte(1) == 0xDA || byte(1) == 0xD9 || size < 2) return;
        const std::streampos next = in.tellg() + static_cast<std::streamoff>(size - 2);
        if (!look(int{byte(1)}, size - 2)) return;
        in.seekg(next);
    }
}

}  // namespace treerec
