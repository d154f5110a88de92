#include "fidelity/silhouette.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "error.h"
#include "fidelity/sample_mask.h"
#include "geometry/parallel.h"
#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr int kSamples = SampleMask::kSamples;

// One view's picture plane: x to the right, y up, in metres.
struct View {
    double right_x = 1.0, right_z = 0.0;
    DVec2 least{0.0};
    double sample = 1.0;        // metres between two samples
    int width = 0, height = 0;  // in pixels

    DVec2 project(const Vec3& p) const { return {right_x * p.x + right_z * p.z, p.y}; }
};

SampleMask draw(const View& view, const Mesh& mesh, const Progress* progress) {
    SampleMask mask(view.width, view.height);
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        if (progress && i % 65536 == 0) progress->check();
        DVec2 corners[3];
        for (int k = 0; k < 3; k++)
            corners[k] = (view.project(mesh.positions[mesh.indices[i + k]]) - view.least) / view.sample;
        mask.fill(corners);
    }
    return mask;
}

std::array<View, 4> views_of(const Mesh& before, const Mesh& after, int pixels) {
    std::array<View, 4> views;
    std::array<DVec2, 4> most;
    double longest = 0.0;
    for (size_t v = 0; v < views.size(); v++) {
        const double azimuth = static_cast<double>(v) * std::numbers::pi / 4.0;
        views[v].right_x = portable::cos(azimuth);
        views[v].right_z = portable::sin(azimuth);
        views[v].least = DVec2(INFINITY);
        most[v] = DVec2(-INFINITY);
        for (const Mesh* mesh : {&before, &after})
            for (uint32_t index : mesh->indices) {
                const DVec2 p = views[v].project(mesh->positions[index]);
                views[v].least = glm::min(views[v].least, p);
                most[v] = glm::max(most[v], p);
            }
        if (most[v].y < views[v].least.y) views[v].least = most[v] = DVec2(0.0);
        const DVec2 size = most[v] - views[v].least;
        longest = std::max({longest, size.x, size.y});
    }
    for (size_t v = 0; v < views.size(); v++) {
        View& view = views[v];
        const double pixel = longest > 0.0 ? longest / pixels : 1.0;
        const DVec2 size = (most[v] - view.least) / pixel;
        view.sample = pixel / kSamples;
        view.width = std::clamp(static_cast<int>(std::ceil(size.x)), 1, pixels);
        view.height = std::clamp(static_cast<int>(std::ceil(size.y)), 1, pixels);
    }
    return views;
}

double share(double part, double whole) {
    return whole > 0.0 ? part / whole : 0.0;
}

}  // namespace

double SilhouetteView::share_of_silhouette() const {
    return share(differing, 0.5 * (before + after + differing));
}

double SilhouetteView::share_of_picture() const {
    return share(differing, pixels);
}

SilhouetteView SilhouetteChange::all() const {
    SilhouetteView sum;
    for (const SilhouetteView& view : views) {
        sum.pixels += view.pixels;
        sum.before += view.before;
        sum.after += view.after;
        sum.differing += view.differing;
    }
    return sum;
}

SilhouetteChange compare_silhouettes(const Mesh& before, const Mesh& after, int pixels,
                                     const Progress* progress) {
    if (pixels < 16 || pixels > 4096) throw Error("A silhouette is drawn with 16 to 4096 pixels.");
    const std::array<View, 4> views = views_of(before, after, pixels);
    SilhouetteChange change;
    parallel_for(views.size(), 1, [&](size_t begin, size_t end) {
        for (size_t v = begin; v < end; v++) {
            const SampleMask first = draw(views[v], before, progress);
            const SampleMask second = draw(views[v], after, progress);
            SilhouetteView& view = change.views[v];
            const int width = views[v].width, height = views[v].height;
            int64_t covered_before = 0, covered_after = 0, differing = 0;
            for (int y = 0; y < height; y++)
                for (int x = 0; x < width; x++) {
                    const int a = first.covered(x, y), b = second.covered(x, y);
                    covered_before += a;
                    covered_after += b;
                    differing += std::abs(a - b);
                }
            constexpr double kPerPixel = kSamples * kSamples;
            view = {static_cast<double>(width) * height, static_cast<double>(covered_before) / kPerPixel,
                    static_cast<double>(covered_after) / kPerPixel,
                    static_cast<double>(differing) / kPerPixel};
        }
    });
    return change;
}

}  // namespace treerec
