#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    return treerec::fuzz::read_cloud_of(data, size, "a.las");
}
