#include <algorithm>
#include <cmath>
#include <memory>

#include "fuzz.h"
#include "photos/sift_matches.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace treerec;
    PhotoFolder photos;
    for (const char* name : {"a.jpg", "b.jpg"})
        photos.photos.push_back({.name = name});
    try {
        FileBytes file;
        file.size = size;
        file.data = std::make_unique<char[]>(size + 1);
        std::copy(data, data + size, file.data.get());
        const SqliteTables database("a database", std::move(file));
        for (const PhotoPlaceMatches& pair : sift_matches_in(database, "a database", photos)) {
            fuzz::require(pair.one < 2 && pair.other < 2 && pair.one != pair.other, "two photos are a pair");
            for (const PlaceMatch& match : pair.matches)
                fuzz::require(std::isfinite(match.one.x + match.other.y), "places are finite");
        }
    } catch (const Error& error) {
        fuzz::require_sentence(error);
    }
    return 0;
}
