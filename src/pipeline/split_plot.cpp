#include "pipeline/split_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string_view>

#include "error.h"
#include "exchange/exr.h"
#include "file_bytes.h"
#include "scan/plots/ground_raster.h"
#include "scan/plots/plot_guide.h"

namespace treerec {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kLeastOverlap = 5.0, kMostOverlap = 30.0;  // metres
// Of the height: a crown's radius is at most .45 of it (separate_trees.cpp), and its neighbours' stems are to
// be seen as well.
constexpr double kOverlapShare = 0.7;
constexpr size_t kLookEvery = 1 << 20;
constexpr const char *kTable = "trees.csv", *kPlot = "plot.json", *kGround = "ground.exr";

// Whether a run writes files of such a name.
bool is_own(const std::string& name) {
    if (name == kTable || name == kPlot || name == kGround) return true;
    constexpr std::string_view start = "tree_", end = ".ply";
    if (!name.starts_with(start) || !name.ends_with(end) || name.size() < start.size() + 4 + end.size())
        return false;
    const auto digits = std::string_view(name).substr(start.size(), name.size() - start.size() - end.size());
    return digits.find_first_not_of("0123456789") == std::string_view::npos;
}

std::vector<fs::path> entries_of(const std::string& folder) {
    std::vector<fs::path> entries;
    for (const fs::directory_entry& entry : fs::directory_iterator(path_of(folder)))
        entries.push_back(entry.path());
    return entries;
}

// Where all is made until it is whole. Goes away with whatever is still in it.
class Workshop {
  public:
    explicit Workshop(const std::string& folder) : folder_(folder + ".part") {
        std::error_code failure;
        if (fs::exists(path_of(folder_), failure) && !fs::exists(path_of(mark()), failure))
            throw Error("'" + folder_ +
                        "' is there already, and not by an earlier run; it was left as it is. Move it away, "
                        "or name another folder.");
        fs::remove_all(path_of(folder_), failure);
        make_folder(folder_);
        write_file(mark(), "This folder is made by 'treerec split', which removes it when it is done.\n");
        make_folder(folder_ + "/tiles");
    }
    ~Workshop() {
        std::error_code failure;
        fs::remove_all(path_of(folder_), failure);
    }
    Workshop(const Workshop&) = delete;
    Workshop& operator=(const Workshop&) = delete;

    std::string file(const std::string& name) const { return folder_ + "/" + name; }
    void drop_tiles() const { fs::remove_all(path_of(file("tiles"))); }
    // Now it is whole. What somebody has put beside an earlier run's files stays.
    void move_to(const std::string& folder) const {
        try {
            fs::create_directories(path_of(folder));
            // First, so that the folder is known as one of this kind whenever this is cut off.
            move_file(kTable, folder);
            for (const fs::path& old : entries_of(folder))
                if (const std::string name = utf8_of(old.filename()); name != kTable && is_own(name))
                    fs::remove(old);
            for (const fs::path& made : entries_of(folder_))
                if (made != path_of(mark())) move_file(utf8_of(made.filename()), folder);
        } catch (const fs::filesystem_error& failure) {
            throw Error("'" + folder + "' could not be written: " + failure.code().message() + ".");
        }
    }

  private:
    void move_file(const std::string& name, const std::string& folder) const {
        fs::rename(path_of(file(name)), path_of(folder + "/" + name));
    }
    std::string mark() const { return folder_ + "/made_by_treerec"; }

    std::string folder_;
};

// In an order of their own, so that neither that of the scan's points nor that of the tiles matters.
PointCloud cloud_of(const PointCloud& tile, std::vector<uint32_t> points) {
    std::sort(points.begin(), points.end(), [&](uint32_t a, uint32_t b) {
        const Vec3 &p = tile.positions[a], &q = tile.positions[b];
        if (p.x != q.x) return p.x < q.x;
        if (p.z != q.z) return p.z < q.z;
        if (p.y != q.y) return p.y < q.y;
        return tile.has_colors() && tile.colors[a] < tile.colors[b];
    });
    PointCloud cloud;
    cloud.frame = tile.frame;
    for (const uint32_t i : points) {
        cloud.positions.push_back(tile.positions[i]);
        if (tile.has_colors()) cloud.colors.push_back(tile.colors[i]);
    }
    return cloud;
}

std::string fixed(double value, int decimals) {
    std::array<char, 64> text;
    std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
    return text.data();
}

std::string csv_of(const std::vector<SplitTree>& trees) {
    std::string text = std::string(kSplitColumns) + "\n";
    for (const SplitTree& t : trees) {
        text += t.name + "," + t.name + ".ply";
        for (int axis = 0; axis < 3; axis++)
            text += "," + fixed(t.foot[axis], 3);
        text += "," + fixed(t.tree.height, 2) + ",";
        if (t.tree.dbh > 0.0) text += fixed(100.0 * t.tree.dbh, 1);
        text += "," + std::to_string(t.tree.points) + ",";
        std::string warnings;
        for (const std::string& warning : t.tree.warnings)
            warnings += (warnings.empty() ? "" : "; ") + warning;
        text += warnings.find(',') == std::string::npos ? warnings : '"' + warnings + '"';
        text += '\n';
    }
    return text;
}

Json place_json(const DVec3& p) {
    return Json::array({p.x, p.y, p.z});
}

std::string plot_json(const std::string& scan, const PlotGuide& guide, const Heightmap& map,
                      const SplitReport& report, const SplitOptions& options) {
    Json json;
    json["plot_format"] = 1;
    json["scan"] = utf8_of(path_of(scan).filename());
    json["points"] = report.points;
    json["trees"] = report.trees.size();
    json["tiles"] = report.tiles;
    json["tile_m"] = options.tile;
    json["overlap_m"] = report.overlap;
    json["frame"] = {{"origin", place_json(guide.frame.origin)},
                     {"metres_per_unit", guide.frame.metres_per_unit},
                     {"up", up_axis_name(guide.frame.up)}};
    if (report.ground) {
        const auto [low, high] = std::minmax_element(map.heights.begin(), map.heights.end());
        json["ground"] = {{"file", kGround},
                          {"width", map.width},
                          {"depth", map.depth},
                          {"pixel_m", map.pixel},
                          {"first_pixel_m", Json::array({map.first.x, map.first.y})},
                          {"lowest_m", *low},
                          {"highest_m", *high},
                          {"seen", map.seen}};
    }
    json["warnings"] = report.warnings;
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

// One run, stage by stage.
class Splitting {
  public:
    Splitting(const std::string& scan, const std::string& folder, const SplitOptions& options,
              Progress* progress)
        : options_(options), progress_(progress), scan_(scan), workshop_(folder) {}

    SplitReport run(const std::string& folder) {
        SubProgress reading(progress_, 0.0, 0.1), looking(progress_, 0.1, 0.15),
            dealing(progress_, 0.15, 0.25), finding(progress_, 0.25, 0.95);
        CloudPieces pieces(scan_, options_.read, options_.piece, &reading);
        guide_ = guide_to(pieces, options_.orient, &looking);
        const TileGrid grid(guide_.x, guide_.z, options_.tile);
        TileStore store(grid, workshop_.file("tiles"));
        deal_out(pieces, store, &dealing);
        report_.warnings = pieces.warnings();
        report_.warnings.insert(report_.warnings.end(), guide_.warnings.begin(), guide_.warnings.end());
        GroundRaster ground(guide_.x, guide_.z, options_.pixel);
        find_trees(grid, store, ground, &finding);
        workshop_.drop_tiles();
        name_trees();
        const Heightmap map = ground.finish();
        report_.ground = !map.heights.empty();
        if (report_.ground)
            write_file(workshop_.file(kGround), exr_bytes(map.width, map.depth, map.heights));
        else
            report_.warnings.emplace_back("No ground was seen, and no ground.exr was written.");
        write_file(workshop_.file(kPlot), plot_json(scan_, guide_, map, report_, options_));
        write_file(workshop_.file(kTable), csv_of(report_.trees));
        if (progress_) progress_->check();
        workshop_.move_to(folder);
        return std::move(report_);
    }

  private:
    void deal_out(CloudPieces& pieces, TileStore& store, Progress* progress) {
        size_t stray = 0;
        pieces.each(
            [&](const PointCloud& piece) {
                for (size_t i = 0; i < piece.size(); i++) {
                    if (progress && i % kLookEvery == 0) progress->check();
                    const DVec3 p = guide_.frame.to_tree(piece.frame.to_scan(DVec3(piece.positions[i])));
                    if (guide_.holds(p))
                        store.add(Vec3(p), piece.has_colors() ? &piece.colors[i] : nullptr);
                    else
                        stray++;
                }
            },
            progress);
        store.finish();
        if (stray > 0)
            guide_.warnings.push_back(std::to_string(stray) + " of " + std::to_string(guide_.points) +
                                      " points lie far from the plot and were left out.");
    }

    void find_trees(const TileGrid& grid, const TileStore& store, GroundRaster& ground, Progress* progress) {
        report_.points = guide_.points;
        report_.tiles = grid.size();
        report_.overlap = options_.overlap > 0.0
                              ? options_.overlap
                              : std::clamp(kOverlapShare * guide_.height, kLeastOverlap, kMostOverlap);
        for (size_t tile = 0; tile < grid.size(); tile++) {
            progress->check();
            progress->update(static_cast<double>(tile) / static_cast<double>(grid.size()), "Trees");
            progress->count(tile, grid.size());
            const PointCloud cloud = store.read(tile, report_.overlap, guide_.frame, progress);
            const TileCore core = grid.core(tile);
            TileTrees found =
                find_tile_trees(cloud, core, {guide_.x, guide_.z}, options_.least_height, progress);
            for (const uint32_t i : found.ground)
                if (const DVec3 p(cloud.positions[i]); grid.at(p.x, p.z) == tile) ground.add(p);
            for (size_t t = 0; t < found.trees.size(); t++) {
                found.trees[t].tile = tile;
                write_cloud(part(candidates_.size()), cloud_of(cloud, std::move(found.points[t])), {},
                            progress);
                candidates_.push_back(std::move(found.trees[t]));
            }
        }
    }

    std::string part(size_t candidate) const {
        return workshop_.file("part_" + std::to_string(candidate) + ".ply");
    }

    void name_trees() {
        const std::vector<size_t> chosen = choose_plot_trees(candidates_);
        if (chosen.empty())
            throw Error("No tree was found in '" + scan_ + "': no stem of at least " +
                        fixed(options_.least_height, 1) +
                        " m stands by itself. If it is one tree, reconstruct it as it is; small ones are "
                        "found with a lower least height.");
        for (const size_t c : chosen) {
            std::array<char, 32> name;
            std::snprintf(name.data(), name.size(), "tree_%04zu", report_.trees.size() + 1);
            fs::rename(path_of(part(c)), path_of(workshop_.file(std::string(name.data()) + ".ply")));
            report_.trees.push_back(
                {name.data(), guide_.frame.to_scan(candidates_[c].foot), std::move(candidates_[c])});
        }
        for (size_t c = 0; c < candidates_.size(); c++)
            fs::remove(path_of(part(c)));
    }

    const SplitOptions& options_;
    Progress* progress_;
    std::string scan_;
    Workshop workshop_;
    PlotGuide guide_;
    std::vector<PlotTree> candidates_;
    SplitReport report_;
};

}  // namespace

void require_split_folder(const std::string& folder) {
    std::error_code failure;
    if (!fs::exists(path_of(folder), failure)) return;
    if (!fs::is_directory(path_of(folder), failure))
        throw Error("'" + folder + "' is a file; name a folder to write to.");
    if (fs::is_empty(path_of(folder), failure)) return;
    std::ifstream stream(path_of(folder + "/" + kTable));
    std::string line;
    if (!std::getline(stream, line) || line != kSplitColumns)
        throw Error("'" + folder +
                    "' is there already and is no plot that treerec has split; it was left as it is. Name "
                    "another folder, or remove that one.");
}

SplitReport split_plot(const std::string& scan, const std::string& folder, const SplitOptions& options,
                       Progress* progress) {
    require_split_folder(folder);
    return Splitting(scan, folder, options, progress).run(folder);
}

}  // namespace treerec
