// The codes of printed square markers: ArUco's dictionary DICT_4X4_50, which every generator of them prints
// (S. Garrido-Jurado et al., "Automatic generation and detection of highly reliable fiducial markers under
// occlusion", 2014).
#pragma once

#include <cstdint>
#include <optional>

namespace treerec {

inline constexpr int kMarkerBits = 4;                 // along a side of the code
inline constexpr int kMarkerCells = kMarkerBits + 2;  // with the black border of one cell
inline constexpr int kMarkerCount = 50;               // ids 0 to 49

// The code of an id as it is printed: row by row from the upper left, the first cell in the highest of 16
// bits, white is 1. id: 0 to 49.
uint16_t marker_code(int id);

// Whether the cell of the whole marker is white. x, y: 0 to 5 from the upper left; the border is black.
bool is_white_cell(int id, int x, int y);

struct ReadCode {
    int id = 0;
    int turns = 0;   // quarter turns clockwise that the marker was turned by
    int mended = 0;  // cells that were read wrongly: 0 or 1
};

// Which marker a code is that was read in any of its four turns. Two codes of the dictionary differ in 4
// cells or more, whichever way they are turned: one wrong cell is mended. Nothing for what is none.
std::optional<ReadCode> identify_marker(uint16_t code);

}  // namespace treerec
