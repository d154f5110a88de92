#include "photos/sqlite_tables.h"

#include <algorithm>
#include <bit>
#include <filesystem>
#include <utility>

#include "error.h"

namespace treerec {

namespace {

constexpr std::string_view kMagic("SQLite format 3\0", 16);
constexpr size_t kHeader = 100;  // bytes before the first page's own
constexpr int kDeepest = 24;     // pages above each other: far more than any file has
constexpr uint64_t kInner = 5;   // kinds of pages
constexpr uint64_t kLeaf = 13;

}  // namespace

SqliteTables::SqliteTables(const std::string& path) : path_(path), file_(read_file(path)) {
    std::error_code failure;
    const auto newest = std::filesystem::file_size(path_of(path + "-wal"), failure);
    if (!failure && newest > 0)
        throw Error("The database '" + path + "' was not closed; run the same command again.");
    check_header();
}

SqliteTables::SqliteTables(const std::string& path, FileBytes bytes) : path_(path), file_(std::move(bytes)) {
    check_header();
}

void SqliteTables::fail() const {
    throw Error("The database '" + path_ + "' is damaged; delete it, and run the same command again.");
}

void SqliteTables::check_header() {
    if (file_.size < kHeader || file_.view().substr(0, 16) != kMagic) fail();
    page_size_ = static_cast<size_t>(number(16, 2));
    if (page_size_ == 1) page_size_ = 65536;
    if (page_size_ < 512 || !std::has_single_bit(page_size_) || file_.size < page_size_) fail();
    usable_ = page_size_ - static_cast<size_t>(number(20, 1));
    const uint64_t encoding = number(56, 4);
    if (usable_ < 480 || encoding != 1) fail();
}

// Big-endian.
uint64_t SqliteTables::number(size_t at, size_t bytes) const {
    if (at > file_.size || bytes > file_.size - at) fail();
    uint64_t value = 0;
    for (size_t i = 0; i < bytes; i++)
        value = value << 8 | static_cast<unsigned char>(file_.data[at + i]);
    return value;
}

size_t SqliteTables::start_of(uint32_t page) const {
    if (page == 0 || page > file_.size / page_size_) fail();
    return static_cast<size_t>(page - 1) * page_size_;
}

// Seven bits in each byte but the ninth.
uint64_t SqliteTables::variable(std::string_view bytes, size_t& at) const {
    uint64_t value = 0;
    for (int i = 0; i < 9; i++) {
        if (at >= bytes.size()) fail();
        const auto byte = static_cast<unsigned char>(bytes[at++]);
        if (i == 8) return value << 8 | byte;
        value = value << 7 | (byte & 0x7F);
        if (byte < 0x80) break;
    }
    return value;
}

// What begins at `at` and goes on in other pages where the page's end is too near. whole: holds it then.
std::string_view SqliteTables::payload(size_t at, size_t end, uint64_t size, std::string& whole) const {
    const std::string_view file = file_.view();
    if (size > file.size()) fail();
    const size_t all = static_cast<size_t>(size), most = usable_ - 35;
    if (all <= most) {
        if (at > end || all > end - at) fail();
        return file.substr(at, all);
    }
    const size_t least = (usable_ - 12) * 32 / 255 - 23, rest = least + (all - least) % (usable_ - 4);
    const size_t here = rest <= most ? rest : least;
    if (at > end || here + 4 > end - at) fail();
    whole.assign(file.substr(at, here));
    whole.reserve(all);
    auto next = static_cast<uint32_t>(number(at + here, 4));
    while (whole.size() < all) {
        const size_t start = start_of(next);
        whole += file.substr(start + 4, std::min(all - whole.size(), usable_ - 4));
        next = static_cast<uint32_t>(number(start, 4));
    }
    return whole;
}

void SqliteTables::walk(uint32_t page, int depth, size_t& pages,
                        const std::function<void(int64_t, std::string_view)>& on_record) const {
    // A page that is above itself would lead around for ever.
    if (depth > kDeepest || ++pages > file_.size / page_size_) fail();
    const size_t start = start_of(page), head = start + (page == 1 ? kHeader : 0), end = start + usable_;
    const uint64_t kind = number(head, 1);
    if (kind != kInner && kind != kLeaf) fail();
    const size_t cells = static_cast<size_t>(number(head + 3, 2)), list = head + (kind == kInner ? 12 : 8);
    if (cells > usable_ / 2) fail();
    const std::string_view file = file_.view();
    std::string whole;
    for (size_t i = 0; i < cells; i++) {
        size_t at = start + static_cast<size_t>(number(list + 2 * i, 2));
        if (at >= end) fail();
        if (kind == kInner) {
            walk(static_cast<uint32_t>(number(at, 4)), depth + 1, pages, on_record);
            continue;
        }
        const std::string_view until_end = file.substr(0, end);
        const uint64_t size = variable(until_end, at);
        const auto key = static_cast<int64_t>(variable(until_end, at));
        on_record(key, payload(at, end, size, whole));
    }
    if (kind == kInner) walk(static_cast<uint32_t>(number(head + 8, 4)), depth + 1, pages, on_record);
}

void SqliteTables::parse(std::string_view record, std::vector<SqliteValue>& values) const {
    values.clear();
    size_t at = 0;
    const uint64_t head = variable(record, at);
    if (head > record.size()) fail();
    const std::string_view kinds = record.substr(0, static_cast<size_t>(head));
    size_t next = kinds.size();
    while (at < kinds.size()) {
        const uint64_t kind = variable(kinds, at);
        SqliteValue value;
        constexpr size_t kSizes[] = {0, 1, 2, 3, 4, 6, 8, 8, 0, 0};
        if (kind == 10 || kind == 11) fail();
        const uint64_t size = kind < 10 ? kSizes[kind] : (kind - 12) / 2;
        if (size > record.size() - next) fail();
        const std::string_view bytes = record.substr(next, static_cast<size_t>(size));
        next += bytes.size();
        if (kind >= 12) {
            value.kind = kind % 2 ? SqliteValue::Kind::kText : SqliteValue::Kind::kBlob;
            value.bytes = bytes;
        } else if (kind > 0) {
            uint64_t bits = kind == 9;
            // The first byte has the sign.
            if (!bytes.empty() && kind != 7 && static_cast<unsigned char>(bytes[0]) >= 0x80)
                bits = UINT64_MAX;
            for (const char byte : bytes)
                bits = bits << 8 | static_cast<unsigned char>(byte);
            value.kind = kind == 7 ? SqliteValue::Kind::kReal : SqliteValue::Kind::kInteger;
            if (kind == 7)
                value.real = std::bit_cast<double>(bits);
            else
                value.integer = static_cast<int64_t>(bits);
        }
        values.push_back(value);
    }
}

void SqliteTables::each_row(
    const std::string& table,
    const std::function<void(int64_t key, const std::vector<SqliteValue>& values)>& on_row) const {
    std::vector<SqliteValue> values;
    uint32_t root = 0;
    size_t pages = 0;
    // The first page is the list of tables: type, name, table, root page, SQL.
    walk(1, 0, pages, [&](int64_t, std::string_view record) {
        parse(record, values);
        if (values.size() < 4) fail();
        if (values[0].bytes == "table" && values[1].bytes == table && values[3].integer > 0 &&
            values[3].integer <= UINT32_MAX)
            root = static_cast<uint32_t>(values[3].integer);
    });
    if (root == 0) fail();
    pages = 0;
    walk(root, 0, pages, [&](int64_t key, std::string_view record) {
        parse(record, values);
        on_row(key, values);
    });
}

}  // namespace treerec
