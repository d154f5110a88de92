// The scan of a tree, as TreeReconstructor reads it again: to be shown, to be pointed at, and as a file.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>

#include "convert.h"
#include "error.h"
#include "pipeline/cleaned_cloud.h"
#include "tree_reconstructor/reconstruct_options.h"
#include "tree_reconstructor/tree_reconstructor.h"
#include "tree_reconstructor/tree_reconstructor_job.h"

using namespace godot;

// The scan that a tree was made from, and how.
struct ScanOfTree {
    std::string path;
    ParsedOptions options;
};

// Throws treerec::Error where the tree does not tell.
static ScanOfTree scan_of(const TreeReconstruction& p_tree) {
    const Dictionary provenance = p_tree.get_provenance();
    const String source = provenance.get("source", "");
    if (source.is_empty()) {
        throw treerec::Error("This tree does not say which scan it was made from.");
    }
    return {file_path(source), parse_reconstruct_options(provenance.get("options", Dictionary()))};
}

bool TreeReconstructor::load_cloud(const Ref<TreeReconstruction>& p_tree, int64_t p_maximum_points) {
    ERR_FAIL_COND_V_MSG(p_tree.is_null(), false, "There is no tree whose scan could be loaded.");
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), false, BUSY);
    try {
        Listener listener(this);
        listener.check();
        const std::shared_ptr<const treerec::Tree> tree = p_tree->get_tree();
        const ScanOfTree scan = scan_of(**p_tree);
        treerec::PointCloud cloud =
            treerec::load_scan(scan.path, scan.options.pipeline, tree->frame(),
                               size_t(std::max<int64_t>(p_maximum_points, 0)), &listener, &cache_);
        listener.check();
        const std::lock_guard lock(mutex_);
        cloud_ = std::make_shared<treerec::PointCloud>(std::move(cloud));
        fraction_ = 1.0;
        return true;
    } catch (const std::exception& error) {
        _fail(error.what());
        return false;
    }
}

Error TreeReconstructor::save_cloud(const Ref<TreeReconstruction>& p_tree, const String& p_path) {
    ERR_FAIL_COND_V_MSG(p_tree.is_null(), ERR_INVALID_PARAMETER,
                        "There is no tree whose scan could be saved.");
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), ERR_BUSY, BUSY);
    try {
        Listener listener(this);
        listener.check();
        const ScanOfTree scan = scan_of(**p_tree);
        // A copy of the file for the next call would be a waste of memory, if there is none yet.
        treerec::save_cleaned_scan(file_path(p_path), scan.path, scan.options.pipeline,
                                   p_tree->get_tree()->frame(), *p_tree->get_leaf_density(), &listener,
                                   cache_.read ? &cache_ : nullptr);
        return OK;
    } catch (const std::exception& error) {
        _fail(error.what());
        return FAILED;
    }
}

PackedVector3Array TreeReconstructor::get_cloud_points() const {
    const std::lock_guard lock(mutex_);
    PackedVector3Array points;
    points.resize(int64_t(cloud_->size()));
    static_assert(sizeof(treerec::Vec3) == sizeof(Vector3));
    if (!cloud_->empty()) {
        std::memcpy(static_cast<void*>(points.ptrw()), cloud_->positions.data(),
                    cloud_->size() * sizeof(Vector3));
    }
    return points;
}

PackedColorArray TreeReconstructor::get_cloud_colors() const {
    const std::lock_guard lock(mutex_);
    PackedColorArray colors;
    colors.resize(int64_t(cloud_->colors.size()));
    Color* write = colors.ptrw();
    for (const treerec::Color8& color : cloud_->colors) {
        *write++ = Color(float(color[0]) / 255.0f, float(color[1]) / 255.0f, float(color[2]) / 255.0f);
    }
    return colors;
}

// The front of a surface is where the first points are; of those the one nearest to the line is meant.
int64_t TreeReconstructor::find_point(const PackedVector3Array& p_points, const Vector3& p_from,
                                      const Vector3& p_way, double p_width, double p_spread) {
    ERR_FAIL_COND_V_MSG(!p_way.is_finite() || !p_from.is_finite() || p_way == Vector3(), -1,
                        "The line of sight needs a place and a direction.");
    const Vector3 way = p_way.normalized();
    const int64_t count = p_points.size();
    const Vector3* points = p_points.ptr();
    // Each point's way along the line, and how far off it is, in what is allowed there.
    const auto seen = [&](int64_t p_index, double& r_along) {
        const Vector3 from_eye = points[p_index] - p_from;
        r_along = from_eye.dot(way);
        const double allowed = p_width + p_spread * r_along;
        return r_along > 0.0 && allowed > 0.0 ? double((from_eye - way * float(r_along)).length()) / allowed
                                              : 2.0;
    };
    double first = std::numeric_limits<double>::infinity(), along = 0.0;
    for (int64_t i = 0; i < count; i++) {
        if (seen(i, along) <= 1.0) {
            first = std::min(first, along);
        }
    }
    // As deep as the circle that is looked at is wide.
    const double last = first + 2.0 * (p_width + p_spread * first);
    int64_t found = -1;
    double best = 1.0;
    for (int64_t i = 0; std::isfinite(first) && i < count; i++) {
        const double off = seen(i, along);
        if (off <= best && along <= last) {
            best = off;
            found = i;
        }
    }
    return found;
}
