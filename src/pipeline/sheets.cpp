#include "pipeline/sheets.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "error.h"
#include "pipeline/histogram_svg.h"
#include "pipeline/sheet_photo.h"
#include "tree/measure.h"

namespace treerec {

namespace {

constexpr int kWidth = 400, kHeight = 540;  // that a panel fits into
constexpr Rgb kRaw = {84, 104, 132};
constexpr int kLeast = 260;  // pixels of a side

struct LevelSize {
    int width = 0, height = 0;
    double scale = 1.0;  // metres per pixel
};

// Of pictures that show a box from its sides: no wider or higher than it asks for.
LevelSize level_size(const Bounds& box, int most_width) {
    const DVec3 size = box.size();
    const double slender = size.y / std::max({size.x, size.z, 1e-3});
    LevelSize made;
    made.width = static_cast<int>(std::clamp(kHeight / slender, double(kLeast), double(most_width)));
    made.height = static_cast<int>(std::clamp(made.width * slender, double(kLeast), double(kHeight)));
    made.scale = fitting_scale(box, made.width, made.height);
    return made;
}

void check_wood(const Tree& tree) {
    if (tree.size() < 2) throw Error("The tree has no wood: it needs at least two nodes.");
}

std::string size_of(const Tree& tree) {
    const Measurements measured = measure(tree);
    std::string words = "height " + fixed(measured.height, 2) + " m";
    if (measured.dbh > 0.0) words += ", trunk " + fixed(100.0 * measured.dbh, 1) + " cm (DBH)";
    return words + ", " + fixed(measured.total_length, 0) + " m of wood, " + std::to_string(measured.nodes) +
           " nodes";
}

int widest(const std::vector<Panel>& row) {
    int width = 0;
    for (const Panel& panel : row)
        width = std::max(width, panel.image.width);
    return width;
}

std::string bound(const char* name, bool upper) {
    return upper ? std::string(name) + ", at most" : std::string(name);
}

void add_figures(const SheetFidelity& figures, Sheet& sheet) {
    const auto add = [&](double value, const std::string& name) {
        sheet.figures.push_back({fixed(value, 3), name});
    };
    const double tolerance = 100.0 * figures.fidelity.tolerance;
    if (figures.judge == nullptr) {
        add(figures.fidelity.skeleton, "R_s, points in the wood");
        add(figures.fidelity.all.explained, "explained");
        add(figures.fidelity.all.coverage, "bark seen");
        sheet.figures.push_back({fixed(1000.0 * figures.fidelity.all.median, 1) + " mm", "median distance"});
        sheet.notes.push_back("Points count as in the wood, or explained, up to " + fixed(tolerance, 0) +
                              " cm beside it. Without photos there is no Q: I and R_3d would be made up.");
        return;
    }
    const PhotoFidelity& photos = figures.judge->cloud();
    const bool sky = figures.judge->source() == OutlineSource::kSky;
    add(modelling_fidelity(photos, figures.fidelity), bound("Q = I x R_3d x R_s", sky));
    add(photos.information, "I, what the photos can tell");
    add(photos.reconstruction, bound("R_3d, points on the tree", sky));
    add(figures.fidelity.skeleton, "R_s, points in the wood");
    if (figures.outline != nullptr) {
        const Overlap& mean = figures.outline->mean;
        add(mean.precision, bound("outline precision", sky));
        if (!sky) {
            add(mean.recall, "outline recall");
            add(mean.iou, "outline IoU");
        }
    }
    const std::string count = std::to_string(photos.photos.size());
    sheet.notes.push_back(
        sky ? "By the sky of " + count +
                  " photos: what lies on the sky is wrong for sure (blue), what lies on anything else may be "
                  "right (green). Precision only: what is missing is not seen without masks."
            : "By masks of " + count +
                  " photos. Green: tree and mask; red: mask alone, missing; blue: tree alone, too much.");
    sheet.notes.push_back("Points count as in the wood up to " + fixed(tolerance, 0) + " cm beside it.");
}

}  // namespace

Image stages_sheet(const SheetSubject& subject, const Progress* progress) {
    check_wood(subject.tree);
    const Bounds box = box_of(subject.tree, subject.parts, subject.cloud);
    const bool pruned = subject.raw != nullptr && subject.raw->size() > 1;
    Sheet sheet;
    sheet.title = subject.name;
    sheet.subtitle = size_of(subject.tree);
    const std::vector<CutPhoto> photos = front_and_side(subject, nullptr, 1, kWidth, kHeight, progress);
    std::vector<Panel> stages;
    std::optional<PanelView> view;
    if (!photos.empty()) {
        view = PanelView::photo(photos[0].view, photos[0].away);
        stages.push_back({photos[0].picture, "Photo"});
    } else {
        const LevelSize level = level_size(box, kWidth);
        view = PanelView::level(box, 0.0, level.width, level.height, level.scale);
    }
    stages.push_back({cloud_panel(*view, subject.cloud, progress), "Point cloud"});
    if (pruned) stages.push_back({skeleton_panel(*view, *subject.raw, &kRaw, progress), "First skeleton"});
    stages.push_back(
        {skeleton_panel(*view, subject.tree, nullptr, progress), pruned ? "Pruned skeleton" : "Skeleton"});
    if (photos.empty()) stages.push_back({tree_panel(*view, subject.parts, subject.bark, progress), "Tree"});
    const LevelSize level = level_size(box, std::max(widest(stages), kLeast));
    std::vector<Panel> views;
    const char* const names[] = {"Front (+Z)", "Right (+X)", "Back (-Z)", "Left (-X)"};
    for (int side = 0; side < 4; side++) {
        const PanelView from =
            PanelView::level(box, 0.5 * kPi * side, level.width, level.height, level.scale);
        views.push_back({tree_panel(from, subject.parts, subject.bark, progress), names[side]});
    }
    sheet.rows = {std::move(stages), std::move(views)};
    return lay_out(sheet);
}

Image fidelity_sheet(const SheetSubject& subject, const SheetFidelity& figures, const Progress* progress) {
    check_wood(subject.tree);
    Sheet sheet;
    sheet.title = subject.name;
    sheet.subtitle = size_of(subject.tree);
    const char* const sides[] = {"front", "side"};
    const std::vector<CutPhoto> photos = front_and_side(subject, figures.judge, 2, kWidth, kHeight, progress);
    for (size_t i = 0; i < photos.size(); i++) {
        const PanelView view = PanelView::photo(photos[i].view, photos[i].away);
        const std::string from = std::string(", ") + sides[i];
        sheet.rows.push_back(
            {{photos[i].picture, "Photo" + from},
             {outline_panel(photos[i], subject.parts, figures.judge, progress), "Outline" + from},
             {cloud_panel(view, subject.cloud, progress), "Point cloud" + from},
             {tree_panel(view, subject.parts, subject.bark, progress), "Tree" + from}});
    }
    if (photos.empty()) {
        const Bounds box = box_of(subject.tree, subject.parts, subject.cloud);
        const LevelSize level = level_size(box, kWidth);
        for (int i = 0; i < 2; i++) {
            const PanelView view =
                PanelView::level(box, 0.5 * kPi * i, level.width, level.height, level.scale);
            const std::string from = std::string(", ") + sides[i];
            sheet.rows.push_back(
                {{cloud_panel(view, subject.cloud, progress), "Point cloud" + from},
                 {heat_panel(view, figures.wood, figures.fidelity, progress), "Distance to the bark" + from},
                 {skeleton_panel(view, subject.tree, nullptr, progress), "Skeleton" + from},
                 {tree_panel(view, subject.parts, subject.bark, progress), "Tree" + from}});
        }
    }
    add_figures(figures, sheet);
    if (photos.empty())
        sheet.notes.push_back(
            "Blue points lie on the bark, pale ones at that distance, red ones at three times of it or "
            "beyond.");
    return lay_out(sheet);
}

Image tree_picture(const Tree& tree, std::span<const OutlinePart> parts, const Progress* progress) {
    check_wood(tree);
    const Bounds box = box_of(tree, parts, {});
    const LevelSize level = level_size(box, kWidth);
    return tree_panel(PanelView::level(box, 0.0, level.width, level.height, level.scale), parts, kPanelBark,
                      progress);
}

}  // namespace treerec
