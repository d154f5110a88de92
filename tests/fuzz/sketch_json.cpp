#include "fuzz.h"
#include "sketch/read_sketch.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace treerec;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    try {
        Sketch sketch = parse_sketch_json(text, "a file");
        check_sketch(sketch);
        const Sketch again = parse_sketch_json(sketch_json(sketch));
        fuzz::require(again.canvas == sketch.canvas && again.seed == sketch.seed, "it reads back the same");
        fuzz::require(again.strokes.size() == sketch.strokes.size(), "it reads back as many strokes");
        for (size_t i = 0; i < sketch.strokes.size(); i++) {
            fuzz::require(again.strokes[i].points == sketch.strokes[i].points, "points read back the same");
            fuzz::require(again.strokes[i].pressure == sketch.strokes[i].pressure,
                          "pressures read back the same");
            fuzz::require(again.strokes[i].id == sketch.strokes[i].id && sketch.strokes[i].id > 0,
                          "ids stay");
        }
    } catch (const Error& error) {
        fuzz::require_sentence(error);
    }
    return 0;
}
