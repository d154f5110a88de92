// How well grown trees are found again in their virtual scans.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "child.h"
#include "pipeline/reconstruct.h"
#include "synth/grow.h"
#include "synth/scan.h"

namespace treerec::bench {

// One grown tree and one scan of it.
struct AccuracyCase {
    Habit habit = Habit::kBroadleaf;
    uint64_t seed = 1;
    double noise = 0.0;      // metres
    double occlusion = 0.0;  // share of every view
    double leaves = 0.0;     // share of full foliage
    size_t points = 20000;
};

// Of the case's tree.
VirtualScanOptions scan_options_of(const AccuracyCase& setting);

// What a scanner of one resolution gets: leaves return beams that would pass a winter tree by.
size_t points_for(Habit habit, double leaves, size_t bare_points);

inline constexpr size_t kThicknessClasses = 5;  // as SkeletonScore::radius_by_thickness

struct AccuracyRow {
    AccuracyCase setting;
    double leafy = 0.0;      // share of the points that lie on leaves
    double seen = 0.0;       // share of the wood's length that has a point at all
    double precision = 0.0;  // within the larger of 1 cm and the radius
    double recall = 0.0;
    double f = 0.0;
    double length_error = 0.0;                             // relative
    double radius_error = 0.0;                             // median of the absolute relative error
    double dbh_error = 0.0;                                // relative; 0 where the tree has none
    std::array<double, kThicknessClasses> radius_bias{};   // median relative error
    std::array<double, kThicknessClasses> class_length{};  // metres that were met
    std::string failure;  // why there is no tree; everything else is then the worst
};

// An error beyond counts as this one: wrong is wrong.
inline constexpr double kLargestError = 0.3;

// A grown tree and a scan of it (without colours) in a file. labelled: the file says which points are leaves,
// so that a row is the most that telling them can reach.
class GrownScan {
  public:
    explicit GrownScan(const AccuracyCase& setting, bool labelled = false);
    // Runs the whole reconstruction from the file.
    AccuracyRow measure(const ReconstructOptions& options = {}, ReconstructCache* cache = nullptr) const;

  private:
    AccuracyRow seen_;  // what is known before
    Tree truth_;
    ScratchFolder folder_;
    std::string file_;
};

// Of a new scan.
AccuracyRow measure_accuracy(const AccuracyCase& setting, bool labelled = false);

// Every habit: clean, noisy, hidden in part, and leafy.
std::vector<AccuracyCase> guard_cases();

// Sentences about what is worse in `now` than in `recorded` beyond the tolerances; none if nothing is. Rows
// that one of them lacks count as worse.
std::vector<std::string> compare_accuracy(const std::vector<AccuracyRow>& recorded,
                                          const std::vector<AccuracyRow>& now);

// Tab-separated, with a header. Reading throws Error.
std::string accuracy_table(const std::vector<AccuracyRow>& rows);
std::vector<AccuracyRow> parse_accuracy_table(const std::string& text);

// The mean of everything but the settings; length and DBH errors without sign and with a limit, a class of
// thickness by its length. rows: not empty.
AccuracyRow mean_of(const std::vector<AccuracyRow>& rows);

}  // namespace treerec::bench
