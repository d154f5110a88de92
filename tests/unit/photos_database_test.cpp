// What COLMAP found, out of its database.
#include "photos_database.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "error.h"
#include "geometry/random.h"
#include "photos/sift_matches.h"
#include "photos/sqlite_tables.h"

namespace treerec {
namespace {

using test::Cell;
using test::DatabaseWriter;

SqliteTables opened(const std::string& bytes) {
    FileBytes file;
    file.size = bytes.size();
    file.data = std::make_unique<char[]>(bytes.size() + 1);
    std::copy(bytes.begin(), bytes.end(), file.data.get());
    return SqliteTables("a.db", std::move(file));
}

PhotoFolder three_photos() {
    PhotoFolder folder;
    for (const char* name : {"a.jpg", "b.jpg", "c.jpg"})
        folder.photos.push_back({.name = name});
    return folder;
}

std::vector<DVec2> many_places() {
    std::vector<DVec2> places;
    for (int i = 0; i < 300; i++)
        places.emplace_back(10.0 + 2.0 * i, 400.0 - i);
    return places;
}

TEST(PhotosDatabase, RowsOfAllKindsAndLengths) {
    const std::string length(100000, 'x');
    const SqliteTables database = opened(
        DatabaseWriter().bytes({{"one", {}},
                                {"two",
                                 {{-5, {Cell::number(-1), Cell::number(int64_t{1} << 40), Cell{}}},
                                  {1, {Cell::text("names"), Cell::blob(std::string("\0\1", 2))}},
                                  {int64_t{1} << 60, {Cell::text(length), Cell::blob(length + length)}}}}}));
    size_t rows = 0;
    database.each_row("one", [&](int64_t, const auto&) { rows++; });
    EXPECT_EQ(rows, 0u);
    std::vector<int64_t> keys;
    database.each_row("two", [&](int64_t key, const std::vector<SqliteValue>& values) {
        keys.push_back(key);
        if (key == -5) {
            ASSERT_EQ(values.size(), 3u);
            EXPECT_EQ(values[0].integer, -1);
            EXPECT_EQ(values[1].integer, int64_t{1} << 40);
            EXPECT_EQ(values[2].kind, SqliteValue::Kind::kNull);
        } else if (key == 1) {
            EXPECT_EQ(values[0].bytes, "names");
            EXPECT_EQ(values[1].kind, SqliteValue::Kind::kBlob);
            EXPECT_EQ(values[1].bytes.size(), 2u);
        } else {
            EXPECT_EQ(values[0].bytes, length);
            EXPECT_EQ(values[1].bytes, length + length);
        }
    });
    EXPECT_EQ(keys, (std::vector<int64_t>{-5, 1, int64_t{1} << 60}));
    EXPECT_THROW(database.each_row("three", [](int64_t, const auto&) {}), Error);
}

TEST(PhotosDatabase, MatchesArePlacesInThePhotos) {
    const std::vector<DVec2> places = many_places();
    const SqliteTables database = opened(
        DatabaseWriter().bytes(test::colmap_tables({"b.jpg", "elsewhere.jpg", "c.jpg", "a.jpg"}, places)));
    const std::vector<PhotoPlaceMatches> pairs = sift_matches_in(database, "a.db", three_photos());
    ASSERT_EQ(pairs.size(), 1u);
    EXPECT_EQ(pairs[0].one, 2u);
    EXPECT_EQ(pairs[0].other, 0u);
    ASSERT_EQ(pairs[0].matches.size(), places.size());
    EXPECT_EQ(pairs[0].matches[7].one, places[7]);
    EXPECT_EQ(pairs[0].matches[7].other, places[7]);
}

// Whatever is wrong with it: a sentence, or other matches.
TEST(PhotosDatabase, DamagedOnesAreASentence) {
    const std::string whole =
        DatabaseWriter().bytes(test::colmap_tables({"a.jpg", "b.jpg", "c.jpg"}, many_places()));
    const PhotoFolder photos = three_photos();
    EXPECT_EQ(sift_matches_in(opened(whole), "a.db", photos).size(), 2u);
    EXPECT_THROW(opened(""), Error);
    EXPECT_THROW(opened("SQLite format 3"), Error);
    EXPECT_THROW(opened("a.jpg\nb.jpg\n" + std::string(1000, 'x')), Error);
    Random random(7);
    for (int i = 0; i < 300; i++) {
        const std::string cut = whole.substr(0, random.below(static_cast<uint32_t>(whole.size())));
        EXPECT_THROW(sift_matches_in(opened(cut), "a.db", photos), Error) << cut.size();
    }
    size_t refused = 0;
    for (int i = 0; i < 3000; i++) {
        std::string other = whole;
        for (int k = 0; k < 3; k++)
            other[random.below(static_cast<uint32_t>(i % 2 ? other.size() : 2048))] =
                static_cast<char>(random.below(256));
        try {
            sift_matches_in(opened(other), "a.db", photos);
        } catch (const Error& error) {
            refused++;
            EXPECT_NE(std::string(error.what()).find("a.db"), std::string::npos);
        }
    }
    EXPECT_GT(refused, 100u);
}

}  // namespace
}  // namespace treerec
