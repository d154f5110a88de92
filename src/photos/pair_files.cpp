#include "photos/pair_files.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include "error.h"
#include "photos/binary_reader.h"

namespace treerec {

namespace {

constexpr std::string_view kHead = "treerec pairs 1\n";

void add(std::string& bytes, uint64_t value) {
    for (int i = 0; i < 8; i++)
        bytes += static_cast<char>(value >> 8 * i & 0xFF);
}

void add(std::string& bytes, double value) {
    add(bytes, std::bit_cast<uint64_t>(value));
}

}  // namespace

std::string pairs_as_bytes(const std::vector<PhotoPlaceMatches>& matches) {
    std::string bytes(kHead);
    for (const PhotoPlaceMatches& pair : matches) {
        for (const size_t number : {pair.one, pair.other, pair.matches.size()})
            add(bytes, static_cast<uint64_t>(number));
        for (const PlaceMatch& match : pair.matches)
            for (const double value : {match.one.x, match.one.y, match.other.x, match.other.y, match.weight})
                add(bytes, value);
    }
    return bytes;
}

std::optional<std::vector<PhotoPlaceMatches>> parse_all_pairs(std::string_view bytes, size_t photos) {
    if (!bytes.starts_with(kHead)) return {};
    static const std::string kNoName;
    BinaryReader reader(kNoName, bytes.substr(kHead.size()));
    std::vector<PhotoPlaceMatches> found;
    try {
        while (reader.left() > 0) {
            const auto one = reader.value<uint64_t>(), other = reader.value<uint64_t>(),
                       count = reader.value<uint64_t>();
            if (one >= photos || other >= photos || one == other || count > reader.left() / 40) return {};
            PhotoPlaceMatches& pair = found.emplace_back(
                PhotoPlaceMatches{static_cast<size_t>(one), static_cast<size_t>(other), {}});
            pair.matches.resize(static_cast<size_t>(count));
            for (PlaceMatch& match : pair.matches)
                for (double* value :
                     {&match.one.x, &match.one.y, &match.other.x, &match.other.y, &match.weight}) {
                    *value = reader.value<double>();
                    if (!std::isfinite(*value)) return {};
                }
        }
    } catch (const Error&) {
        return {};
    }
    return found;
}

std::optional<std::vector<PhotoPlaceMatches>> parse_pairs(
    std::string_view bytes, const std::vector<std::pair<size_t, size_t>>& pairs) {
    auto found = parse_all_pairs(bytes, SIZE_MAX);
    if (!found || found->size() != pairs.size()) return {};
    for (size_t i = 0; i < pairs.size(); i++)
        if (std::pair((*found)[i].one, (*found)[i].other) != pairs[i]) return {};
    return found;
}

}  // namespace treerec
