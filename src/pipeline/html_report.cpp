#include "pipeline/html_report.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "completion/unexplained.h"
#include "fidelity/doubtful.h"
#include "fidelity/fidelity.h"
#include "fidelity/picture.h"
#include "file_bytes.h"
#include "geometry/portable_math.h"
#include "geometry/random.h"
#include "mesh/above_ground.h"
#include "mesh/branch_tubes.h"
#include "pipeline/histogram_svg.h"
#include "pipeline/html_parts.h"
#include "pipeline/html_photos.h"
#include "tree/branches.h"
#include "version.h"

namespace treerec {

namespace {

constexpr size_t kMostOrders = 6;  // in tables and histograms: the last holds all higher ones
constexpr size_t kMostListed = 8;
constexpr Rgb kBark = {139, 104, 76};
constexpr Rgb kLeaf = {118, 152, 84};
constexpr Rgb kUnjudged = {222, 227, 219};
constexpr double kLeafRadius = 0.012;  // metres

// What the page is made of.
struct Page {
    const Reconstruction& result;
    const ReportDetails& details;
    PointCloud wood;  // what the fidelity is of
    Fidelity fidelity;
    std::vector<LevelFidelity> levels;
    std::vector<UnexplainedCluster> unexplained;
    std::vector<DoubtfulBranch> doubtful;
    BranchList branches;
};

// The box of what the pictures show: of the tree, and of the cloud but for its strays.
Bounds shown(const Page& page) {
    Bounds box;
    for (NodeId id : page.result.tree.depth_first())
        box.add(page.result.tree.node(id).position, page.result.tree.node(id).radius);
    const Vec3 low(box.min - 0.1 * box.diagonal()), high(box.max + 0.1 * box.diagonal());
    for (const Vec3& p : page.result.cloud.positions)
        if (p.x > low.x && p.y > low.y && p.z > low.z && p.x < high.x && p.y < high.y && p.z < high.z)
            box.add(DVec3(p));
    return box;
}

// Of a picture's height: more for slender trees, so that all take about as much room.
int pixels_for(const Bounds& box) {
    const DVec3 size = box.size();
    const double slender = size.y / std::max({size.x, size.z, 1e-3});
    return static_cast<int>(std::clamp(560.0 * std::sqrt(slender), 380.0, 960.0));
}

// So wide that neighbours on a surface touch.
double dot_radius(const Page& page) {
    const double apart = std::sqrt(std::max(page.fidelity.all.bark, 1e-6) /
                                   static_cast<double>(std::max<size_t>(page.fidelity.points, 1)));
    return std::clamp(0.6 * apart, 0.002, 0.05);
}

// The scan's leaves, in their own colours or in greens that differ a little from place to place.
struct LeafPoints {
    std::vector<Vec3> points;
    std::vector<Rgb> colors;
};

LeafPoints leaves_of(const Reconstruction& result) {
    LeafPoints leaves;
    for (size_t i = 0; i < result.wood.size(); i++) {
        if (result.wood[i] != 0) continue;
        const Vec3& p = result.cloud.positions[i];
        leaves.points.push_back(p);
        if (result.cloud.has_colors()) {
            leaves.colors.push_back(result.cloud.colors[i]);
            continue;
        }
        const uint64_t x = std::bit_cast<uint32_t>(p.x), y = std::bit_cast<uint32_t>(p.y);
        const uint64_t hash = hash_seed(x << 32 | y, std::bit_cast<uint32_t>(p.z));
        const double light = 0.8 + 0.4 * static_cast<double>(hash >> 40) / 0x1p24;
        Rgb color;
        for (size_t c = 0; c < 3; c++)
            color[c] = static_cast<uint8_t>(std::lround(light * kLeaf[c]));
        leaves.colors.push_back(color);
    }
    return leaves;
}

std::string tree_pictures(const Page& page, const Bounds& box, Progress& progress) {
    const Tree& tree = page.result.tree;
    const Mesh bark = above_ground(build_branch_tubes(tree, {}, &progress), tree);
    const LeafPoints leaves = leaves_of(page.result);
    std::string html = "<section><h2>The tree</h2><div class=\"row two\">";
    for (const auto& [azimuth, name] : {std::pair(0.0, "Front"), std::pair(0.5 * kPi, "From the right")}) {
        Picture picture(view_of(box, azimuth, pixels_for(box)));
        picture.draw(bark, kBark, &progress);
        picture.draw(leaves.points, leaves.colors, kLeafRadius, &progress);
        html += figure(picture.finish(),
                       leaves.points.empty() ? name : std::string(name) + ", with the scan's leaves");
        progress.check();
    }
    return html + "</div></section>";
}

std::string heat_key(double tolerance) {
    std::string svg =
        "<svg class=\"heat\" viewBox=\"0 0 420 40\" role=\"img\" aria-label=\"colours of the heat "
        "map\"><defs>"
        "<linearGradient id=\"heat\">";
    for (int i = 0; i <= 16; i++) {
        const double at = i / 16.0;
        const Rgb c = heat_color(tolerance * (at < 0.5 ? 2.0 * at : 1.0 + 4.0 * (at - 0.5)), tolerance);
        svg += "<stop offset=\"" + fixed(at, 4) + "\" stop-color=\"rgb(" + std::to_string(c[0]) + "," +
               std::to_string(c[1]) + "," + std::to_string(c[2]) + ")\"/>";
    }
    svg +=
        "</linearGradient></defs><rect x=\"10\" y=\"4\" width=\"400\" height=\"12\" rx=\"3\" "
        "fill=\"url(#heat)\"/>";
    const double centimetres = 100.0 * tolerance;
    const std::pair<double, std::string> marks[] = {{10.0, "on the bark"},
                                                    {210.0, fixed(centimetres, 1) + " cm (explained)"},
                                                    {410.0, fixed(3.0 * centimetres, 1) + " cm and more"}};
    const char* const anchors[] = {"start", "middle", "end"};
    for (size_t i = 0; i < 3; i++)
        svg += "<text x=\"" + fixed(marks[i].first, 0) + "\" y=\"32\" text-anchor=\"" + anchors[i] + "\">" +
               marks[i].second + "</text>";
    return svg + "</svg>";
}

std::string heat_pictures(const Page& page, const Bounds& box, Progress& progress) {
    std::vector<Rgb> colors;
    for (float error : page.fidelity.point_error)
        colors.push_back(heat_color(std::abs(static_cast<double>(error)), page.fidelity.tolerance));
    const LeafPoints leaves = leaves_of(page.result);
    const std::vector<Rgb> pale(leaves.points.size(), kUnjudged);
    std::string html =
        "<section><h2>How far the scan lies from the tree</h2><p>Every point of the scan's wood, coloured by "
        "its "
        "distance to the nearest bark. Red points are wood that the tree does not have.";
    if (!pale.empty()) html += " Leaves are pale; they are not judged.";
    html += "</p><div class=\"row four\">";
    const char* const names[] = {"Front", "From the right", "Back", "From the left"};
    for (int side = 0; side < 4; side++) {
        PictureView view = view_of(box, 0.5 * kPi * side, pixels_for(box));
        // As wide as the widest, so that the page shows all at one scale.
        view.width = std::max(view.width, view_of(box, 0.5 * kPi * (side + 1), 16).width);
        Picture picture(view);
        // Behind all wood, which they would hide.
        std::vector<Vec3> behind = leaves.points;
        const Vec3 back(2.0 * box.diagonal() *
                        DVec3(portable::sin(view.azimuth), 0.0, portable::cos(view.azimuth)));
        for (Vec3& p : behind)
            p -= back;
        picture.draw(behind, pale, kLeafRadius, &progress);
        picture.draw(page.wood.positions, colors, dot_radius(page), &progress);
        html += figure(picture.finish(), names[side]);
        progress.check();
    }
    return html + "</div>" + heat_key(page.fidelity.tolerance) + "</section>";
}

std::string part_row(const std::string& name, const FidelityPart& part, bool sum = false) {
    const bool some = part.points > 0;
    return std::string(sum ? "<tr class=\"sum\">" : "<tr>") +
           cells({name, fixed(part.length, 1), std::to_string(part.points),
                  some ? with_bar(part.explained) : "-", some ? millimetres(part.median) : "-",
                  some ? millimetres(part.p95) : "-", with_bar(part.coverage)}) +
           "</tr>";
}

std::string order_name(size_t order) {
    return order == 0 ? "Trunk" : "Order " + std::to_string(order);
}

std::string fidelity_tables(const Page& page) {
    const Fidelity& f = page.fidelity;
    std::string html =
        "<section><h2>Fidelity</h2><p>" + percent(f.skeleton) +
        " of the points lie within the balls and frusta of the skeleton or at most " +
        fixed(100.0 * f.tolerance, 0) + " cm outside of them (R<sub>s</sub>; " + percent(f.skeleton_strict) +
        " without that tolerance). Explained is a point so near to the bark; covered is bark with such "
        "a point on it, by pieces of 5 cm: a sparse scan, or one from one side, covers less.";
    if (!page.details.photos && !page.details.outline)
        html += " The scan was made without photos, so that there is no Q: I and R<sub>3d</sub> are theirs.";
    html +=
        "</p>"
        "<div class=\"scroll\"><table><tr>";
    html += cells({"", "length, m", "points", "explained", "median, mm", "95 % within, mm", "covered"}, "th");
    html += "</tr>";
    for (size_t order = 0; order < f.by_order.size(); order++)
        html += part_row(order_name(order), f.by_order[order]);
    html += part_row("All", f.all, true) + "</table></div></section>";
    if (page.levels.size() < 2) return html;
    html +=
        "<section><h2>Lighter versions</h2><p>The same tree lightened to a half, a quarter and so on of its "
        "nodes.</p><div class=\"scroll\"><table><tr>" +
        cells({"nodes", "R<sub>s</sub>", "explained", "median, mm", "95 % within, mm"}, "th") + "</tr>";
    for (const LevelFidelity& level : page.levels)
        html += "<tr>" +
                cells({std::to_string(level.nodes), fixed(level.skeleton, 3), with_bar(level.all.explained),
                       millimetres(level.all.median), millimetres(level.all.p95)}) +
                "</tr>";
    return html + "</table></div></section>";
}

// Metres of wood by radius, and branches by length; both by order.
std::string histograms(const Page& page) {
    const Tree& tree = page.result.tree;
    const std::vector<double> radii = {0.0, 0.005, 0.01, 0.02, 0.04, 0.08, 0.16, 0.32, 1e9};
    const std::vector<double> lengths = {0.0, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 1e9};
    Histogram wood{"radius, cm", "metres of wood", {"0", "0.5", "1", "2", "4", "8", "16", "32", ""}, {}, {}};
    Histogram count{"length, m", "branches", {"0", "0.1", "0.25", "0.5", "1", "2", "4", "8", ""}, {}, {}};
    size_t orders = 0;
    for (const Branch& branch : page.branches.branches)
        orders = std::max(orders, static_cast<size_t>(branch.order) + 1);
    const size_t classes = std::min(orders, kMostOrders);
    for (Histogram* histogram : {&wood, &count}) {
        histogram->values.assign(classes, std::vector<double>(radii.size() - 1, 0.0));
        for (size_t c = 0; c < classes; c++)
            histogram->names.push_back(
                c + 1 == kMostOrders && orders > kMostOrders ? order_name(c) + " and higher" : order_name(c));
    }
    const auto bin_of = [](const std::vector<double>& edges, double value) {
        const auto above = std::upper_bound(edges.begin(), edges.end() - 1, value);
        return static_cast<size_t>(above - edges.begin()) - 1;
    };
    for (const Branch& branch : page.branches.branches) {
        const size_t c = std::min(static_cast<size_t>(branch.order), classes - 1);
        count.values[c][bin_of(lengths, branch.length)] += 1.0;
        for (NodeId id : page.branches.nodes_of(branch)) {
            const Node& node = tree.node(id);
            if (node.parent == kNoNode) continue;
            wood.values[c][bin_of(radii, node.radius)] +=
                glm::distance(node.position, tree.node(node.parent).position);
        }
    }
    trim(wood);
    trim(count);
    std::string html =
        "<section><h2>Radius and length by order</h2><div class=\"pair\"><div><p>Metres of wood by "
        "its radius</p>" +
        histogram_svg(wood) + "</div><div><p>Number of branches by their length</p>" + histogram_svg(count) +
        "</div></div><div class=\"key\">";
    for (size_t c = 0; c < classes; c++)
        html += "<span><i style=\"background:" + std::string(class_color(c)) + "\"></i>" + wood.names[c] +
                "</span>";
    return html + "</div></section>";
}

std::string review(const Page& page) {
    const ScanFrame& frame = page.result.tree.frame();
    std::string html = "<section><h2>Worth a look</h2>";
    if (page.unexplained.empty()) {
        html += "<p>No wood of the scan is missing from the tree.</p>";
    } else {
        html +=
            "<p>" + std::to_string(page.unexplained.size()) +
            " clusters of points that no branch explains; the largest:</p><div class=\"scroll\"><table><tr>" +
            cells({"points", "size, m", "centre in the scan", "grows from node", "gap, m"}, "th") + "</tr>";
        for (size_t i = 0; i < std::min(kMostListed, page.unexplained.size()); i++) {
            const UnexplainedCluster& cluster = page.unexplained[i];
            const DVec3 at = frame.to_scan(cluster.centre);
            html += "<tr>" +
                    cells({std::to_string(cluster.points.size()), fixed(cluster.size, 2),
                           fixed(at.x, 2) + ", " + fixed(at.y, 2) + ", " + fixed(at.z, 2),
                           std::to_string(cluster.joint), fixed(cluster.gap, 2)}) +
                    "</tr>";
        }
        html += "</table></div>";
    }
    if (page.doubtful.empty()) return html + "<p>No branch is doubtful.</p></section>";
    html +=
        "<p style=\"margin-top:14px\">" + std::to_string(page.doubtful.size()) +
        " branches that the scan hardly supports; the most doubtful:</p><div class=\"scroll\"><table><tr>" +
        cells({"node", "length, m", "points", "bridged, m", "turns by"}, "th") +
        "<th class=\"words\">why</th></tr>";
    for (size_t i = 0; i < std::min(kMostListed, page.doubtful.size()); i++) {
        const DoubtfulBranch& branch = page.doubtful[i];
        html += "<tr>" +
                cells({std::to_string(branch.node), fixed(branch.length, 2), std::to_string(branch.points),
                       fixed(branch.bridged, 2), fixed(branch.angle, 0) + "&deg;"}) +
                "<td class=\"words\">" + doubt_text(branch.reasons) + "</td></tr>";
    }
    return html + "</table></div></section>";
}

std::string made_how(const Page& page) {
    const Reconstruction& r = page.result;
    std::string removed;
    for (const CleanStep& step : r.clean.steps)
        if (step.removed > 0)
            removed +=
                (removed.empty() ? "" : ", ") + std::string(step.name) + " " + std::to_string(step.removed);
    std::string stages;
    double total = 0.0;
    for (const StageTime& stage : r.stages) {
        stages += (stages.empty() ? "" : ", ") + std::string(stage.name) + " " +
                  fixed(stage.milliseconds / 1000.0, 2) + " s";
        total += stage.milliseconds / 1000.0;
    }
    std::string html = "<section><h2>How it was made</h2><dl>";
    const auto entry = [&](const char* name, const std::string& value) {
        html += "<dt>" + std::string(name) + "</dt><dd>" + value + "</dd>";
    };
    // Not the folders: the page goes to others.
    entry("Scan",
          words(utf8_of(path_of(page.details.scan_path).filename())) + " (" + words(r.read.format) + ")");
    entry("Points", std::to_string(r.points_read) + " read, " + std::to_string(r.cloud.size()) +
                        " after cleaning, " + std::to_string(r.leaf_points) + " of them leaves");
    entry("Cleaning removed", removed.empty() ? "nothing" : words(removed));
    const std::string up = up_axis_name(r.orient.up);
    entry("Up", r.orient.photos > 0 ? fixed(r.tree.frame().tilt_degrees(), 1) + " degrees from " + up +
                                          " (by " + std::to_string(r.orient.photos) + " photos)"
                                    : up + (r.orient.up_detected ? " (found out)" : " (as told)"));
    entry("Scale", fixed(r.orient.metres_per_unit, 4) + " metres per unit" +
                       (r.orient.scale_guessed ? " (a guess)" : ""));
    entry("Thinned to", millimetres(r.spacing) + " mm between points");
    entry("Tree", std::to_string(r.measured.nodes) + " nodes, " +
                      std::to_string(page.branches.branches.size()) + " branches, " +
                      percent(r.measured.measured_volume_share) +
                      " of the wood's volume with a measured radius");
    entry("Time", stages + "; together " + fixed(total, 1) + " s");
    entry("Seed", std::to_string(page.details.seed));
    entry("Program", "treerec " + std::string(kVersion));
    return html + "</dl></section>";
}

std::string head(const Page& page) {
    const Reconstruction& r = page.result;
    const Measurements& m = r.measured;
    const std::string name =
        words(page.details.title.empty() ? stem_of(page.details.scan_path) : page.details.title);
    const std::string from = page.details.photos
                                 ? std::to_string(page.details.photos->registered) + " photos, by way of " +
                                       std::to_string(r.points_read) + " points"
                                 : std::to_string(r.points_read) + " scanned points";
    std::string html =
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
        "content=\"width=device-width,initial-scale=1\"><title>" +
        name + " - reconstructed tree</title><style>" + page_style() + "</style></head><body><main><h1>" +
        name + "</h1><p class=\"soft\">A tree reconstructed from " + from + "</p><div class=\"tiles\">";
    html += tile(fixed(m.height, 2) + " m", "height");
    html += m.dbh > 0.0 ? tile(fixed(100.0 * m.dbh, 1) + " cm", "diameter at breast height")
                        : tile("-", "diameter at breast height");
    html += tile(fixed(m.crown_radius, 2) + " m", "crown radius");
    html += tile(fixed(m.total_length, 0) + " m", "length of all wood");
    html += tile(fixed(m.volume, 3) + " m&sup3;", "volume of the wood");
    html += tile(percent(page.fidelity.all.explained), "of the points explained");
    html += tile(millimetres(page.fidelity.all.median) + " mm", "median distance to the bark");
    html += "</div>";
    if (r.warnings.empty()) return html;
    html += "<section class=\"warn\"><h2>Warnings</h2><ul>";
    for (const std::string& warning : r.warnings)
        html += "<li>" + words(warning) + "</li>";
    return html + "</ul></section>";
}

}  // namespace

std::string report_html(const Reconstruction& result, const ReportDetails& details, Progress* progress) {
    SubProgress own(progress, 0.0, 1.0);
    own.update(0.0, "Reporting");
    Page page{result, details, wood_of(result), {}, {}, {}, {}, list_branches(result.tree)};
    page.fidelity = measure_fidelity(result.tree, page.wood, {}, &own);
    own.update(0.4, "Reporting");
    page.levels = measure_levels(result.tree, page.wood, 4, {}, &own);
    page.unexplained = find_unexplained(result.tree, page.wood, page.fidelity, {}, {}, &own);
    page.doubtful = find_doubtful(result.tree, page.fidelity);
    own.update(0.7, "Reporting");
    const Bounds box = shown(page);
    std::string html = head(page);
    html += tree_pictures(page, box, own);
    html += photos_section(details, page.fidelity);
    html += heat_pictures(page, box, own);
    html += fidelity_tables(page) + histograms(page) + review(page) + made_how(page);
    own.update(1.0, "Reporting");
    return html + "</main></body></html>\n";
}

}  // namespace treerec
