#include "photos/sparse_points.h"

#include <cmath>
#include <filesystem>
#include <sstream>
#include <utility>

#include "error.h"
#include "file_bytes.h"
#include "photos/binary_reader.h"

namespace treerec {

namespace {

std::vector<SparsePoint> parse_binary(std::string_view bytes, const std::string& path) {
    BinaryReader in(path, bytes);
    const auto count = in.value<uint64_t>();
    std::vector<SparsePoint> points;
    for (uint64_t i = 0; i < count; i++) {
        SparsePoint point;
        in.skip(1, 8);  // its number
        for (int k = 0; k < 3; k++)
            point.position[k] = in.value<double>();
        for (uint8_t& channel : point.color)
            channel = in.value<uint8_t>();
        point.error = in.value<double>();
        const auto track = in.value<uint64_t>();
        for (uint64_t k = 0; k < track; k++) {
            point.photos.push_back(in.value<uint32_t>());
            in.skip(1, 4);  // the place in it
        }
        point.track = point.photos.size();
        points.push_back(std::move(point));
    }
    return points;
}

// "number x y z r g b error photo place photo place …"
std::vector<SparsePoint> parse_text(std::string_view bytes, const std::string& path) {
    std::istringstream lines{std::string(bytes)};
    std::string line;
    std::vector<SparsePoint> points;
    while (std::getline(lines, line)) {
        if (line.find_first_not_of(" \t\r") == std::string::npos || line[0] == '#') continue;
        std::istringstream in(line);
        in.imbue(std::locale::classic());
        SparsePoint point;
        uint64_t number = 0;
        in >> number >> point.position.x >> point.position.y >> point.position.z;
        for (uint8_t& channel : point.color) {
            int value = 0;
            in >> value;
            channel = static_cast<uint8_t>(value);
        }
        in >> point.error;
        if (!in)
            throw Error("The COLMAP model '" + path + "' has a line that is no point: " + quote_word(line) +
                        ".");
        uint64_t photo = 0, place = 0;
        while (in >> photo >> place)
            point.photos.push_back(static_cast<uint32_t>(photo));
        point.track = point.photos.size();
        points.push_back(std::move(point));
    }
    return points;
}

}  // namespace

std::vector<SparsePoint> parse_sparse_points(std::string_view bytes, bool text, const std::string& path) {
    std::vector<SparsePoint> points = text ? parse_text(bytes, path) : parse_binary(bytes, path);
    std::erase_if(points, [](const SparsePoint& point) { return !is_finite(point.position); });
    return points;
}

std::vector<SparsePoint> read_sparse_points(const std::string& folder, Progress* progress) {
    for (const bool text : {false, true}) {
        const std::filesystem::path path = path_of(folder) / (text ? "points3D.txt" : "points3D.bin");
        std::error_code failure;
        if (!std::filesystem::is_regular_file(path, failure)) continue;
        SubProgress reading(progress, 0.0, 0.0);
        const FileBytes bytes = read_file(utf8_of(path), &reading);
        return parse_sparse_points(bytes.view(), text, utf8_of(path));
    }
    throw Error("There are no points in '" + folder + "': it needs points3D.bin or points3D.txt.");
}

}  // namespace treerec
