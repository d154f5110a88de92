#include "photos/sparse_points.h"

#include "fuzz.h"

// The first byte says whether it is text (odd).
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace treerec;
    if (size < 1) return 0;
    const std::string_view rest(reinterpret_cast<const char*>(data + 1), size - 1);
    try {
        for (const SparsePoint& point : parse_sparse_points(rest, data[0] % 2 == 1, "folder"))
            fuzz::require(is_finite(point.position), "a point has a place");
    } catch (const Error& error) {
        fuzz::require_sentence(error);
    }
    return 0;
}
