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
    // simplify/
    kGapTaper,
    kCount
};

inline constexpr size_t kPasses = static_cast<size_t>(Pass::kCount);

inline constexpr std::array<const char*, kPasses> kPassNames = {
    "strays left out",
    "denser sample",
    "bridges run on",
    "wide gaps",
    "base by forks",
    "thickness",
    "second trial cut",
    "loops merged",
    "same fork",
    "straight stems",
    "straight bases",
    "attach moved",
    "second fit",
    "rings",
    "arcs",
    "arcs of many points",
    "long windows",
    "straight ends",
    "planted base",
    "limited base",
    "early strips",
    "refinement",
    "second refinement",
    "foreign points",
    "round stations",
    "one-sided bark",
    "seated root",
    "median radii",
    "noise of radii",
    "own slenderness",
    "base span",
    "measured ends",
    "palm width",
    "late strips",
    "tips drawn back",
    "stump ends",
    "blur",
    "roots at the foot",
    "twig forks",
    "sharp turns",
    "short shoots",
    "few points",
    "gap taper",
};

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
