// What the fuzz targets share: damaged bytes give an Error or something sound, nothing else.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "error.h"
#include "geometry/parallel.h"
#include "scan/formats/read_cloud.h"
#include "tree/tree.h"

namespace treerec::fuzz {

inline void require(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "fuzz: not so: %s\n", what);
    std::abort();
}

// A sentence for a user: ended, and without what the terminal would obey.
inline void require_sentence(const Error& error) {
    const std::string text = error.what();
    bool sound = text.size() > 3 && text.size() < 1000 && (text.back() == '.' || text.back() == '?');
    for (const char c : text)
        sound = sound && c >= ' ' && c <= '~';
    require(sound, ("the error is a sentence: " + text).c_str());
}

inline int read_cloud_of(const uint8_t* data, size_t size, const char* name) {
    set_thread_count(1);
    try {
        ReadCloudReport report;
        const PointCloud cloud =
            read_cloud_bytes(name, {reinterpret_cast<const char*>(data), size}, {}, &report);
        require(!cloud.empty(), "a cloud that was read has points");
        require(cloud.colors.empty() || cloud.colors.size() == cloud.size(), "colours are one each");
        require(cloud.normals.empty() || cloud.normals.size() == cloud.size(), "normals are one each");
        require(is_finite(cloud.frame.origin), "the origin is finite");
        for (const Vec3& p : cloud.positions)
            require(is_finite(DVec3(p)), "positions are finite");
        for (const Vec3& n : cloud.normals)
            require(is_finite(DVec3(n)), "normals are finite");
        require(!report.format.empty(), "the format is named");
    } catch (const Error& error) {
        require_sentence(error);
    }
    return 0;
}

template <typename Parse>
int read_tree_of(const uint8_t* data, size_t size, Parse parse) {
    try {
        const Tree tree =
            parse(std::string_view(reinterpret_cast<const char*>(data), size), "a file", UpAxis::kZ, nullptr);
        require(tree.check() == std::nullopt, "a tree that was read is sound");
    } catch (const Error& error) {
        require_sentence(error);
    }
    return 0;
}

}  // namespace treerec::fuzz
