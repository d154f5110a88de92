#include <sstream>

#include "fuzz.h"
#include "photos/exif.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace treerec;
    std::istringstream jpeg(std::string(reinterpret_cast<const char*>(data), size));
    const auto place = read_photo_place(jpeg);
    if (!place) return 0;
    fuzz::require(place->latitude >= -90.0 && place->latitude <= 90.0, "a latitude is one");
    fuzz::require(place->longitude >= -180.0 && place->longitude <= 180.0, "a longitude is one");
    fuzz::require(!place->error || (*place->error > 0.0 && *place->error < 1e10), "errors are lengths");
    return 0;
}
