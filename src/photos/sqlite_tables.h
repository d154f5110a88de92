// Reads the tables of an SQLite database file, and nothing else ("Database File Format", sqlite.org):
// COLMAP's commands put features and matches in, but give none out.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "file_bytes.h"

namespace treerec {

// One value of a row.
struct SqliteValue {
    enum class Kind { kNull, kInteger, kReal, kText, kBlob } kind = Kind::kNull;
    int64_t integer = 0;
    double real = 0.0;
    std::string_view bytes;  // of a text or blob, until the next row
};

class SqliteTables {
  public:
    // Throws Error for what is no database in UTF-8, or was not closed: then its newest part is in another
    // file.
    explicit SqliteTables(const std::string& path);

    // The same from the file's contents. path: what sentences call it.
    SqliteTables(const std::string& path, FileBytes bytes);

    // Every row of a table, in the order of its key; a column that is this key is null. Throws Error where
    // there is no such table, or the file is damaged.
    void each_row(
        const std::string& table,
        const std::function<void(int64_t key, const std::vector<SqliteValue>& values)>& on_row) const;

  private:
    [[noreturn]] void fail() const;
    void check_header();
    uint64_t number(size_t at, size_t bytes) const;
    void walk(uint32_t page, int depth, size_t& pages,
              const std::function<void(int64_t, std::string_view)>& on_record) const;
    std::string_view payload(size_t at, size_t end, uint64_t size, std::string& whole) const;
    void parse(std::string_view record, std::vector<SqliteValue>& values) const;
    uint64_t variable(std::string_view bytes, size_t& at) const;
    size_t start_of(uint32_t page) const;

    std::string path_;
    FileBytes file_;
    size_t page_size_ = 0;
    size_t usable_ = 0;  // of a page
};

}  // namespace treerec
