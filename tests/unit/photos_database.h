// SQLite databases, written as its file format says: every row on a page of its own, below one that lists
// them.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "geometry/vec.h"

namespace treerec::test {

struct Cell {
    enum { kNull, kInteger, kText, kBlob } kind = kNull;
    int64_t integer = 0;
    std::string bytes;

    static Cell number(int64_t value) { return {kInteger, value, ""}; }
    static Cell text(const std::string& value) { return {kText, 0, value}; }
    static Cell blob(const std::string& value) { return {kBlob, 0, value}; }
};

struct Row {
    int64_t key = 0;
    std::vector<Cell> cells;
};

struct Table {
    std::string name;
    std::vector<Row> rows;
};

class DatabaseWriter {
  public:
    static constexpr size_t kPage = 512;

    std::string bytes(const std::vector<Table>& tables) {
        pages_.assign(1, "");
        std::vector<Row> schema;
        for (const Table& table : tables)
            schema.push_back(
                {static_cast<int64_t>(schema.size() + 1),
                 {Cell::text("table"), Cell::text(table.name), Cell::text(table.name),
                  Cell::number(static_cast<int64_t>(tree_of(table.rows))), Cell::text("CREATE TABLE")}});
        std::string head("SQLite format 3\0", 16);
        head += big(kPage, 2) + std::string("\x02\x02\x00\x40\x20\x20", 6);
        head.resize(56, '\0');
        head += big(1, 4);
        head.resize(100, '\0');
        pages_[0] = leaf(schema, head);
        std::string all;
        for (const std::string& page : pages_)
            all += page;
        return all;
    }

  private:
    static std::string big(uint64_t value, int count) {
        std::string bytes;
        for (int i = count; i-- > 0;)
            bytes += static_cast<char>(value >> 8 * i & 0xFF);
        return bytes;
    }
    static std::string variable(uint64_t value) {
        if (value >> 56) {
            std::string nine(1, static_cast<char>(value & 0xFF));
            value >>= 8;
            for (int i = 0; i < 8; i++, value >>= 7)
                nine.insert(nine.begin(), static_cast<char>((value & 0x7F) | 0x80));
            return nine;
        }
        std::string bytes(1, static_cast<char>(value & 0x7F));
        while (value >>= 7)
            bytes.insert(bytes.begin(), static_cast<char>((value & 0x7F) | 0x80));
        return bytes;
    }
    size_t add(std::string page) {
        page.resize(kPage, '\0');
        pages_.push_back(std::move(page));
        return pages_.size();
    }
    static std::string record(const Row& row) {
        std::string kinds, body;
        for (const Cell& cell : row.cells)
            if (cell.kind == Cell::kNull) {
                kinds += variable(0);
            } else if (cell.kind == Cell::kInteger) {
                const bool small = cell.integer >= -128 && cell.integer < 128;
                kinds += variable(small ? 1 : 6);
                body += big(static_cast<uint64_t>(cell.integer), small ? 1 : 8);
            } else {
                kinds += variable(2 * cell.bytes.size() + (cell.kind == Cell::kText ? 13 : 12));
                body += cell.bytes;
            }
        // The length counts itself.
        const size_t own = kinds.size() + 1 < 128 ? 1 : 2;
        return variable(kinds.size() + own) + kinds + body;
    }
    std::string cell_of(const Row& row) {
        const std::string whole = record(row),
                          begin = variable(whole.size()) + variable(static_cast<uint64_t>(row.key));
        const size_t most = kPage - 35;
        if (whole.size() <= most) return begin + whole;
        const size_t least = (kPage - 12) * 32 / 255 - 23,
                     rest = least + (whole.size() - least) % (kPage - 4);
        const size_t here = rest <= most ? rest : least;
        size_t next = 0;
        const size_t over = whole.size() - here, parts = (over + kPage - 5) / (kPage - 4);
        for (size_t i = parts; i-- > 0;)
            next = add(big(next, 4) + whole.substr(here + i * (kPage - 4), kPage - 4));
        return begin + whole.substr(0, here) + big(next, 4);
    }
    std::string leaf(const std::vector<Row>& rows, const std::string& head) {
        std::string cells, list;
        for (const Row& row : rows) {
            cells = cell_of(row) + cells;
            list += big(kPage - cells.size(), 2);
        }
        std::string page =
            head + "\x0D" + big(0, 2) + big(rows.size(), 2) + big(kPage - cells.size(), 2) + big(0, 1) + list;
        page.resize(kPage - cells.size(), '\0');
        return page + cells;
    }
    // The number of its highest page.
    size_t tree_of(const std::vector<Row>& rows) {
        std::vector<std::pair<size_t, int64_t>> leaves;
        for (const Row& row : rows) {
            const std::string page = leaf({row}, "");
            leaves.emplace_back(add(page), row.key);
        }
        if (leaves.empty()) return add(leaf({}, ""));
        std::string cells, list;
        for (size_t i = 0; i + 1 < leaves.size(); i++) {
            cells = big(leaves[i].first, 4) + variable(static_cast<uint64_t>(leaves[i].second)) + cells;
            list += big(kPage - cells.size(), 2);
        }
        std::string page = "\x05" + big(0, 2) + big(leaves.size() - 1, 2) + big(kPage - cells.size(), 2) +
                           big(0, 1) + big(leaves.back().first, 4) + list;
        page.resize(kPage - cells.size(), '\0');
        return add(page + cells);
    }

    std::vector<std::string> pages_;
};

template <typename Number>
std::string numbers(const std::vector<Number>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number)};
}

// A database of COLMAP's: photos whose keypoints are `places`, of which each is verified to be the same one
// in all photos that follow each other.
inline std::vector<Table> colmap_tables(const std::vector<std::string>& names,
                                        const std::vector<DVec2>& places) {
    Table images{"images", {}}, keypoints{"keypoints", {}}, matches{"two_view_geometries", {}};
    std::vector<float> floats;
    std::vector<uint32_t> pairs;
    for (size_t i = 0; i < places.size(); i++) {
        for (const double value : {places[i].x, places[i].y, 1.0, 0.0, 0.0, 1.0})
            floats.push_back(static_cast<float>(value));
        pairs.insert(pairs.end(), 2, static_cast<uint32_t>(i));
    }
    const auto count = static_cast<int64_t>(places.size());
    for (size_t i = 0; i < names.size(); i++) {
        const auto number = static_cast<int64_t>(i + 1);
        images.rows.push_back({number, {Cell{}, Cell::text(names[i]), Cell::number(1)}});
        keypoints.rows.push_back(
            {number, {Cell{}, Cell::number(count), Cell::number(6), Cell::blob(numbers(floats))}});
        if (i > 0)
            matches.rows.push_back({2147483647 * (number - 1) + number,
                                    {Cell{}, Cell::number(count), Cell::number(2), Cell::blob(numbers(pairs)),
                                     Cell::number(2)}});
    }
    return {images, keypoints, matches};
}

}  // namespace treerec::test
