#include "exchange/skeleton_parsers.h"
#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    treerec::looks_like_mtg({reinterpret_cast<const char*>(data), size});
    return treerec::fuzz::read_tree_of(data, size, treerec::parse_mtg);
}
