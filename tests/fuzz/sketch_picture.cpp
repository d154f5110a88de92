#include <cmath>

#include "fuzz.h"
#include "sketch/sketch_picture.h"

// The first two bytes are the size of a picture, the rest its pixels, eight a byte.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace treerec;
    if (size < 2) return 0;
    Image picture(1 + data[0] % 100, 1 + data[1] % 100, 4);
    for (size_t i = 0; i < picture.pixels.size(); i++) {
        const size_t at = i / 4;
        const bool ink = 2 + at / 8 < size && (data[2 + at / 8] >> at % 8 & 1) != 0;
        picture.pixels[i] = i % 4 == 3 || !ink ? 255 : 0;
    }
    try {
        const Sketch sketch = sketch_of_picture(picture, "A picture");
        check_sketch(sketch);
        fuzz::require(!sketch.strokes.empty(), "a picture that was read has lines");
        for (const Stroke& stroke : sketch.strokes)
            for (const DVec2& p : stroke.points)
                fuzz::require(p.x >= -50.0 && p.y >= -50.0 && p.x <= 150.0 && p.y <= 150.0,
                              "lines are in the picture");
    } catch (const Error& error) {
        fuzz::require_sentence(error);
    }
    return 0;
}
