#include "exchange/skeleton_parsers.h"
#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    return treerec::fuzz::read_tree_of(data, size, treerec::parse_treefile);
}
