// How well a tree explains a scan, as `treerec score` tells it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "completion/unexplained.h"
#include "fidelity/doubtful.h"
#include "fidelity/fidelity.h"
#include "fidelity/photo_judge.h"
#include "fidelity/photo_overlap.h"
#include "fidelity/score.h"
#include "progress.h"
#include "scan/point_cloud.h"
#include "tree/tree.h"

namespace treerec {

// photos, outline and source: where photos judge, too.
struct ScanReport {
    ScanScore score;
    Fidelity fidelity;
    std::vector<LevelFidelity> levels;
    std::vector<UnexplainedCluster> unexplained;
    std::vector<DoubtfulBranch> doubtful;
    std::optional<PhotoFidelity> photos;
    std::optional<OutlineOverlap> outline;
    OutlineSource source = OutlineSource::kMasks;
    double noise = 0.0;
};

// All but what photos tell. cloud: in any frame. noise: the scan's, metres. levels: how many, each of half
// the nodes of the one before; 1: the tree alone. Throws Error, or Cancelled.
void score_against_scan(ScanReport& report, const Tree& tree, const PointCloud& cloud, double noise,
                        const FidelityOptions& options, int levels, Progress* progress = nullptr);

// UTF-8, with the keys of `treerec score --json`.
std::string scan_report_json(const ScanReport& report, const Tree& tree);

}  // namespace treerec
