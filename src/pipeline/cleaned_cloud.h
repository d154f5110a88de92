// The cloud that a tree was made of, as a file to be looked at beside its scan.
#pragma once

#include <string>
#include <string_view>

#include "foliage/foliage.h"
#include "pipeline/reconstruct.h"
#include "pipeline/reconstruct_cache.h"
#include "progress.h"

namespace treerec {

// By what a PLY of ours is known that holds a cleaned cloud: a line in its header.
inline constexpr std::string_view kCleanedMark = "comment cleaned by treerec\n";

// Of result.cloud, where the reconstruction told leaves from wood: 1 for leaves and what grows around the
// base, 0 for wood. Else its labels stay those of the scan's file.
void label_found_leaves(Reconstruction& result);

// In the format that the extension names (scan/formats/read_cloud.h), in the scan's own coordinates, axes and
// units: to be laid over the scan. Throws Error, or Cancelled.
void write_cleaned_cloud(const std::string& path, const PointCloud& cloud,
                         const Progress* progress = nullptr);

// The cleaned cloud of a tree that was made before: its scan is read and cleaned again as load_scan() does,
// and written with all of its points. foliage: the tree's; points in its cells are labelled as leaves, unless
// the scan's file tells leaves. Throws Error with a sentence, also where `path` is the scan itself, or
// Cancelled; then nothing is written.
void save_cleaned_scan(const std::string& path, const std::string& scan, const ReconstructOptions& options,
                       const ScanFrame& frame, const Foliage& foliage, Progress* progress = nullptr,
                       ReconstructCache* cache = nullptr);

}  // namespace treerec
