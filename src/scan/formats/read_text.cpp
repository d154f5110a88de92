// Text clouds: one point per line, whatever the separator, header and order of the columns.
#include <algorithm>
#include <cstring>

#include "scan/formats/text_layout.h"

namespace treerec {

namespace {

constexpr size_t kChunk = 1 << 16;  // bytes read by one thread at a time: half a millisecond of work

// Reads one line. False unless it has a value for every role, and numbers alone where roles are.
bool parse_row(std::string_view line, const TextLayout& layout, std::array<double, kRoleCount>& row,
               size_t& columns) {
    const char* p = line.data();
    const char* end = p + line.size();
    double value = 0.0;
    bool clean = false;
    for (columns = 0; columns <= layout.last_column; columns++) {
        const char* const begin = p;
        if (!next_text_value(p, end, layout.separator, value, clean)) return false;
        const int8_t role = layout.roles[columns];
        if (role == kNoRole) continue;
        // A label may be a word.
        if (!clean && role == kRoleLabel)
            value = label_of_word(std::string_view(begin, static_cast<size_t>(p - begin)));
        else if (!clean)
            return false;
        row[static_cast<size_t>(role)] = value;
    }
    return true;
}

// The lines that begin within one stretch of the file, and what was found in them.
struct Chunk {
    size_t begin = 0;  // of its first line
    size_t first = 0;  // the point that its first row becomes
    size_t room = 0;   // no fewer than it has rows
    size_t lines = 0;
    size_t points = 0;
    size_t bad = 0;
    size_t first_bad = 0;  // line within the chunk, from 1
    uint64_t promised = 0;
    bool cut = false;
};

// Where the first line at or after `at` begins.
size_t line_start(std::string_view bytes, size_t data, size_t at) {
    if (at <= data) return data;
    const size_t end = bytes.find('\n', at - 1);
    return end == bytes.npos ? bytes.size() : end + 1;
}

size_t count_possible_rows(std::string_view bytes, const Chunk& chunk, size_t end, size_t least_length) {
    size_t rows = 0;
    TextLines lines(bytes.substr(0, end), chunk.begin);
    std::string_view line;
    while (lines.next(line))
        rows += line.size() >= least_length;
    return rows;
}

void read_chunk(std::string_view bytes, size_t end, const TextLayout& layout, size_t least_length,
                Chunk& chunk, RawCloud& raw) {
    TextLines lines(bytes.substr(0, end), chunk.begin);
    std::string_view line;
    std::array<double, kRoleCount> row{};
    while (lines.next(line)) {
        chunk.lines++;
        size_t columns = 0;
        if (parse_row(line, layout, row, columns) && line.size() >= least_length) {
            raw.set(chunk.first + chunk.points++, row);
            continue;
        }
        const std::string_view text = trimmed_text(line);
        if (text.empty() || is_text_comment(text)) continue;
        size_t numeric = 0;
        const std::vector<double> values = text_values_of(text, layout.separator, numeric);
        if (layout.promised_points && values.size() == 1 && values[0] >= 0.0 && values[0] < 1e15) {
            chunk.promised += static_cast<uint64_t>(values[0]);
        } else if (!lines.ended() && columns > 0) {
            chunk.cut = true;
        } else if (chunk.bad++ == 0) {
            chunk.first_bad = chunk.lines;
        }
    }
}

// Closes the gaps that lines without a point left.
void compact(const std::vector<Chunk>& chunks, RawCloud& raw) {
    const auto close = [&](auto& values) {
        if (values.empty()) return;
        auto to = values.begin();
        for (const Chunk& chunk : chunks) {
            const auto from = values.begin() + static_cast<std::ptrdiff_t>(chunk.first);
            const auto end = from + static_cast<std::ptrdiff_t>(chunk.points);
            to = to == from ? end : std::move(from, end, to);
        }
        values.erase(to, values.end());
    };
    close(raw.positions);
    close(raw.colors);
    close(raw.normals);
    close(raw.labels);
}

}  // namespace

RawCloud read_text(const ReadJob& job) {
    char* data = job.bytes.data.get();
    if (!std::memchr(data, '\n', job.bytes.size)) std::replace(data, data + job.bytes.size, '\r', '\n');
    const TextLayout layout = find_text_layout(job);
    const std::string_view bytes = job.bytes.view();

    // First how many rows there can be, so that every chunk knows where its points go.
    const size_t length = bytes.size() - layout.data;
    std::vector<Chunk> chunks(length / kChunk + 1);
    const auto end_of = [&](size_t i) { return i + 1 < chunks.size() ? chunks[i + 1].begin : bytes.size(); };
    for (size_t i = 0; i < chunks.size(); i++)
        chunks[i].begin = line_start(bytes, layout.data, layout.data + i * kChunk);
    const size_t least_length = layout.separator == ' ' ? 2 * layout.last_column + 1 : layout.last_column + 1;
    constexpr double kCounted = kFileRead + 0.1;
    job.parallel(chunks.size(), 1, kFileRead, kCounted, [&](size_t i, size_t) {
        chunks[i].room = count_possible_rows(bytes, chunks[i], end_of(i), least_length);
    });
    size_t room = 0;
    for (Chunk& chunk : chunks) {
        chunk.first = room;
        room += chunk.room;
    }
    RawCloud raw;
    make_room(job, raw, room, layout.roles);
    job.parallel(chunks.size(), 1, kCounted, kPointsRead, [&](size_t i, size_t) {
        read_chunk(bytes, end_of(i), layout, least_length, chunks[i], raw);
    });
    compact(chunks, raw);
    raw.label_column = layout.label_column;

    size_t lines = 0;
    size_t bad = 0;
    size_t first_bad = 0;
    uint64_t promised = layout.promised_points.value_or(0);
    for (const Chunk& chunk : chunks) {
        if (bad == 0 && chunk.bad > 0) first_bad = lines + chunk.first_bad;
        lines += chunk.lines;
        bad += chunk.bad;
        promised += chunk.promised;
    }
    if (raw.size() + bad < promised)
        job.fail("is cut off: it promises " + std::to_string(promised) + " points, but holds " +
                 std::to_string(raw.size()) + "; copy it again.");
    if (bad > 0) {
        const std::string what = std::to_string(bad) + " of its " + std::to_string(lines) +
                                 " lines are not rows of numbers like the others, the first of them line " +
                                 std::to_string(first_bad) + " of the data";
        if (bad > 10 && bad * 20 > lines) job.fail("is damaged or not a point cloud: " + what + ".");
        job.report.warnings.push_back("The file was read, but " + what + "; they were left out.");
    }
    if (std::any_of(chunks.begin(), chunks.end(), [](const Chunk& chunk) { return chunk.cut; }))
        job.report.warnings.emplace_back(
            "The last line is incomplete and was left out; the file may be cut off.");
    return raw;
}

}  // namespace treerec
