#include <algorithm>
#include <cmath>

#include "error.h"
#include "geometry/parallel.h"
#include "geometry/quantile.h"
#include "photos/depth_picture.h"
#include "photos/seen_bark.h"

namespace treerec {

namespace {

constexpr double kLeastCosine = 0.5;  // of the angle between the bark's normal and the view
constexpr size_t kMostGlimpses = 8;
constexpr int kDepthEdge = 480;   // pixels of the depth pictures
constexpr double kBefore = 1.05;  // how much nearer than a place wood is that hides it, as a factor
constexpr double kRough = 0.2;    // of the trunk's radius
constexpr double kMargin = 1.25;  // of branches' radii: collars and moss
constexpr size_t kCells = 64;     // that a thread takes at a time

// All wood but the stem, and the things.
DepthPicture depth_of(const Tree& tree, const std::vector<uint8_t>& is_stem, const SeenThings& things,
                      const PinholeView& whole) {
    DepthPicture wood(fitted(whole, kDepthEdge));
    const PinholeView& view = wood.view();
    const DVec3 ahead = -view.turn[2];
    for (const NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        if (node.parent == kNoNode || is_stem[static_cast<size_t>(id)]) continue;
        const DVec3 from = tree.node(node.parent).position, way = node.position - from;
        const double length = glm::length(way);
        // Balls, nearer to each other than they are thick, as far as a pixel shows it.
        const double nearest = std::max(1e-9, std::min(glm::dot(ahead, from - view.centre),
                                                       glm::dot(ahead, node.position - view.centre)));
        const double step = std::max(0.5 * node.radius, nearest / view.focal);
        const int balls = std::clamp(static_cast<int>(length / step) + 1, 1, 2000);
        for (int i = 1; i <= balls; i++) {
            const DVec3 place = from + way * (static_cast<double>(i) / balls);
            wood.put(place, kMargin * node.radius, 0.7);
        }
    }
    for (const DVec3& place : things.places)
        wood.put(place, 0.6 * things.spacing, 0.7);
    return wood;
}

// Points that are no bark of the trunk, however rough it is.
SeenThings but_the_trunk(const TrunkChart& chart, const SeenThings& things) {
    const double bark = std::max(kRough * chart.mean_radius(), 2.0 * things.spacing);
    std::vector<uint8_t> apart(things.places.size());
    parallel_for(apart.size(), 1024, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++)
            apart[i] = chart.beside(things.places[i]) > bark;
    });
    SeenThings others{{}, things.spacing};
    for (size_t i = 0; i < apart.size(); i++)
        if (apart[i]) others.places.push_back(things.places[i]);
    return others;
}

// Places where a branch leaves the stem show no bark of the stem's.
bool in_a_branch(const Tree& tree, const std::vector<NodeId>& bases, const DVec3& place) {
    for (const NodeId id : bases) {
        const Node& node = tree.node(id);
        const DVec3 from = tree.node(node.parent).position, way = node.position - from;
        const double square = glm::dot(way, way);
        const double t = square > 0.0 ? std::clamp(glm::dot(place - from, way) / square, 0.0, 1.0) : 0.0;
        if (glm::length(place - from - t * way) < kMargin * node.radius) return true;
    }
    return false;
}

}  // namespace

double BarkSurvey::usual_pixel() const {
    std::vector<double> pixels;
    for (const std::vector<Glimpse>& cell : glimpses)
        if (!cell.empty()) pixels.push_back(cell[0].pixel);
    return pixels.empty() ? 0.0 : quantile(pixels, 0.5);
}

double BarkSurvey::seen_area() const {
    size_t seen = 0;
    for (const std::vector<Glimpse>& cells_glimpses : glimpses)
        seen += !cells_glimpses.empty();
    return static_cast<double>(seen) * cell * cell;
}

BarkSurvey survey_bark(const Tree& tree, const TrunkChart& chart, const PhotoModel& model,
                       const SeenThings& things, const Progress* progress) {
    BarkSurvey survey;
    survey.cell = std::clamp(0.25 * chart.mean_radius(), 0.005, 0.04);
    survey.columns = static_cast<int>(std::ceil(chart.width() / survey.cell));
    survey.rows = static_cast<int>(std::ceil(chart.length() / survey.cell));
    const size_t cells = static_cast<size_t>(survey.columns) * static_cast<size_t>(survey.rows);
    survey.glimpses.resize(cells);
    std::vector<std::optional<TrunkChart::Spot>> spots(cells);
    std::vector<uint8_t> is_stem(static_cast<size_t>(tree.id_end()), 0);
    for (const NodeId id : chart.stem())
        is_stem[static_cast<size_t>(id)] = 1;
    std::vector<NodeId> bases;
    for (const NodeId id : chart.stem())
        for (const NodeId child : tree.children(id))
            if (!is_stem[static_cast<size_t>(child)]) bases.push_back(child);
    parallel_for(cells, kCells, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) {
            const int x = static_cast<int>(i) % survey.columns, y = static_cast<int>(i) / survey.columns;
            spots[i] = chart.at((x + 0.5) * survey.cell - 0.5 * chart.width(),
                                chart.length() - (y + 0.5) * survey.cell);
            if (spots[i] && in_a_branch(tree, bases, spots[i]->place)) spots[i].reset();
        }
    });
    const SeenThings others = but_the_trunk(chart, things);
    for (size_t p = 0; p < model.photos.size(); p++) {
        if (progress) progress->check();
        const Photo& photo = model.photos[p];
        const Camera& camera = model.cameras[static_cast<size_t>(photo.camera)];
        PinholeView view;
        try {
            view = pinhole_view(photo, camera, tree.frame());
        } catch (const Error&) {
            continue;  // a lens without a middle; such photos gave no points either
        }
        const DepthPicture wood = depth_of(tree, is_stem, others, view);
        const double scale = wood.view().focal / view.focal;
        const DVec3 ahead = -view.turn[2];
        parallel_for(cells, kCells, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; i++) {
                if (!spots[i]) continue;
                const DVec3 away = view.centre - spots[i]->place;
                const double far = -glm::dot(ahead, away);
                if (!(far > 0.0)) continue;
                const double cosine = glm::dot(spots[i]->normal, away) / glm::length(away);
                if (!(cosine > kLeastCosine)) continue;
                const auto at = camera.project(photo.to_camera(tree.frame().to_scan(spots[i]->place)));
                const double pixel = far / view.focal, margin = survey.cell / pixel + 2.0;
                if (!at || !(at->x >= margin && at->y >= margin && at->x <= camera.width - margin &&
                             at->y <= camera.height - margin))
                    continue;
                const auto straight = view.project(spots[i]->place);
                if (!straight ||
                    wood.hides(*straight * scale, 0.5 * survey.cell / pixel * scale + 0.5, far / kBefore))
                    continue;
                std::vector<Glimpse>& known = survey.glimpses[i];
                const Glimpse glimpse{p, cosine / pixel, pixel};
                auto place = known.begin();
                while (place != known.end() && place->score >= glimpse.score)
                    ++place;
                known.insert(place, glimpse);
                if (known.size() > kMostGlimpses) known.pop_back();
            }
        });
    }
    return survey;
}

}  // namespace treerec
