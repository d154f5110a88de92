// PCD 0.6 and 0.7: R. B. Rusu, "The PCD (Point Cloud Data) file format", Point Cloud Library.
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "scan/formats/readers.h"

namespace treerec {

namespace {

constexpr size_t kBlock = 16384;

struct Field {
    std::string name;
    size_t size = 4;
    char kind = 'F';  // F, I or U
    size_t count = 1;
};

struct PcdHeader {
    std::vector<Field> fields;
    uint64_t points = 0;
    std::string data;  // "ascii", "binary", "binary_compressed"
    size_t end = 0;    // where the data begin
    size_t stride = 0;
};

// The colour packed into one value: 0xRRGGBB in the lower bytes.
struct Columns {
    std::vector<int8_t> roles;  // by field
    int packed_color = -1;      // field

    // Of the cloud: what all fields together give.
    std::vector<int8_t> cloud_roles() const {
        std::vector<int8_t> all = roles;
        if (packed_color >= 0) all.insert(all.end(), {kRoleR, kRoleG, kRoleB});
        return all;
    }
};

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    for (size_t at = line.find_first_not_of(" \t\r"); at != line.npos;) {
        const size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
        words.push_back(line.substr(at, end - at));
        at = line.find_first_not_of(" \t\r", end);
    }
    return words;
}

uint64_t whole_number(const ReadJob& job, std::string_view word, uint64_t most) {
    uint64_t value = 0;
    const std::from_chars_result result = std::from_chars(word.data(), word.data() + word.size(), value);
    if (result.ec != std::errc() || result.ptr != word.data() + word.size() || value > most)
        job.fail("has the impossible number " + quote_word(word) + " in its PCD header.");
    return value;
}

PcdHeader read_header(const ReadJob& job) {
    const std::string_view bytes = job.bytes.view();
    PcdHeader header;
    std::vector<uint64_t> sizes;
    std::vector<uint64_t> counts;
    std::string kinds;
    uint64_t width = 0;
    uint64_t height = 1;
    bool points_said = false;
    for (size_t at = 0; header.data.empty();) {
        const size_t end = bytes.find('\n', at);
        if (end == bytes.npos) job.fail("is cut off or damaged: its PCD header has no line 'DATA'.");
        const std::vector<std::string_view> words = words_of(bytes.substr(at, end - at));
        at = end + 1;
        header.end = at;
        if (words.size() < 2 || words[0].starts_with('#')) continue;
        for (size_t i = 1; i < words.size(); i++) {
            if (words[0] == "FIELDS" || words[0] == "COLUMNS")
                header.fields.push_back({std::string(words[i])});
            else if (words[0] == "SIZE")
                sizes.push_back(whole_number(job, words[i], 8));
            else if (words[0] == "TYPE")
                kinds += words[i][0];
            else if (words[0] == "COUNT")
                counts.push_back(whole_number(job, words[i], 65536));
        }
        constexpr uint64_t kMost = uint64_t{1} << 40;
        if (words[0] == "WIDTH") width = whole_number(job, words[1], kMost);
        if (words[0] == "HEIGHT") height = whole_number(job, words[1], kMost);
        if (words[0] == "POINTS") {
            header.points = whole_number(job, words[1], kMost);
            points_said = true;
        }
        if (words[0] == "DATA") header.data = words[1];
    }
    const size_t count = header.fields.size();
    if (count == 0 || sizes.size() != count || kinds.size() != count ||
        (!counts.empty() && counts.size() != count))
        job.fail("has a damaged PCD header: FIELDS, SIZE, TYPE and COUNT do not agree.");
    for (size_t i = 0; i < count; i++) {
        Field& field = header.fields[i];
        field.size = static_cast<size_t>(sizes[i]);
        field.kind = kinds[i];
        if (!counts.empty()) field.count = static_cast<size_t>(counts[i]);
        const bool whole = field.kind == 'I' || field.kind == 'U';
        const bool fits = whole ? std::has_single_bit(field.size)
                                : field.kind == 'F' && (field.size == 4 || field.size == 8);
        if (!fits) job.fail("has a field of an unknown type in its PCD header.");
        header.stride += field.size * field.count;
    }
    if (header.stride == 0) job.fail("has a damaged PCD header: its points are empty.");
    if (!points_said) header.points = height > 0 && width > (uint64_t{1} << 40) / height ? 0 : width * height;
    if (header.points == 0) job.fail("holds no points.");
    return header;
}

PlyType type_of(const Field& field) {
    if (field.kind == 'F') return field.size == 8 ? PlyType::kDouble : PlyType::kFloat;
    constexpr PlyType kSigned[] = {PlyType::kInt8, PlyType::kInt16, PlyType::kInt32, PlyType::kInt64};
    constexpr PlyType kUnsigned[] = {PlyType::kUint8, PlyType::kUint16, PlyType::kUint32, PlyType::kUint64};
    const int power = std::countr_zero(field.size);
    return field.kind == 'I' ? kSigned[power] : kUnsigned[power];
}

Columns understand(const ReadJob& job, const PcdHeader& header) {
    Columns columns;
    std::vector<std::string> names;
    for (const Field& field : header.fields)
        names.push_back(field.count == 1 ? field.name : "");
    columns.roles = roles_from_names(names);
    for (const Role role : {kRoleX, kRoleY, kRoleZ})
        if (!has_role(columns.roles, role)) job.fail("is a PCD file whose points lack x, y or z.");
    for (size_t i = 0; i < names.size() && !has_role(columns.roles, kRoleR); i++)
        if ((names[i] == "rgb" || names[i] == "rgba") && header.fields[i].size == 4)
            columns.packed_color = static_cast<int>(i);
    return columns;
}

void unpack_color(uint32_t packed, Vec3& color) {
    color = Vec3((packed >> 16) & 255, (packed >> 8) & 255, packed & 255);
}

// base: of the first point's first field. stride: from point to point; 0: every field is a block of its own.
RawCloud decode(const ReadJob& job, const PcdHeader& header, const Columns& columns, const char* base,
                size_t stride) {
    const size_t count = static_cast<size_t>(header.points);
    constexpr bool kSwap = std::endian::native != std::endian::little;
    RawCloud raw;
    make_room(job, raw, count, columns.cloud_roles());
    job.parallel(count, kBlock, kFileRead, kPointsRead, [&](size_t begin, size_t end) {
        const char* first = base;
        for (size_t f = 0; f < header.fields.size(); f++) {
            const Field& field = header.fields[f];
            const size_t width = field.size * field.count;
            const size_t step = stride ? stride : width;
            const char* at = first + begin * step;
            decode_column({at, step, type_of(field), kSwap}, end - begin, columns.roles[f], begin, raw);
            if (static_cast<int>(f) == columns.packed_color)
                for (size_t i = begin; i < end; i++, at += step)
                    unpack_color(load_value<uint32_t>(at, kSwap), raw.colors[i]);
            first += stride ? width : width * count;
        }
    });
    return raw;
}

// LZF, by M. Lehmann: a control byte below 32 begins that many literals and one; others are copies of what
// was written before. True if `out` was filled exactly.
bool unpack_lzf(std::string_view in, char* out, size_t size, const Progress* progress) {
    const unsigned char* p = reinterpret_cast<const unsigned char*>(in.data());
    const unsigned char* end = p + in.size();
    size_t at = 0;
    for (size_t step = 0; p != end; step++) {
        if (progress && step % 65536 == 0) progress->check();
        const size_t control = *p++;
        if (control < 32) {
            const size_t length = control + 1;
            if (static_cast<size_t>(end - p) < length || size - at < length) return false;
            std::memcpy(out + at, p, length);
            p += length;
            at += length;
            continue;
        }
        size_t length = control >> 5;
        if (length == 7) {
            if (p == end) return false;
            length += *p++;
        }
        if (p == end) return false;
        const size_t back = ((control & 31) << 8 | *p++) + 1;
        length += 2;
        if (back > at || size - at < length) return false;
        for (size_t i = 0; i < length; i++, at++)  // they may overlap
            out[at] = out[at - back];
    }
    return at == size;
}

[[noreturn]] void fail_cut_off(const ReadJob& job, const PcdHeader& header, uint64_t found) {
    job.fail("is cut off: its header promises " + std::to_string(header.points) + " points, but it holds " +
             std::to_string(found) + "; copy it again.");
}

RawCloud read_compressed(const ReadJob& job, const PcdHeader& header, const Columns& columns) {
    constexpr bool kSwap = std::endian::native != std::endian::little;
    const std::string_view data = job.bytes.view().substr(header.end);
    if (data.size() < 8) fail_cut_off(job, header, 0);
    const size_t packed = load_value<uint32_t>(data.data(), kSwap);
    const size_t size = load_value<uint32_t>(data.data() + 4, kSwap);
    if (data.size() - 8 < packed)
        job.fail("is cut off: its header promises " + std::to_string(packed) + " bytes, but it holds " +
                 std::to_string(data.size() - 8) + "; copy it again.");
    // Three bytes unpack to 264 at most.
    if (header.points > size / header.stride || size != header.points * header.stride ||
        size / 88 > packed + 1)
        job.fail("is damaged: its compressed points have another size than its header says.");
    std::vector<char> bytes(size);
    if (!unpack_lzf(data.substr(8, packed), bytes.data(), size, job.progress))
        job.fail("is damaged: its points cannot be unpacked.");
    return decode(job, header, columns, bytes.data(), 0);
}

// A colour in text: newer files write the packed bits as a whole number, older ones as the float that has
// these bits.
uint32_t packed_color(std::string_view word, const Field& field) {
    const char* p = word.data();
    const char* end = p + word.size();
    double value = 0.0;
    if (!parse_number(p, end, value)) return 0;
    const bool whole = word.find_first_of(".eEn") == word.npos;
    if (field.kind == 'F' && !whole) {
        float bits = 0.0F;
        std::from_chars(word.data(), end, bits);
        return std::isfinite(bits) ? std::bit_cast<uint32_t>(bits) : 0U;
    }
    return value > -2147483649.0 && value < 4294967296.0 ? static_cast<uint32_t>(static_cast<int64_t>(value))
                                                         : 0U;
}

RawCloud read_ascii(const ReadJob& job, const PcdHeader& header, const Columns& columns) {
    const std::string_view bytes = job.bytes.view();
    const std::vector<int8_t> roles = columns.cloud_roles();
    size_t values = 0;
    for (const Field& field : header.fields)
        values += field.count;
    RawCloud raw;
    // A row takes two bytes per value or more, whatever the header promises.
    raw.reserve(static_cast<size_t>(
                    std::min<uint64_t>(header.points, (bytes.size() - header.end) / (2 * values) + 1)),
                roles);
    const char* p = bytes.data() + header.end;
    const char* end = bytes.data() + bytes.size();
    const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
    std::array<double, kRoleCount> row{};
    for (uint64_t i = 0; i < header.points; i++) {
        if (i % kBlock == 0)
            job.step(kFileRead +
                     (kPointsRead - kFileRead) * static_cast<double>(i) / static_cast<double>(header.points));
        Vec3 color(0.0F);
        for (size_t f = 0; f < header.fields.size(); f++) {
            for (size_t k = 0; k < header.fields[f].count; k++) {
                while (p != end && is_blank(*p))
                    p++;
                const char* begin = p;
                while (p != end && !is_blank(*p))
                    p++;
                if (begin == p) fail_cut_off(job, header, i);
                const std::string_view word(begin, static_cast<size_t>(p - begin));
                if (static_cast<int>(f) == columns.packed_color)
                    unpack_color(packed_color(word, header.fields[f]), color);
                if (columns.roles[f] == kNoRole) continue;
                double value = 0.0;
                if (!parse_number(begin, p, value))
                    job.fail("is damaged: point " + std::to_string(i + 1) + " holds " + quote_word(word) +
                             " where a number should be.");
                // "1.#QNAN" and its like.
                if (begin != p) value = std::numeric_limits<double>::quiet_NaN();
                row[static_cast<size_t>(columns.roles[f])] = value;
            }
        }
        if (columns.packed_color >= 0) {
            row[kRoleR] = color.r;
            row[kRoleG] = color.g;
            row[kRoleB] = color.b;
        }
        raw.add(row, roles);
    }
    return raw;
}

}  // namespace

bool is_pcd(std::string_view bytes) {
    if (bytes.starts_with("# .PCD") || bytes.starts_with("VERSION .") || bytes.starts_with("VERSION 0."))
        return true;
    // Other comments before the header.
    const std::string_view head = bytes.substr(0, 4096);
    return (head.starts_with('#') || head.starts_with("FIELDS")) && head.find("\nFIELDS ") != head.npos &&
           head.find("\nDATA ") != head.npos;
}

RawCloud read_pcd(const ReadJob& job) {
    const PcdHeader header = read_header(job);
    const Columns columns = understand(job, header);
    job.report.format = "PCD " + header.data;
    RawCloud raw;
    if (header.data == "ascii") {
        raw = read_ascii(job, header, columns);
    } else if (header.data == "binary") {
        const uint64_t found = (job.bytes.size - header.end) / header.stride;
        if (found < header.points) fail_cut_off(job, header, found);
        raw = decode(job, header, columns, job.bytes.view().data() + header.end, header.stride);
    } else if (header.data == "binary_compressed") {
        raw = read_compressed(job, header, columns);
    } else {
        job.fail("has the unknown PCD data format " + quote_word(header.data) + ".");
    }
    if (columns.packed_color >= 0) raw.color_white = 255.0F;
    for (size_t f = 0; f < header.fields.size(); f++)
        if (columns.roles[f] == kRoleLabel) raw.label_column = header.fields[f].name;
    return raw;
}

}  // namespace treerec
