// What well-known text says of a coordinate system's units: OGC 01-009 (WKT 1) and OGC 18-010r7 (WKT 2).
// Internal to scan/.
#pragma once

#include <string_view>

namespace treerec {

// Metres of a unit; 0 where the text says none.
struct WktUnits {
    double plan = 0.0;
    double height = 0.0;   // of the vertical system, or of a third axis that points up
    bool degrees = false;  // longitude and latitude
    bool named = false;    // there is a coordinate system
};

// Whatever the text is; what cannot be understood says nothing.
WktUnits wkt_units(std::string_view text);

}  // namespace treerec
