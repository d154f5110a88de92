// What one reconstruction leaves for the next one of the same scan, so that it begins where their options
// first differ.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scan/cleaning/clean_cloud.h"
#include "scan/formats/read_cloud.h"
#include "scan/leaves/wood_leaf.h"
#include "scan/point_cloud.h"

namespace treerec {

// A file as it was when it was looked at.
struct FileStamp {
    std::string path;
    uintmax_t size = 0;
    std::filesystem::file_time_type written;

    // Nothing for a file that can't be asked.
    static std::optional<FileStamp> of(const std::string& path);
    bool operator==(const FileStamp&) const = default;
};

// Holds copies of the cloud as it was read and as it was cleaned; a stage is set only when all before it are.
// Used by one job at a time.
struct ReconstructCache {
    struct Read {
        FileStamp file;
        ReadCloudOptions options;
        PointCloud cloud;
        ReadCloudReport report;
    };
    struct Clean {
        OrientOptions orient_options;
        CleanOptions options;
        size_t oriented = 0;  // points before the cleaning
        PointCloud cloud;
        OrientReport orient;
        CleanReport report;
        std::vector<std::string> shape_warnings;
    };
    std::optional<Read> read;
    std::optional<Clean> clean;
    std::optional<WoodLeaf> leaves;  // tell_wood_from_leaves() of the cleaned cloud

    bool has_read(const FileStamp& file, const ReadCloudOptions& options) const {
        return read && read->file == file && read->options == options;
    }
    bool has_clean(const OrientOptions& orient, const CleanOptions& options) const {
        return clean && clean->orient_options == orient && clean->options == options;
    }
    // Of all that is kept.
    size_t bytes() const;
};

}  // namespace treerec
