#include "exchange/skeleton_parsers.h"
#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    treerec::looks_like_swc(bytes, false);
    return treerec::fuzz::read_tree_of(data, size, treerec::parse_swc);
}
