#include "pipeline/reconstruct.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "completion/complete_all.h"
#include "error.h"
#include "exchange/tree_files.h"
#include "geometry/bounds.h"
#include "pipeline/ask_photos.h"
#include "scan/check_shape.h"
#include "scan/cleaning/thin_cloud.h"
#include "scan/leaves/wood_leaf.h"
#include "scan/usual_size.h"
#include "skeleton/twigs/leaf_twigs.h"
#include "skeleton/twigs/smooth_twigs.h"

namespace treerec {

namespace {

// Where the stages end, as shares of the whole; measured on real scans of 50k to 500k points.
constexpr double kReadEnd = 0.10;
constexpr double kOrientEnd = 0.15;
constexpr double kCleanEnd = 0.30;
constexpr double kLeavesEnd = 0.40;
constexpr double kFirstSkeletonEnd = 0.75;  // where leaves may have to be taken out of it
constexpr double kSkeletonEnd = 0.97;
constexpr double kCompletedEnd = 0.98;

// Below these shares the user is told: of explained points, and of the wood's volume whose radius was
// measured. The sparsest scans of trees reach 0.02 of the latter, houses and balls 0.003.
constexpr double kLeastExplained = 0.25;
constexpr double kLeastMeasured = 0.01;

// Degrees: what photos tell is out by one or two, and a scene so near to an axis was levelled before.
constexpr double kSameAxis = 2.0;

constexpr double kBesideStem = 0.3;  // of its radius: bark is rough, and stem bases are wider

constexpr double kFrondShare = 0.96;  // of how far fronds reach, slack and all: they arch

// With fewer points of wood the tree is made from the leaves' too.
constexpr size_t kLeastFollowed = 200;

// Where more than this went that was grown through leaves, as a share of what stayed, the leaves' points have
// made that crooked and thick.
constexpr double kMuchDropped = 0.25;

// A tree has details to show: what a scan's file says of its spacing is not believed beyond this share of its
// size.
constexpr double kWidestSpacing = 0.02;

void append(std::vector<std::string>& all, const std::vector<std::string>& more) {
    all.insert(all.end(), more.begin(), more.end());
}

// The cloud as the file has it, or as the cache has the file. kept: gets which.
PointCloud read_or_take(const std::string& path, const ReadCloudOptions& options, ReadCloudReport& report,
                        Progress* progress, ReconstructCache* cache, bool& kept) {
    const std::optional<FileStamp> file = cache ? FileStamp::of(path) : std::nullopt;
    kept = file && cache->has_read(*file, options);
    if (kept) {
        report = cache->read->report;
        return cache->read->cloud;
    }
    // Its nodes would pass for points.
    if (is_skeleton_file(path)) throw Error("'" + path + "' is a skeleton, not a point cloud.");
    if (cache) *cache = {};
    PointCloud cloud = read_cloud(path, options, &report, progress);
    // Not of a file that was written to meanwhile.
    if (file && FileStamp::of(path) == file) cache->read = {*file, options, cloud, report};
    return cloud;
}

// Of photos that show a trunk and no crown, the trunk.
void keep_stem(PointCloud& cloud, const SubjectStem& stem) {
    std::vector<uint8_t> keep(cloud.size());
    for (size_t i = 0; i < cloud.size(); i++)
        keep[i] = stem.has(cloud.frame.to_scan(DVec3(cloud.positions[i])), kBesideStem);
    cloud.keep_only(keep);
}

// What the user left open, and the photos beside the scan tell.
void let_photos_tell(const std::string& path, PointCloud& cloud, ReconstructOptions& options,
                     std::vector<std::string>& warnings, Progress& progress) {
    if (options.orient.up) return;
    const PhotosTell told = path.empty() ? PhotosTell() : ask_photos(path, cloud, progress);
    append(warnings, told.warnings);
    const PickOptions& pick = options.clean.pick;
    const bool shown = !pick.enabled || pick.number > 1 || pick.position;
    if (told.one_sided && !told.stem && !shown)
        throw Error(
            "The photos look at one side: they go " + std::to_string(std::lround(*told.one_sided)) +
            " of the 360 degrees around what they show, and from there a tree looks no different from a "
            "wall. Walk around the tree, or a third of the way at least. If there is a tree in their "
            "cloud, tell where it stands.");
    if (told.photos > 0) {
        ScanFrame frame;
        frame.set_sky(told.sky);
        options.orient.up = frame.up;
        if (frame.tilt_degrees() > kSameAxis) options.orient.tilt = frame.tilt;
        options.orient.photos = told.photos;
        if (told.stem && options.clean.remove_ground) {
            keep_stem(cloud, *told.stem);
            options.tell_leaves = false;
            options.skeleton.trunk_alone = true;
            warnings.emplace_back(
                "The photos show a stem, and its crown is above their upper edges; what stands around the "
                "stem was "
                "left out. If it is part of the tree, leave out the cleaning of the ground.");
        }
    }
    if (options.clean.pick.enabled && options.clean.pick.number == 1 && !options.clean.pick.position)
        options.clean.pick.position = told.subject;
}

// Moves the cloud into the tree's frame; both have the same axes and unit.
void rebase_cloud(PointCloud& cloud, const ScanFrame& frame) {
    const DVec3 base = cloud.frame.to_tree(frame.origin);
    for (Vec3& p : cloud.positions)
        p = Vec3(DVec3(p) - base);
    cloud.frame = frame;
}

// Of what the leaves leave to follow.
SkeletonResult skeletonize_wood(const Reconstruction& result, const WoodLeaf& told, SkeletonOptions options,
                                SubProgress& progress) {
    // Bushes around a stem of a plot may stand lower.
    const PickReport& pick = result.clean.pick;
    if (!pick.trees.empty()) options.stem_base = result.cloud.frame.to_tree(pick.trees[pick.taken].foot);
    PointCloud followed;
    if (!told.wood_path.empty()) {
        followed = result.cloud;
        followed.keep_only(told.wood_path);
    }
    const bool follow = followed.size() >= kLeastFollowed;
    SkeletonResult skeleton = skeletonize(follow ? followed : result.cloud, options, &progress);
    progress.check();
    return skeleton;
}

// Takes back what was grown through leaves, and its points; where they were many, the rest is grown anew
// without them.
void take_back_leaves(Reconstruction& result, WoodLeaf& told, const SkeletonOptions& options,
                      SkeletonResult& skeleton, SubProgress& progress) {
    StageClock clock(skeleton.stages);
    LeavesTold leaves{told.leaf_share, told.by_colour};
    const auto drop = [&] {
        const DroppedTwigs dropped =
            drop_leaf_twigs(skeleton.tree, result.cloud.positions, told.leafiness, leaves, progress);
        if (dropped.leaf.empty()) return 0.0;
        told.foliage = true;
        told.leaf.resize(dropped.leaf.size(), 0);
        if (told.wood_path.empty()) told.wood_path.assign(dropped.leaf.size(), 1);
        for (size_t i = 0; i < dropped.leaf.size(); i++) {
            if (!dropped.leaf[i]) continue;
            told.leaf[i] = 1;
            told.wood_path[i] = 0;
        }
        return dropped.length;
    };
    const bool much = drop() > kMuchDropped * measure(skeleton.tree).total_length;
    clock.stop("Leaf twigs", skeleton.tree.size());
    const auto left =
        static_cast<size_t>(std::count(told.wood_path.begin(), told.wood_path.end(), uint8_t{1}));
    if (!much || told.by_colour || left < kLeastFollowed) return;
    SkeletonResult anew = skeletonize_wood(result, told, options, progress);
    if (anew.tree.size() < 2) return;
    anew.stages.insert(anew.stages.begin(), skeleton.stages.begin(), skeleton.stages.end());
    skeleton = std::move(anew);
    rebase_cloud(result.cloud, skeleton.tree.frame());
    clock.restart();
    leaves.grown_anew = true;
    drop();
    clock.stop("Leaf twigs", skeleton.tree.size());
}

Foliage foliage_of(const PointCloud& cloud, const std::vector<uint8_t>& leaf, const Progress& progress) {
    std::vector<Vec3> points;
    std::vector<Color8> colors;
    for (size_t i = 0; i < cloud.size(); i++) {
        if (!leaf[i]) continue;
        points.push_back(cloud.positions[i]);
        if (cloud.has_colors()) colors.push_back(cloud.colors[i]);
    }
    return gather_foliage(points, colors, &progress);
}

// In metres; 0 where the scan's file tells none, or nonsense.
double told_spacing(const Reconstruction& result) {
    Bounds bounds;
    for (const Vec3& p : result.cloud.positions)
        bounds.add(DVec3(p));
    const double spacing = result.cloud.spacing * result.orient.metres_per_unit;
    return spacing < kWidestSpacing * bounds.diagonal() ? spacing : 0.0;
}

// The way from the cloud that was read, of that path. kept: the cache had it.
void reconstruct_read(Reconstruction& result, const std::string& path, ReconstructOptions options,
                      Progress* progress, ReconstructCache* cache, bool kept) {
    StageClock clock(result.stages);
    result.points_read = result.cloud.size();
    append(result.warnings, result.read.warnings);

    SubProgress orienting(progress, kReadEnd, kOrientEnd);
    orienting.update(0.0, "Orienting");
    let_photos_tell(path, result.cloud, options, result.warnings, orienting);
    kept = kept && cache->has_clean(options.orient, options.clean);
    if (cache && !kept) {
        cache->clean.reset();
        cache->leaves.reset();
    }
    result.orient = kept ? cache->clean->orient : orient_cloud(result.cloud, options.orient, &orienting);
    append(result.warnings, result.orient.warnings);
    const size_t oriented = kept ? cache->clean->oriented : result.cloud.size();
    clock.stop("Orient", oriented, kept);
    orienting.check();

    SubProgress cleaning(progress, kOrientEnd, kCleanEnd);
    cleaning.update(0.0, "Cleaning");
    std::vector<std::string> shape_warnings;
    if (kept) {
        result.cloud = cache->clean->cloud;
        result.clean = cache->clean->report;
        shape_warnings = cache->clean->shape_warnings;
    } else {
        result.clean = clean_cloud(result.cloud, options.clean, &cleaning);
        settle_height(result.cloud, options.orient, result.orient);
        shape_warnings = check_shape(result.cloud, &cleaning);
        if (cache && cache->read)
            cache->clean = {options.orient, options.clean, oriented,      result.cloud,
                            result.orient,  result.clean,  shape_warnings};
    }
    append(result.warnings, result.clean.warnings);
    append(result.warnings, shape_warnings);
    clock.stop("Clean", result.cloud.size(), kept);
    cleaning.check();

    SubProgress telling(progress, kCleanEnd, kLeavesEnd);
    telling.update(0.0, "Leaves");
    WoodLeaf told;
    kept = kept && options.tell_leaves && cache->leaves;
    if (kept)
        told = *cache->leaves;
    else if (options.tell_leaves)
        told = tell_wood_from_leaves(result.cloud, &telling);
    if (cache && cache->clean && options.tell_leaves && !kept) cache->leaves = told;
    append(result.warnings, told.warnings);
    clock.stop("Leaves", result.cloud.size(), kept);
    telling.check();

    const bool doubted = !told.leafiness.empty() && options.skeleton.method == SkeletonMethod::kGeodesic;
    SubProgress growing(progress, kLeavesEnd, doubted ? kFirstSkeletonEnd : kSkeletonEnd);
    SkeletonOptions skeleton_options = options.skeleton;
    if (skeleton_options.spacing <= 0.0) skeleton_options.spacing = told_spacing(result);
    skeleton_options.one_stem = skeleton_options.one_stem || told.fronds;
    skeleton_options.noise = std::max(skeleton_options.noise, told.noise);
    SkeletonResult skeleton = skeletonize_wood(result, told, skeleton_options, growing);
    if (skeleton.tree.size() < 2)
        throw Error("No tree was found in " + (path.empty() ? "the points" : "'" + path + "'") +
                    ": nothing in it looks like wood.");
    rebase_cloud(result.cloud, skeleton.tree.frame());
    if (doubted) {
        SubProgress doubting(progress, kFirstSkeletonEnd, kSkeletonEnd);
        take_back_leaves(result, told, skeleton_options, skeleton, doubting);
    }
    // The other methods are those of their papers.
    if (options.skeleton.method == SkeletonMethod::kGeodesic)
        smooth_twigs(skeleton.tree, enlargement_to_usual(result.cloud.positions));
    append(result.warnings, skeleton.warnings);
    result.stages.insert(result.stages.end(), skeleton.stages.begin(), skeleton.stages.end());
    result.spacing = skeleton.spacing;
    result.voxel = skeleton.voxel;
    result.kind = skeleton.kind;
    result.kind_told = skeleton.kind_told;
    result.steps = std::move(skeleton.steps);
    result.palm = told.fronds;
    result.noise = told.noise;
    if (told.by_labels) result.leaf_column = result.cloud.labels.column;
    result.raw = std::move(skeleton.raw);
    result.tree = std::move(skeleton.tree);

    clock.restart();
    if (told.foliage) {
        result.foliage = foliage_of(result.cloud, told.leaf, telling);
        result.foliage.reach = told.reach;
        result.leaf_points = static_cast<size_t>(std::count(told.leaf.begin(), told.leaf.end(), uint8_t{1}));
        result.wood.resize(told.leaf.size());
        for (size_t i = 0; i < told.leaf.size(); i++)
            result.wood[i] = !told.leaf[i] && (told.wood_path.empty() || told.wood_path[i]);
        clock.stop("Foliage", result.leaf_points);
    }
    if (options.complete && !told.fronds) {
        SubProgress completing(progress, kSkeletonEnd, 1.0);
        const CompletedTree walked = complete_all(result.tree, result.cloud, {}, result.wood, &completing);
        result.completed = walked.branches.size();
        for (const Completion& branch : walked.branches)
            result.completed_length += branch.length;
        clock.stop("Completion", result.tree.size());
    }
    if (options.prune) {
        result.pruned = prune_twigs(result.tree, *options.prune).nodes.size();
        result.tree = result.tree.compacted();
        clock.stop("Pruning", result.tree.size());
    }
    apply_radius_rule(result.tree, options.radii);
}

}  // namespace

PointCloud wood_of(const Reconstruction& result) {
    PointCloud wood;
    wood.frame = result.cloud.frame;
    wood.positions = result.cloud.positions;
    if (!result.wood.empty() && result.leaf_points < wood.size()) wood.keep_only(result.wood);
    return wood;
}

std::string chosen_leaves(const std::string& asked, const Reconstruction& result) {
    if (asked != "auto") return asked;
    return result.palm ? "palm" : "generic";
}

LeafRules suited_leaves(const std::string& preset, const Reconstruction& result) {
    LeafRules rules = leaf_preset(preset);
    if (result.palm && preset == "palm") {
        // As many fronds as ever, from as much of the stem as suits their length.
        const double size = kFrondShare * result.foliage.reach / rules.leaf_size;
        rules.leaf_size *= size;
        rules.twig_length *= size;
        rules.internode *= size;
    }
    return rules;
}

Reconstruction reconstruct_file(const std::string& path, const ReconstructOptions& options,
                                Progress* progress, ReconstructCache* cache) {
    SubProgress reconstructing(progress, 0.0, kCompletedEnd), scoring(progress, kCompletedEnd, 1.0);
    Reconstruction result = reconstruct_tree(path, options, &reconstructing, cache);
    score_reconstruction(result, options, &scoring);
    return result;
}

Reconstruction reconstruct_tree(const std::string& scan, const ReconstructOptions& options,
                                Progress* progress, ReconstructCache* cache) {
    const std::string path = cloud_file_of(scan);
    Reconstruction result;
    StageClock clock(result.stages);
    bool kept = false;
    SubProgress reading(progress, 0.0, kReadEnd);
    reading.update(0.0, "Reading");
    result.cloud = read_or_take(path, options.read, result.read, &reading, cache, kept);
    clock.stop("Read", result.cloud.size(), kept);
    reading.check();
    reconstruct_read(result, path, options, progress, cache, kept);
    return result;
}

Reconstruction reconstruct_cloud(const PointCloud& cloud, const ReadCloudReport& read,
                                 const std::string& path, const ReconstructOptions& options,
                                 Progress* progress) {
    Reconstruction result;
    result.cloud = cloud;
    result.read = read;
    reconstruct_read(result, path, options, progress, nullptr, false);
    return result;
}

void score_reconstruction(Reconstruction& result, const ReconstructOptions& options, Progress* progress) {
    StageClock clock(result.stages);
    PointCloud wood;
    if (!result.wood.empty()) {
        wood = result.cloud;
        wood.keep_only(result.wood);
    }
    const PointCloud& judged = wood.empty() ? result.cloud : wood;
    if (result.measured.nodes == 0) result.measured = measure(result.tree);
    result.fit = score_scan(result.tree, judged, 0.0, progress, options.score_points);
    const bool unexplained = result.fit.explained_2cm < kLeastExplained;
    const bool guessed =
        options.radii == RadiusRule::kMeasured && result.measured.measured_volume_share < kLeastMeasured;
    const bool noisy = result.noise > 0.0;
    if (unexplained && !noisy)
        result.warnings.push_back("Only " + std::to_string(std::lround(100.0 * result.fit.explained_2cm)) +
                                  " % of the wood's points lie within 2 cm of the wood that was found. Is it "
                                  "a single tree, and are its units right?");
    if (guessed && !noisy)
        result.warnings.emplace_back(
            "Next to no part of the cloud is round like a stem or a branch, so the radii are guesses. Is it "
            "a tree?");
    if (noisy && (unexplained || guessed))
        result.warnings.push_back(
            "The scan is noisy: even the stem's points lie on no surface, but about " +
            std::to_string(std::max(1L, std::lround(100.0 * result.noise))) +
            " cm or more to either side of it. Twigs and the radii of thin wood are guesses.");
    clock.stop("Score", result.cloud.size());
}

PointCloud load_scan(const std::string& scan, const ReconstructOptions& options, const ScanFrame& frame,
                     size_t most, Progress* progress, ReconstructCache* cache) {
    const std::string path = cloud_file_of(scan);
    constexpr double kScanRead = 0.4, kScanOriented = 0.5, kScanCleaned = 0.9;
    bool kept = false;
    ReadCloudReport report;
    SubProgress reading(progress, 0.0, kScanRead);
    reading.update(0.0, "Reading");
    PointCloud cloud = read_or_take(path, options.read, report, &reading, cache, kept);
    reading.check();
    if (options.clean.remove_ground)
        if (const PhotosTell told = ask_photos(path, cloud, reading); told.stem) keep_stem(cloud, *told.stem);
    // The tree knows where it stands, which way is up and how long a metre is.
    CleanOptions clean = options.clean;
    clean.pick.position = frame.origin;
    OrientOptions orient;
    orient.up = frame.up;
    orient.tilt = frame.tilt;
    orient.metres_per_unit = frame.metres_per_unit;
    SubProgress orienting(progress, kScanRead, kScanOriented);
    orienting.update(0.0, "Orienting");
    orient_cloud(cloud, orient, &orienting);
    SubProgress cleaning(progress, kScanOriented, kScanCleaned);
    cleaning.update(0.0, "Cleaning");
    clean_cloud(cloud, clean, &cleaning);
    SubProgress thinning(progress, kScanCleaned, 1.0);
    thinning.update(0.0, "Thinning");
    thin_cloud(cloud, most, &thinning);
    rebase_cloud(cloud, frame);
    return cloud;
}

}  // namespace treerec
