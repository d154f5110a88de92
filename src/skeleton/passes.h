// The passes of the geodesic skeleton that work without each other: each can be left out, to measure what it
// is worth (tests/bench/ablate.cpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace treerec {

enum class Pass : uint8_t {
    // sampling/
    kStrays,
    kSample,
    kBridgesRunOn,
    kPieceEnds,
    kWideGaps,
    // geodesics/
    kBaseByForks,
    // branches/
    kThickness,
    kSecondTrial,
    kLoops,
    kSameFork,
    kStraightStems,
    kStraightBases,
    kAttach,
    kForks,
    kTightBends,
    // cylinders/
    kSecondFit,
    kRings,
    kArcs,
    kManyPointedArcs,
    kLongWindows,
    kStraightEnds,
    kPlantedBase,
    kLimitedBase,
    kEarlyStrips,
    kRefinement,
    kSecondRefinement,
    kForeignPoints,
    kRoundStations,
    kOneSided,
    kSeatedRoot,
    kMedianRadii,
    kNoiseOfRadii,
    kOwnSlenderness,
    kBaseSpan,
    kMeasuredEnds,
    kPalmWidth,
    kLateStrips,
    kTips,
    // twigs/
    kStumpEnds,
    kBlur,
    kFootRoots,
    kTwigForks,
    kSharpTurns,
    kShortShoots,
    kFewPoints,
    kHugging,
    // simplify/
    kGapTaper,
    kCount
};

inline constexpr size_t kPasses = static_cast<size_t>(Pass::kCount);

struct PassName {
    Pass pass;
    const char* name;
};

inline constexpr std::array<PassName, kPasses> kPassNames = {{
    {Pass::kStrays, "strays left out"},
    {Pass::kSample, "denser sample"},
    {Pass::kBridgesRunOn, "bridges run on"},
    {Pass::kPieceEnds, "both ends linked"},
    {Pass::kWideGaps, "wide gaps"},
    {Pass::kBaseByForks, "base by forks"},
    {Pass::kThickness, "thickness"},
    {Pass::kSecondTrial, "second trial cut"},
    {Pass::kLoops, "loops merged"},
    {Pass::kSameFork, "same fork"},
    {Pass::kStraightStems, "straight stems"},
    {Pass::kStraightBases, "straight bases"},
    {Pass::kAttach, "attach moved"},
    {Pass::kForks, "forks laid"},
    {Pass::kTightBends, "tight bends"},
    {Pass::kSecondFit, "second fit"},
    {Pass::kRings, "rings"},
    {Pass::kArcs, "arcs"},
    {Pass::kManyPointedArcs, "arcs of many points"},
    {Pass::kLongWindows, "long windows"},
    {Pass::kStraightEnds, "straight ends"},
    {Pass::kPlantedBase, "planted base"},
    {Pass::kLimitedBase, "limited base"},
    {Pass::kEarlyStrips, "early strips"},
    {Pass::kRefinement, "refinement"},
    {Pass::kSecondRefinement, "second refinement"},
    {Pass::kForeignPoints, "foreign points"},
    {Pass::kRoundStations, "round stations"},
    {Pass::kOneSided, "one-sided bark"},
    {Pass::kSeatedRoot, "seated root"},
    {Pass::kMedianRadii, "median radii"},
    {Pass::kNoiseOfRadii, "noise of radii"},
    {Pass::kOwnSlenderness, "own slenderness"},
    {Pass::kBaseSpan, "base span"},
    {Pass::kMeasuredEnds, "measured ends"},
    {Pass::kPalmWidth, "palm width"},
    {Pass::kLateStrips, "late strips"},
    {Pass::kTips, "tips drawn back"},
    {Pass::kStumpEnds, "stump ends"},
    {Pass::kBlur, "blur"},
    {Pass::kFootRoots, "roots at the foot"},
    {Pass::kTwigForks, "twig forks"},
    {Pass::kSharpTurns, "sharp turns"},
    {Pass::kShortShoots, "short shoots"},
    {Pass::kFewPoints, "few points"},
    {Pass::kHugging, "hugging shoots"},
    {Pass::kGapTaper, "gap taper"},
}};

static_assert(
    [] {
        for (size_t i = 0; i < kPasses; i++)
            if (kPassNames[i].pass != static_cast<Pass>(i)) return false;
        return true;
    }(),
    "each pass has a name");

class PassSet {
  public:
    constexpr PassSet() = default;
    constexpr PassSet(Pass pass) : bits_(bit(pass)) {}
    constexpr bool has(Pass pass) const { return (bits_ & bit(pass)) != 0; }
    bool operator==(const PassSet&) const = default;

  private:
    static constexpr uint64_t bit(Pass pass) { return uint64_t{1} << static_cast<uint8_t>(pass); }

    uint64_t bits_ = 0;
};

}  // namespace treerec
