// What is told about a tree and about a reconstruction, as JSON.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "exchange/tree_files.h"
#include "growth/bark_fit.h"
#include "growth/grow_bark.h"
#include "growth/lumps.h"
#include "photos/bark_picture.h"
#include "photos/leaf_colours.h"
#include "photos/marker_scale.h"
#include "photos/run_colmap.h"
#include "pipeline/judge_outline.h"
#include "pipeline/reconstruct.h"

namespace treerec {

// Of report.json. 2: the skeleton method that version 1 calls "delaunay" is "geodesic".
inline constexpr int kReportVersion = 2;

struct ReportDetails {
    std::string scan_path;
    ReconstructOptions options;
    std::string leaves = "generic";  // preset
    uint64_t seed = 1;
    size_t triangles = 0;
    size_t leaf_count = 0;
    std::optional<ColmapRun> photos = {};          // where the scan was made of some
    size_t photo_pairs = 0;                        // that were matched pixel by pixel
    std::optional<MarkerScale> marker = {};        // of these photos
    bool sized_by_marker = false;                  // the scale is that of the marker
    bool sized_by_gps = false;                     // the scale is that of photos->gps
    std::optional<OutlineJudgement> outline = {};  // where masks of the photos, or their sky, tell of it
    std::string outline_lacks = {};                // a sentence: why photos that were asked don't
    std::string title = {};                        // of the page; else the scan's name
    std::optional<Image> outline_sheet = {};       // fidelity_sheet(), for the page
    std::optional<PhotoBark> bark = {};            // where it was looked for in the photos
    std::optional<LeafColours> leaf_colours = {};  // likewise
};

// report.json, UTF-8, numbers finite or null. Keys:
//   format_version (kReportVersion), version, scan, scan_format, seed
//   options {up, scale, known_height_m, known_length_m, skeleton, spanning_tree (of delaunay), voxel_m (of a
//   flood), spacing_m, columns, classes (of LAS; "auto"), leaves, tell_leaves, complete,
//     tree (number; null where a place or no tree was asked for), tree_at [x y z], one_tree, clean}
//   points_read, points (after cleaning), leaf_points and leaf_share (of these), leaf_column (of the file,
//   that told them; else null), foliage_cells, removed {step: points} up, up_detected, up_from_photos (whose
//   cameras told it; else 0), tilt_degrees (of the sky from the axis `up`), metres_per_unit, scale_guessed,
//   scale_unknown (guessed, and the scan tells nothing of its scale), scale_from_marker (a printed marker set
//   it), scale_from_gps (the photos' places did), origin [x y z in scan coordinates]
//   trees [{base [x y z in scan coordinates], height_m, points}] (largest first; empty where the scan was
//   taken for one tree), tree_taken (its number in this list, from 1), spacing_m
//   completed_branches, completed_length_m (option complete: what was added afterwards)
//   voxel_m, points_are "surface", "solid" or "surface, probably" (of a flood alone)
//   stages [{name, ms, count}], total_ms, peak_mb (of the process; null where the system does not tell)
//   nodes, tips, branches [{order, count, length_m}], height_m, dbh_m (null for a tree lower than breast
//   height, or without wood there), stems, crown_radius_m, crown_base_m, length_m, volume_m3,
//   measured_share (of the length), measured_volume_share, triangles, leaves
//   fit {points, median_mm, mean_mm, p95_mm, explained_2cm}: the cleaned points and the bark
//   (fidelity/score.h)
//   fidelity {points, explained, median_mm, p95_mm, length_m, coverage, tolerance_m, R_s, R_s_strict,
//   orders [{points .. coverage}]}: of the wood (fidelity/fidelity.h), from at most about 200000 points
//   warnings [sentence]
//   photos {photos, placed, missing [name], colmap (version), pairs, widest_gap {degrees, from, to} (null
//   where the photos were not taken around something), contradictions [{photos [name, name], shared, fitting,
//   own}] and weak_joints [{from, to, degrees, points}] (photos/photo_joints.h), cameras [{name, degrees,
//   away}] (in their order around what was photographed), gps {photos, fixes, kept, metres_per_unit,
//   relative_error} (null where no photo says where it was taken; photos/gps_scale.h), marker {photos (that
//   show any), side_m (null: not told), metres_per_unit (null: unknown), spread, markers [{id, photos, kept
//   (that agree), parallax_degrees, side_units (null: not measured), uneven, why_not (a sentence, or null)}]}
//   (null where no photo shows one; photos/marker_scale.h), outline {photos (that judge), by ("masks", or
//   "sky": then R_3d, Q and precision are upper bounds, and recall and iou null), hold_out (every how many
//   one; 0: the tree was made of them), I, R_3d, R_3d_seen (of the points that each shows), R_s, Q, recall,
//   precision, iou, by_photo
//   [{name, inside (points on the tree), outside, recall, precision, iou}]} (null where nothing judges, and
//   outline_lacks is a sentence, or null where nobody asked)}: of a scan that was made of photos alone
//   bark {from "photos" or "drawn", why_drawn (a sentence, or null), photos, pixel_mm, detail_mm (null where
//   no photo shows any), area_m2}: where it was looked for in photos (photos/bark_picture.h)
//   leaf_colors {from "photos" or "drawn", why_drawn (a sentence, or null), photos, points, and where they
//   are the photos', as linear light: albedo [r g b], as_seen, greenest, least_green, tone_spread, low, high
//   (factors of albedo at low_height_m and high_height_m), bands [{low_m, high_m, color, points}]}: where
//   they were looked for in photos (photos/leaf_colours.h)
std::string report_json(const Reconstruction& result, const ReportDetails& details);

// Of a skeleton file that was read: trees, tree_taken (from 1), warnings [sentence].
std::string skeleton_report_json(const SkeletonReport& report);

// Of bark that was grown: steps, branches (that it covers), vertices, triangles, warnings [sentence].
std::string growth_report_json(const GrownTree& grown);

// Of what a scan shows beside round wood: burls, hollows, sections (their numbers), warnings [sentence].
std::string growth_proposal_json(const GrowthProposal& proposal);

// By what a report of how true grown bark is to its scan is known.
inline constexpr char kBarkFitMark[] = "\"bark_fit_version\"";

// bark_fit_version 1, steps, triangles, warnings [sentence], radii {slices, median, p95} (relative errors),
// dbh_m {scan, grown, error (relative)} (null where the scan does not show it), all, lumpy and heights [..]:
// {from_m, to_m, points, lumpy (share of the radius), tubes_m and grown_m {median, mean, p95}, nearer (share
// by which the mean is less than the tubes')}, worse (of the heights): growth/bark_fit.h.
std::string bark_fit_json(const BarkFit& fit, const GrownTree& grown);

// The measurements alone, with the keys above.
std::string measurements_json(const Tree& tree);

// The largest resident memory of this process so far in MB; 0 where the system does not tell.
double peak_memory_mb();

}  // namespace treerec
