// The benchmarks behind ./dev bench. Each prints its table to stdout and throws treerec::Error.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace treerec::bench {

struct Settings {
    std::string program;              // treerec itself
    std::string record;               // the recorded accuracy table (tests/bench/accuracy.tsv)
    std::string beside;               // another program to run beside ours
    std::vector<std::string> args;    // handed to it after scan and folder
    std::string out, weights;         // folders of bench_leaf_inputs()
    std::string truth;                // the folder of corrected skeletons
    std::string models;               // the folder of another program's tree files
    int repetitions = 0;              // 0: the benchmark's own
    int seeds = 2;                    // of the synthetic table
    bool labelled = false;            // its scans say which points are leaves
    size_t most_points = 10'000'000;  // of the scaling table
};

// Time and memory of every stage, and CGAL's bare Delaunay triangulation of the same thinned points.
void bench_stages(const std::string& scan, const Settings& settings);
// Whole runs of 10k to 10M points, made from one scan.
void bench_scaling(const std::string& scan, const Settings& settings);
// The clouds of that table: a random part of the scan, or copies of it with 5 cm jitter, in any format that
// write_cloud() knows.
void write_resized(const std::string& scan, size_t count, const std::string& path);
// Whole runs of ours and of another program in turns.
void bench_beside(const std::vector<std::string>& scans, const Settings& settings);
// What a user waits for while editing trees of 5,000 and 100,000 nodes.
void bench_edits(const Settings& settings);
// New individuals of a tree: of scans or skeletons, or of a grown one where none is named.
void bench_variants(const std::vector<std::string>& files, const Settings& settings);
// One line per real scan; with recall, precision and length where there is a corrected skeleton,
// and with another program's tree of the same scan below.
void bench_scans(const std::vector<std::string>& scans, const Settings& settings);
// Lighter trees beside the paper's: size and outline, of scans or skeletons; of grown trees where none is
// named.
void bench_lighter(const std::vector<std::string>& files);
// Bytes of each scan, of its skeleton, and of lighter ones (Zhang 2013, table 9.2).
void bench_bytes(const std::vector<std::string>& scans);
// What a vegetation artist sees at once in the tree of each scan: triangles of its levels; the area of its
// leaves, over that of the ground below them; tips that hug wood three times as thick (within 3 of its
// radii), bends above 60 degrees, radii of tips; texels of the trunk's bark; how far its section at breast
// height is from a circle, peak to peak over the mean radius, in the scan and in the tree.
void bench_looks(const std::vector<std::string>& scans);
// How long the fidelity takes to follow edits of the tree of each scan.
void bench_fidelity(const std::vector<std::string>& scans, const Settings& settings);
// The corrected skeleton of a scan, in the same coordinates: `folder`/STEM_skeleton_corrected….csv; or none.
std::string truth_of(const std::string& scan, const std::string& folder);
// Both skeletonizers on every scan.
void bench_methods(const std::vector<std::string>& scans, const Settings& settings);
// How the length error falls while somebody who knows the truth accepts or skips what is proposed as missing,
// and cuts what is proposed as doubtful.
void bench_clicks(const std::vector<std::string>& scans, const Settings& settings);
// Precision, recall, radius and DBH errors on grown trees.
void bench_synth(const Settings& settings);
// Writes to the folder settings.out what the classifier of leaves knows of points of grown trees, and of
// these scans: labelled ones, or such as have no leaves. With settings.weights what its second network knows,
// by the first one's weights in even.txt (fitted to scans of odd numbers) and odd.txt of that folder.
void bench_twig_inputs(const Settings& settings);
void bench_leaf_inputs(const std::vector<std::string>& scans, const Settings& settings);
// What each pass of the skeleton, and each step of the cleaning, is worth: grown trees and these scans with
// it and without. settings.args: the names of some, instead of all. With repetitions set, scan by scan, too.
void bench_ablation(const std::vector<std::string>& scans, const Settings& settings);
// The reduced table of the same: compared with the recorded one (false: worse), or recorded.
bool guard_accuracy(const Settings& settings);
void record_accuracy(const Settings& settings);

// Each way to match the photos of a folder: matches, photos placed, points, error, time. settings.args:
// further options of 'treerec photos'.
void bench_photos(const std::vector<std::string>& folders, const Settings& settings);
// The row of that table for what 'treerec photos' left in a folder.
void tell_photos(const std::string& name, const std::string& matcher, const std::string& out, size_t photos,
                 double seconds);
// Plain and improved tracking of corners: on drawn pictures whose warp is known, and between photos, by what
// their COLMAP model says, from 0 to 45 degrees around what they show.
void bench_warps();
void bench_pairs(const std::string& photos, const std::string& model);

// Branches removed from grown trees of each habit and drawn anew from random cameras, with the points of the
// branch and without: how near they come to it. With repetitions set, branch by branch, too.
void bench_drawn_branches(const Settings& settings);
// Plots of grown trees whose crowns touch or grow through each other: stems found, and points given to the
// right tree. With repetitions set, plot by plot, too.
void bench_plots(const Settings& settings);
// Strokes to trees of every species: time, and how well crowns fill their outlines. repetitions: sketches.
void bench_sketches(const Settings& settings);

// Bark that grows from Mizoguchi and Miyata's (2014) seed, with its parameters and to its sizes; how time
// grows with vertices.
void bench_growth(const Settings& settings);

// Time to write and read L-strings of 10 MB, and to rewrite a grammar.
void bench_strings(const Settings& settings);

// CPU milliseconds of CGAL's Delaunay triangulation of the points: x, y, z of one after the other.
double delaunay_floor_ms(const std::vector<float>& coordinates);

}  // namespace treerec::bench
