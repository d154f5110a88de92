#include "pipeline/compare_sheet.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "error.h"
#include "file_bytes.h"
#include "geometry/capsule_tree.h"
#include "photos/photo_picture.h"
#include "photos/pinhole_view.h"
#include "tree/wood_segments.h"

namespace treerec {

namespace {

constexpr int kRows = 2;
constexpr double kDarkened = 0.5;
constexpr double kOpaque = 0.8;
constexpr double kLeastRadius = 0.6;  // pixels: the thinnest twig is seen
const DVec3 kWood(255.0, 140.0, 30.0);

// Those that are left, the one that was taken farthest from all before it first.
std::vector<size_t> spread_out(const PhotoModel& model) {
    std::vector<size_t> order;
    std::vector<double> away(model.photos.size(), std::numeric_limits<double>::max());
    for (size_t next = 0; order.size() < model.photos.size();) {
        order.push_back(next);
        const DVec3 here = model.photos[next].centre();
        for (size_t i = 0; i < away.size(); i++)
            away[i] = std::min(away[i], glm::length(model.photos[i].centre() - here));
        away[next] = -1.0;
        next = static_cast<size_t>(std::max_element(away.begin(), away.end()) - away.begin());
    }
    return order;
}

// How much of each pixel wood covers, 0..1, rows from the top.
std::vector<double> wood_in(const Tree& tree, const PinholeView& view) {
    std::vector<double> covered(static_cast<size_t>(view.width) * static_cast<size_t>(view.height), 0.0);
    const DVec3 ahead = -view.turn[2];
    const DVec3 base = tree.node(tree.root()).position;
    for (const WoodSegment& segment : wood_segments(tree)) {
        const auto from = view.project(segment.from), to = view.project(segment.to);
        if (!from || !to) continue;
        const auto radius_of = [&](const DVec3& place, double radius) {
            return std::max(kLeastRadius, view.focal * radius / glm::dot(ahead, place - view.centre));
        };
        const bool stands = glm::distance(segment.from, base) < std::max(segment.from_radius, segment.radius);
        const double first = radius_of(segment.from, segment.from_radius);
        const double last = radius_of(segment.to, segment.radius);
        const double most = std::max(first, last) + 1.0;
        const DVec2 low = glm::min(*from, *to) - most, high = glm::max(*from, *to) + most;
        if (!(high.x > 0.0 && high.y > 0.0 && low.x < view.width && low.y < view.height)) continue;
        const int left = static_cast<int>(std::max(low.x, 0.0)), top = static_cast<int>(std::max(low.y, 0.0));
        const int right = static_cast<int>(std::min(high.x, view.width - 1.0));
        const int bottom = static_cast<int>(std::min(high.y, view.height - 1.0));
        const DVec2 way = *to - *from;
        const double square = glm::dot(way, way);
        for (int y = top; y <= bottom; y++)
            for (int x = left; x <= right; x++) {
                const DVec2 p(x + 0.5, y + 0.5);
                const double along = square > 0.0 ? glm::dot(p - *from, way) / square : 0.0;
                // Branches go on from one another by round ends; these would reach below the base.
                if (stands && along < 0.0) continue;
                const double t = std::clamp(along, 0.0, 1.0);
                const double beside = glm::length(p - *from - t * way) - (first + t * (last - first));
                double& here = covered[static_cast<size_t>(y) * static_cast<size_t>(view.width) +
                                       static_cast<size_t>(x)];
                here = std::max(here, std::clamp(0.5 - beside, 0.0, 1.0));
            }
    }
    return covered;
}

// A photo, and it again with the wood on it.
struct Compared {
    Image photo;
    std::vector<double> wood;
};

void put(const Compared& compared, int left, int top, Image& sheet) {
    const Image& photo = compared.photo;
    for (int y = 0; y < photo.height; y++)
        for (int x = 0; x < photo.width; x++) {
            const double wood =
                kOpaque *
                compared
                    .wood[static_cast<size_t>(y) * static_cast<size_t>(photo.width) + static_cast<size_t>(x)];
            for (int k = 0; k < 3; k++) {
                const uint8_t seen = photo.at(x, y)[k];
                sheet.at(left + x, top + y)[k] = seen;
                sheet.at(left + photo.width + x, top + y)[k] =
                    static_cast<uint8_t>(std::lround((1.0 - wood) * kDarkened * seen + wood * kWood[k]));
            }
        }
}

}  // namespace

Image compare_sheet(const Tree& tree, const PhotoModel& model, const std::string& folder,
                    const CompareSheetOptions& options, const Progress* progress) {
    std::vector<Compared> all;
    for (const size_t i : spread_out(model)) {
        if (all.size() == options.photos) break;
        if (progress) progress->check();
        const Photo& photo = model.photos[i];
        const Camera& camera = model.cameras[static_cast<size_t>(photo.camera)];
        try {
            const PinholeView view = fitted(pinhole_view(photo, camera, tree.frame()), options.longest);
            const Image picture = read_photo(utf8_of(path_of(folder) / path_of(photo.name)));
            all.push_back({undistorted(picture, camera, view), wood_in(tree, view)});
        } catch (const Error&) {
            continue;  // that a photo can't be read was said when the cloud was made
        }
    }
    if (all.empty()) throw Error("None of the photos in '" + folder + "' can be read.");
    const int count = static_cast<int>(all.size());
    const int columns = (count + kRows - 1) / kRows, rows = (count + columns - 1) / columns;
    int width = 0, height = 0;
    for (const Compared& compared : all) {
        width = std::max(width, 2 * compared.photo.width);
        height = std::max(height, compared.photo.height);
    }
    Image sheet(columns * width, rows * height, 3);
    for (int i = 0; i < count; i++)
        put(all[static_cast<size_t>(i)], i % columns * width, i / columns * height, sheet);
    return sheet;
}

}  // namespace treerec
