#include "pipeline/sheet_photo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "error.h"
#include "file_bytes.h"
#include "photos/cameras_tell.h"
#include "photos/photo_picture.h"

namespace treerec {

namespace {

constexpr size_t kAsked = 2000;      // nodes that tell how much a photo shows of a tree
constexpr double kLeastShown = 0.1;  // of the tree
constexpr double kAlike = 0.02;      // shares of the tree that are no different
constexpr double kMargin = 0.05;     // of the tree's size in the photo, left free around it
constexpr double kLeastWidth = 0.6;  // of what is shown, to its height
constexpr double kLeastSide = 50.0, kMostSide = 130.0;  // degrees
constexpr double kPale = 0.35, kTint = 0.72;
constexpr Rgb kBoth = {38, 140, 72}, kMissing = {216, 60, 36}, kTooMuch = {36, 96, 214},
              kWood = {255, 140, 30};

struct Shown {
    size_t photo = 0;
    PinholeView view;
    double share = 0.0;   // of the tree's nodes that are in the picture
    double extent = 0.0;  // pixels: the larger side of the box around these
    DVec2 low{0.0}, high{0.0};
    DVec3 direction{0.0};  // from the tree to the camera, level
};

Shown look(const SheetSubject& subject, const PhotoModel& model, size_t i, const std::vector<NodeId>& nodes,
           const DVec3& middle) {
    const Photo& photo = model.photos[i];
    Shown shown;
    shown.photo = i;
    shown.view = pinhole_view(photo, model.cameras[static_cast<size_t>(photo.camera)], subject.tree.frame());
    const DVec2 size(shown.view.width, shown.view.height);
    DVec2 low(size), high(0.0);
    size_t inside = 0;
    for (NodeId id : nodes) {
        const Node& node = subject.tree.node(id);
        const auto at = shown.view.project(node.position);
        if (!at) continue;
        const DVec2 radius(shown.view.focal * node.radius /
                           std::max(glm::distance(node.position, shown.view.centre), 1e-6));
        // Wood whose sides are out of the picture is not shown.
        const bool whole = at->x >= radius.x && at->x < size.x - radius.x && at->y >= 0.0 && at->y < size.y;
        inside += whole;
        if (!whole && !(at->x >= 0.0 && at->y >= 0.0 && at->x < size.x && at->y < size.y)) continue;
        low = glm::min(low, *at - radius);
        high = glm::max(high, *at + radius);
    }
    if (!(high.x > low.x && high.y > low.y)) return shown;
    shown.share = static_cast<double>(inside) / static_cast<double>(nodes.size());
    const DVec2 reach = high - low;
    shown.extent = std::max(reach.x, reach.y);
    // A narrow stem is seen with something beside it.
    const double narrow = std::max(0.0, kLeastWidth * reach.y - reach.x);
    const DVec2 margin(kMargin * shown.extent + 2.0);
    shown.low = glm::max(low - margin - DVec2(0.5 * narrow, 0.0), DVec2(0.0));
    shown.high = glm::min(high + margin + DVec2(0.5 * narrow, 0.0), size);
    shown.direction = (shown.view.centre - middle) * DVec3(1.0, 0.0, 1.0);
    return shown;
}

// Best first: more of the tree, then larger.
bool is_better(const Shown& a, const Shown& b) {
    const double first = std::floor(a.share / kAlike), second = std::floor(b.share / kAlike);
    if (first != second) return first > second;
    return a.extent > b.extent;
}

std::optional<CutPhoto> cut(const SheetSubject& subject, const Shown& shown, int width, int height) {
    const SheetPhotos& photos = *subject.photos;
    const Photo& photo = photos.model.photos[shown.photo];
    const Camera& camera = photos.model.cameras[static_cast<size_t>(photo.camera)];
    const DVec2 size = shown.high - shown.low;
    if (!(size.x > 1.0 && size.y > 1.0)) return std::nullopt;
    const double scale = std::min(width / size.x, height / size.y);
    CutPhoto made;
    made.photo = photo;
    made.view = shown.view;
    made.view.focal *= scale;
    made.view.principal = scale * (shown.view.principal - shown.low);
    made.view.width = std::clamp(static_cast<int>(std::lround(scale * size.x)), 16, width);
    made.view.height = std::clamp(static_cast<int>(std::lround(scale * size.y)), 16, height);
    made.away = std::max(glm::length(shown.direction), 1e-3);
    try {
        const Image picture = read_photo(utf8_of(path_of(photos.folder) / path_of(photo.name)));
        made.picture = undistorted(picture, camera, made.view);
        // What the lens doesn't show is paper.
        Image all(camera.width, camera.height, 1);
        std::fill(all.pixels.begin(), all.pixels.end(), uint8_t{255});
        const Image seen = undistorted(all, camera, made.view);
        for (size_t i = 0; i < seen.pixels.size(); i++)
            if (seen.pixels[i] == 0)
                std::fill_n(made.picture.pixels.begin() + 3 * static_cast<ptrdiff_t>(i), 3, uint8_t{255});
    } catch (const Error&) {
        return std::nullopt;  // that a photo can't be read was said when the cloud was made
    }
    return made;
}

const OutlineMask* find_mask(const PhotoJudge* judge, const std::string& photo) {
    if (judge == nullptr) return nullptr;
    const auto found = std::find_if(judge->masks().begin(), judge->masks().end(),
                                    [&](const OutlineMask& mask) { return mask.photo.name == photo; });
    return found == judge->masks().end() ? nullptr : &*found;
}

}  // namespace

std::vector<CutPhoto> front_and_side(const SheetSubject& subject, const PhotoJudge* judge, size_t most,
                                     int width, int height, const Progress* progress) {
    std::vector<CutPhoto> found;
    if (subject.photos == nullptr) return found;
    const std::vector<NodeId> all = subject.tree.depth_first();
    std::vector<NodeId> nodes;
    DVec3 middle(0.0);
    const size_t step = std::max<size_t>(1, all.size() / kAsked);
    for (size_t i = 0; i < all.size(); i += step) {
        nodes.push_back(all[i]);
        middle += subject.tree.node(all[i]).position;
    }
    if (nodes.empty()) return found;
    middle /= static_cast<double>(nodes.size());
    std::vector<Shown> candidates;
    const PhotoModel& model = subject.photos->model;
    for (size_t i = 0; i < model.photos.size(); i++) {
        if (progress) progress->check();
        if (judge != nullptr && find_mask(judge, model.photos[i].name) == nullptr) continue;
        const Shown shown = look(subject, model, i, nodes, middle);
        if (shown.share >= kLeastShown) candidates.push_back(shown);
    }
    std::stable_sort(candidates.begin(), candidates.end(), is_better);
    DVec3 front(0.0);
    for (const Shown& candidate : candidates) {
        if (found.size() == most) break;
        if (progress) progress->check();
        if (!found.empty()) {
            const double degrees = degrees_between(front, candidate.direction);
            if (degrees < kLeastSide || degrees > kMostSide) continue;
        }
        std::optional<CutPhoto> made = cut(subject, candidate, width, height);
        if (!made) continue;
        if (found.empty()) front = candidate.direction;
        found.push_back(std::move(*made));
    }
    return found;
}

Image outline_panel(const CutPhoto& photo, std::span<const OutlinePart> parts, const PhotoJudge* judge,
                    const Progress* progress) {
    const SampleMask drawn = drawn_outline(parts, photo.view, progress);
    const OutlineMask* mask = find_mask(judge, photo.photo.name);
    const bool by_sky = judge != nullptr && judge->source() == OutlineSource::kSky;
    // Both look the same way, with other focal lengths.
    PinholeView other;
    if (mask != nullptr) other = fitted(pinhole_view(mask->photo, mask->camera, {}), mask->longest);
    const auto is_tree = [&](int x, int y) {
        const DVec2 at = (DVec2(x + 0.5, y + 0.5) - photo.view.principal) * (other.focal / photo.view.focal) +
                         other.principal;
        const int column = static_cast<int>(std::floor(at.x)), row = static_cast<int>(std::floor(at.y));
        if (column < 0 || row < 0 || column >= mask->mask.width || row >= mask->mask.height) return false;
        return *mask->mask.at(column, row) >= 128;
    };
    Image panel = photo.picture;
    for (int y = 0; y < panel.height; y++)
        for (int x = 0; x < panel.width; x++) {
            const double model =
                static_cast<double>(drawn.covered(x, y)) / (SampleMask::kSamples * SampleMask::kSamples);
            const bool told = mask != nullptr && is_tree(x, y);
            // What is no sky may be anything.
            const double missing = told && !by_sky ? 1.0 - model : 0.0;
            const Rgb& tint = mask == nullptr ? kWood : told ? kBoth : kTooMuch;
            uint8_t* pixel = panel.at(x, y);
            for (int k = 0; k < 3; k++) {
                const double pale = (1.0 - kPale) * pixel[k] + kPale * 255.0;
                const size_t part = static_cast<size_t>(k);
                const double tinted = model * tint[part] + missing * kMissing[part];
                const double share = kTint * (model + missing);
                const double mixed =
                    share > 0.0 ? (1.0 - share) * pale + share * tinted / (model + missing) : pale;
                pixel[k] = static_cast<uint8_t>(std::lround(mixed));
            }
        }
    return panel;
}

}  // namespace treerec
