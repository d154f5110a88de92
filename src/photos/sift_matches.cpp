#include "photos/sift_matches.h"

#include <cmath>
#include <map>

#include "error.h"
#include "photos/binary_reader.h"

namespace treerec {

namespace {

constexpr int64_t kMostImages = 2147483647;  // a pair's number is first * this + second
// COLMAP verifies pairs of 15 that look away from each other; joined to others they would spread.
constexpr size_t kLeastShared = 30;
constexpr double kWeight = 0.5;  // a tracked corner's is its similarity, .7 at least: it is more often right

// rows, cols and the bytes of a table of 4-byte numbers, which begin at a row's second value.
struct Numbers {
    size_t rows = 0, columns = 0;
    std::string_view bytes;
};

Numbers numbers_in(const std::vector<SqliteValue>& values, const std::string& path) {
    Numbers numbers;
    const bool well =
        values.size() >= 4 && values[1].integer >= 0 && values[2].integer >= 0 && values[2].integer <= 64;
    if (well) {
        numbers.rows = static_cast<size_t>(values[1].integer);
        numbers.columns = static_cast<size_t>(values[2].integer);
        numbers.bytes = values[3].bytes;
    }
    if (!well || (numbers.columns > 0 && numbers.rows != numbers.bytes.size() / 4 / numbers.columns) ||
        numbers.rows * numbers.columns * 4 != numbers.bytes.size())
        throw Error("The database '" + path + "' is damaged; delete it, and run the same command again.");
    return numbers;
}

}  // namespace

std::vector<PhotoPlaceMatches> read_sift_matches(const std::string& path, const PhotoFolder& photos) {
    return sift_matches_in(SqliteTables(path), path, photos);
}

std::vector<PhotoPlaceMatches> sift_matches_in(const SqliteTables& database, const std::string& path,
                                               const PhotoFolder& photos) {
    std::map<std::string, size_t, std::less<>> numbers;
    for (size_t i = 0; i < photos.photos.size(); i++)
        numbers[photos.photos[i].name] = i;
    std::map<int64_t, size_t> photo_of;  // by COLMAP's number of an image
    database.each_row("images", [&](int64_t key, const std::vector<SqliteValue>& values) {
        if (values.size() < 2) return;
        const auto found = numbers.find(values[1].bytes);
        if (found != numbers.end()) photo_of[key] = found->second;
    });
    std::map<int64_t, std::vector<DVec2>> keypoints;
    database.each_row("keypoints", [&](int64_t key, const std::vector<SqliteValue>& values) {
        const Numbers table = numbers_in(values, path);
        if (table.columns < 2) return;
        std::vector<DVec2>& places = keypoints[key];
        BinaryReader reader(path, table.bytes);
        for (size_t i = 0; i < table.rows; i++) {
            const auto x = static_cast<double>(reader.value<float>()),
                       y = static_cast<double>(reader.value<float>());
            places.emplace_back(x, y);
            reader.skip(table.columns - 2, 4);
        }
    });
    std::vector<PhotoPlaceMatches> pairs;
    database.each_row("two_view_geometries", [&](int64_t key, const std::vector<SqliteValue>& values) {
        const Numbers table = numbers_in(values, path);
        const int64_t other = key % kMostImages, one = key / kMostImages;
        const auto first = photo_of.find(one), second = photo_of.find(other);
        const auto from = keypoints.find(one), to = keypoints.find(other);
        if (first == photo_of.end() || second == photo_of.end() || from == keypoints.end() ||
            to == keypoints.end() || first == second || table.columns != 2 || table.rows < kLeastShared)
            return;
        PhotoPlaceMatches pair{first->second, second->second, {}};
        BinaryReader reader(path, table.bytes);
        for (size_t i = 0; i < table.rows; i++) {
            const auto a = reader.value<uint32_t>(), b = reader.value<uint32_t>();
            if (a >= from->second.size() || b >= to->second.size()) continue;
            const DVec2 here = from->second[a], there = to->second[b];
            if (std::isfinite(here.x + here.y + there.x + there.y))
                pair.matches.push_back({here, there, kWeight});
        }
        pairs.push_back(std::move(pair));
    });
    return pairs;
}

}  // namespace treerec
