// PLY clouds, Gaussian splats among them.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "ply_header.h"
#include "scan/formats/readers.h"

namespace treerec {

namespace {

constexpr size_t kBlock =
    16384;  // points decoded at a time, so that the columns of a block stay in the cache

[[noreturn]] void fail_cut_off(const ReadJob& job, const PlyElement& element, uint64_t found) {
    job.fail("is cut off: its header promises " + std::to_string(element.count) + " of " +
             quote_word(element.name) + ", but it holds " + std::to_string(found) + "; copy it again.");
}

// What the vertex element offers.
struct Vertices {
    std::vector<int8_t> roles;  // by property
    std::string label_column;
    float white = 0.0F;
    bool splats = false;
};

// Gaussian splats: their colour is the first harmonic unless there are plain colours too.
bool is_splat(const PlyElement& element) {
    for (const char* name : {"f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "rot_0"})
        if (element.find(name) < 0) return false;
    return true;
}

Vertices understand(const ReadJob& job, const PlyElement& element) {
    Vertices result;
    std::vector<std::string> names;
    for (const PlyProperty& p : element.properties)
        names.push_back(p.is_list ? "" : p.name);
    result.roles = roles_from_names(names);
    if (element.find("packed_position") >= 0)
        job.fail("is a compressed Gaussian splat file, which is not read; export it as an ordinary PLY.");
    for (const Role role : {kRoleX, kRoleY, kRoleZ})
        if (!has_role(result.roles, role)) job.fail("is a PLY file whose vertices lack x, y or z.");
    if (is_splat(element)) {
        result.splats = true;
        for (int8_t& role : result.roles)
            if (role >= kRoleR) role = kNoRole;  // its normals are never filled in
        for (int k = 0; k < 3; k++)
            result.roles[static_cast<size_t>(element.find("f_dc_" + std::to_string(k)))] =
                static_cast<int8_t>(kRoleR + k);
        result.roles[static_cast<size_t>(element.find("opacity"))] = kRoleOpacity;
    }
    for (size_t i = 0; i < names.size(); i++)
        if (result.roles[i] == kRoleLabel) result.label_column = names[i];
    for (size_t i = 0; i < names.size(); i++) {
        if (result.roles[i] != kRoleR) continue;
        if (element.properties[i].type == PlyType::kUint8) result.white = 255.0F;
        if (element.properties[i].type == PlyType::kUint16) result.white = 65535.0F;
    }
    return result;
}

class BinaryReader {
  public:
    BinaryReader(const ReadJob& job, const PlyHeader& header)
        : job_(job),
          p_(job.bytes.view().data() + header.end),
          end_(job.bytes.view().data() + job.bytes.size),
          swap_(header.swaps()) {}

    void skip(const PlyElement& element) {
        if (element.properties.empty()) return;
        if (!element.has_list()) {
            take_fixed(element);
            return;
        }
        for (uint64_t i = 0; i < element.count; i++)
            walk_row(element, i, nullptr);
    }

    RawCloud read(const PlyElement& element, const Vertices& vertices) {
        RawCloud raw;
        const size_t stride = element.packed_size();
        if (element.has_list()) {
            if (element.count > static_cast<uint64_t>(end_ - p_) / stride)
                fail_cut_off(job_, element, static_cast<uint64_t>(end_ - p_) / stride);
            const size_t count = static_cast<size_t>(element.count);
            make_room(job_, raw, count, vertices.roles);
            std::vector<char> packed(kBlock * stride);
            for (size_t begin = 0; begin < count; begin += kBlock) {
                const size_t length = std::min(kBlock, count - begin);
                for (size_t i = 0; i < length; i++)
                    walk_row(element, begin + i, packed.data() + i * stride);
                decode(element, vertices, packed.data(), stride, begin, length, raw);
                job_.step(kFileRead + (kPointsRead - kFileRead) * static_cast<double>(begin) /
                                          static_cast<double>(count));
            }
            return raw;
        }
        const char* rows = take_fixed(element);
        const size_t count = static_cast<size_t>(element.count);
        make_room(job_, raw, count, vertices.roles);
        job_.parallel(count, kBlock, kFileRead, kPointsRead, [&](size_t begin, size_t end) {
            decode(element, vertices, rows + begin * stride, stride, begin, end - begin, raw);
        });
        return raw;
    }

  private:
    // The rows of an element without lists, all of them.
    const char* take_fixed(const PlyElement& element) {
        const size_t stride = element.packed_size();
        const uint64_t found = static_cast<uint64_t>(end_ - p_) / stride;
        if (found < element.count) fail_cut_off(job_, element, found);
        const char* rows = p_;
        p_ += stride * static_cast<size_t>(element.count);
        return rows;
    }

    // Moves past row `index`; copies its values that are not lists to `packed` unless that is null.
    void walk_row(const PlyElement& element, uint64_t index, char* packed) {
        if (index % kBlock == 0 && job_.progress) job_.progress->check();
        for (const PlyProperty& property : element.properties) {
            const size_t size = size_of(property.type);
            size_t length = size;
            if (property.is_list) {
                const size_t length_size = size_of(property.length_type);
                if (static_cast<size_t>(end_ - p_) < length_size) fail_cut_off(job_, element, index);
                const double items = load_ply_value(p_, property.length_type, swap_);
                p_ += length_size;
                if (!(items >= 0.0)) job_.fail("is damaged: a list in it has a negative length.");
                if (items > static_cast<double>(end_ - p_)) fail_cut_off(job_, element, index);
                length = static_cast<size_t>(items) * size;
            }
            if (static_cast<size_t>(end_ - p_) < length) fail_cut_off(job_, element, index);
            if (packed && !property.is_list) {
                std::memcpy(packed, p_, length);
                packed += length;
            }
            p_ += length;
        }
    }

    void decode(const PlyElement& element, const Vertices& vertices, const char* block, size_t stride,
                size_t begin, size_t length, RawCloud& raw) const {
        size_t offset = 0;
        for (size_t i = 0; i < element.properties.size(); i++) {
            const PlyProperty& property = element.properties[i];
            if (property.is_list) continue;
            decode_column({block + offset, stride, property.type, swap_}, length, vertices.roles[i], begin,
                          raw);
            offset += size_of(property.type);
        }
    }

    const ReadJob& job_;
    const char* p_;
    const char* end_;
    bool swap_;
};

class AsciiReader {
  public:
    AsciiReader(const ReadJob& job, const PlyHeader& header)
        : job_(job),
          p_(job.bytes.view().data() + header.end),
          end_(job.bytes.view().data() + job.bytes.size) {}

    void skip(const PlyElement& element) {
        if (element.properties.empty()) return;
        for (uint64_t i = 0; i < element.count; i++) {
            if (i % kBlock == 0 && job_.progress) job_.progress->check();
            next_line(element, i);
            to_line_end();
        }
    }

    RawCloud read(const PlyElement& element, const Vertices& vertices) {
        RawCloud raw;
        // A row takes two bytes per value or more, whatever the header promises.
        const size_t most = static_cast<size_t>(end_ - p_) / (2 * element.properties.size()) + 1;
        const size_t count = static_cast<size_t>(std::min<uint64_t>(element.count, most));
        raw.reserve(count, vertices.roles);
        std::array<double, kRoleCount> row{};
        for (uint64_t i = 0; i < element.count; i++) {
            if (i % kBlock == 0)
                job_.step(kFileRead + (kPointsRead - kFileRead) * static_cast<double>(i) /
                                          static_cast<double>(element.count));
            next_line(element, i);
            for (size_t k = 0; k < element.properties.size(); k++) {
                double items = 1.0;
                if (element.properties[k].is_list) items = value(element, i);
                if (!(items >= 0.0)) job_.fail("is damaged: a list in it has a negative length.");
                for (double item = 0.0; item < items; item += 1.0) {
                    const double number = value(element, i);
                    if (vertices.roles[k] != kNoRole) row[static_cast<size_t>(vertices.roles[k])] = number;
                }
            }
            to_line_end();
            raw.add(row, vertices.roles);
        }
        return raw;
    }

  private:
    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

    // To the first value of the next line that has one.
    void next_line(const PlyElement& element, uint64_t index) {
        while (p_ != end_ && (is_blank(*p_) || *p_ == '\n'))
            p_++;
        if (p_ == end_) fail_cut_off(job_, element, index);
    }

    void to_line_end() {
        const void* end = std::memchr(p_, '\n', static_cast<size_t>(end_ - p_));
        p_ = end ? static_cast<const char*>(end) : end_;
    }

    double value(const PlyElement& element, uint64_t index) {
        while (p_ != end_ && is_blank(*p_))
            p_++;
        if (p_ == end_) fail_cut_off(job_, element, index);
        double number = 0.0;
        if (*p_ == '\n' || !parse_number(p_, end_, number))
            job_.fail("is damaged: row " + std::to_string(index + 1) + " of " + quote_word(element.name) +
                      " does not hold the numbers that its header promises.");
        // "1.#QNAN" and its like.
        if (p_ != end_ && !is_blank(*p_) && *p_ != '\n') {
            while (p_ != end_ && !is_blank(*p_) && *p_ != '\n')
                p_++;
            number = std::numeric_limits<double>::quiet_NaN();
        }
        return number;
    }

    const ReadJob& job_;
    const char* p_;
    const char* end_;
};

// As write_cloud() has it in a comment; 0 where there is none.
double spacing_of(const PlyHeader& header) {
    for (std::string_view comment : header.comments) {
        if (!comment.starts_with(kSpacingComment)) continue;
        comment.remove_prefix(kSpacingComment.size());
        double spacing = 0.0;
        const auto [end, error] = std::from_chars(comment.data(), comment.data() + comment.size(), spacing);
        if (error == std::errc() && end == comment.data() + comment.size() && std::isfinite(spacing) &&
            spacing > 0.0)
            return spacing;
    }
    return 0.0;
}

template <typename Reader>
RawCloud read_vertices(const ReadJob& job, const PlyHeader& header) {
    Reader reader(job, header);
    for (const PlyElement& element : header.elements) {
        if (element.name != "vertex" && element.name != "vertices" && element.name != "point") {
            reader.skip(element);
            continue;
        }
        if (element.count == 0) job.fail("holds no points.");
        const Vertices vertices = understand(job, element);
        RawCloud raw = reader.read(element, vertices);
        raw.color_white = vertices.white;
        raw.label_column = vertices.label_column;
        raw.spacing = spacing_of(header);
        if (vertices.splats) {
            job.report.format += ", Gaussian splats";
            settle_splats(job, raw);
        }
        return raw;
    }
    job.fail("is a PLY file without vertices.");
}

}  // namespace

RawCloud read_ply(const ReadJob& job) {
    const PlyHeader header = read_ply_header(job.bytes.view(), job.path);
    for (const PlyElement& element : header.elements)
        if ((element.name == "face" || element.name == "tristrips") && element.count > 0)
            job.report.warnings.emplace_back("The file is a mesh; its vertices were taken for points.");
    if (header.encoding == PlyEncoding::kAscii) {
        job.report.format = "PLY ascii";
        char* bytes = job.bytes.data.get();
        if (bytes[header.end - 1] == '\r')
            std::replace(bytes + header.end, bytes + job.bytes.size, '\r', '\n');
        return read_vertices<AsciiReader>(job, header);
    }
    job.report.format =
        header.encoding == PlyEncoding::kLittle ? "PLY binary little endian" : "PLY binary big endian";
    return read_vertices<BinaryReader>(job, header);
}

}  // namespace treerec
