#include "photos/marker_code.h"

#include <array>
#include <bit>

namespace treerec {

namespace {

constexpr int kMost = 1;  // cells that can be mended: (4 - 1) / 2, of the distance 4

// OpenCV's DICT_4X4_50 (cv::aruco::getPredefinedDictionary, the codes' first turn).
constexpr std::array<uint16_t, kMarkerCount> kCodes = {
    0xb532, 0x0f9a, 0x332d, 0x9946, 0x549e, 0x79cd, 0x9e2e, 0xc4f2, 0xfeda, 0xcf56, 0xf991, 0x11a7, 0x0eb7,
    0x2a0f, 0x24b1, 0x263e, 0x4665, 0x6600, 0x6c5e, 0x76af, 0x868b, 0xb02b, 0xccd5, 0xdd82, 0xfe47, 0x9471,
    0xace4, 0xa554, 0x2123, 0x346f, 0x4415, 0x57b2, 0x9ecf, 0xf0cb, 0x08ae, 0x0929, 0x1875, 0x04ff, 0x0df6,
    0x1c5a, 0x1718, 0x2a28, 0x328c, 0x38b2, 0x24e8, 0x2eeb, 0x2d3f, 0x4b64, 0x502e, 0x5013};

constexpr uint16_t bit_at(int x, int y) {
    return static_cast<uint16_t>(1U << (kMarkerBits * kMarkerBits - 1 - (kMarkerBits * y + x)));
}

// A quarter turn against the clock.
uint16_t turned_back(uint16_t code) {
    unsigned turned = 0;
    for (int y = 0; y < kMarkerBits; y++)
        for (int x = 0; x < kMarkerBits; x++)
            if (code & bit_at(kMarkerBits - 1 - y, x)) turned |= bit_at(x, y);
    return static_cast<uint16_t>(turned);
}

}  // namespace

uint16_t marker_code(int id) {
    return kCodes[static_cast<size_t>(id)];
}

bool is_white_cell(int id, int x, int y) {
    if (x < 1 || y < 1 || x > kMarkerBits || y > kMarkerBits) return false;
    return (marker_code(id) & bit_at(x - 1, y - 1)) != 0;
}

std::optional<ReadCode> identify_marker(uint16_t code) {
    for (int turns = 0; turns < 4; turns++) {
        for (int id = 0; id < kMarkerCount; id++) {
            const int wrong = std::popcount(static_cast<unsigned>(code ^ marker_code(id)));
            if (wrong <= kMost) return ReadCode{id, turns, wrong};
        }
        code = turned_back(code);
    }
    return {};
}

}  // namespace treerec
