#include "photos/colmap_advice.h"

#include <algorithm>
#include <cmath>

namespace treerec {

namespace {

constexpr size_t kFewFeatures = 400;  // in a photo: sharp ones of bark and leaves have thousands
constexpr size_t kAScene = 5;         // photos that only another model has
constexpr double kWideGap = 45.0;     // degrees
constexpr size_t kNamed = 5;          // photos
constexpr size_t kJointsNamed = 3;

const char* const kHowToTake =
    "Walk around the tree and take a photo every 10 to 15 degrees (24 to 36 for the circle), each showing "
    "most of what the one before it shows.";

}  // namespace

Error too_few_photos(size_t photos, const std::string& folder) {
    return Error("There " +
                 std::string(photos == 1 ? "is 1 photo" : "are " + std::to_string(photos) + " photos") +
                 " in '" + folder + "'; a tree needs " + std::to_string(kLeastPhotos) +
                 " or more, and 30 to 50 are good. " + kHowToTake);
}

Error none_registered(size_t photos, size_t features) {
    const std::string begin =
        "COLMAP could not find out where any of the " + std::to_string(photos) + " photos was taken from: ";
    if (features > 0 && features < kFewFeatures)
        return Error(begin + "there is little in them to recognise (" + std::to_string(features) +
                     " features in a usual one, where sharp photos of bark and leaves have thousands). They "
                     "are blurred, dark or small, or show something smooth, such as a wall or the sky.");
    return Error(begin + "they overlap too little, or do not show the same thing. " + kHowToTake);
}

std::string more_matches(size_t by_sift, const ColmapRun& run) {
    if (by_sift < run.registered)
        return "COLMAP's features alone placed " + std::to_string(by_sift) + " of " +
               std::to_string(run.photos) + " photos; corners were tracked as well, and placed " +
               std::to_string(run.registered) + ".";
    return "COLMAP's features alone placed some photos doubtfully, so corners were tracked as well.";
}

std::string no_more_matches(const std::string& why) {
    return "Photos are missing, or doubtfully placed, and corners could not be tracked as well. " + why;
}

std::vector<std::string> advice_on(const ColmapRun& run, const std::vector<size_t>& models, bool further) {
    std::vector<std::string> advice;
    const bool two_scenes = models.size() > 1 && models[1] >= kAScene;
    if (two_scenes)
        advice.push_back("The photos show two scenes that nothing joins, of " + std::to_string(models[0]) +
                         " and " + std::to_string(models[1]) +
                         " photos; the first one was taken. Add photos that lead from one to the other, or "
                         "take those of the other tree out of the folder.");
    if (!run.missing.empty()) {
        std::string names;
        for (size_t i = 0; i < std::min(run.missing.size(), kNamed); i++)
            names += (i ? ", " : "") + run.missing[i];
        if (run.missing.size() > kNamed) names += ", …";
        advice.push_back("COLMAP found out where " + std::to_string(run.registered) + " of " +
                         std::to_string(run.photos) + " photos were taken from; the others (" + names +
                         ") overlap too little with these, or are blurred.");
    }
    if (run.widest_gap && run.widest_gap->degrees > kWideGap)
        advice.push_back("The circle of photos around the tree is open for " +
                         std::to_string(std::lround(run.widest_gap->degrees)) + " degrees, between " +
                         run.widest_gap->from + " and " + run.widest_gap->to +
                         ": what is seen from there alone is missing. Add photos there, one every 10 to 15 "
                         "degrees.");
    const bool bent = !run.joints.contradictions.empty();
    if (bent) {
        const PhotoContradiction& worst = run.joints.contradictions[0];
        advice.push_back("The places of the photos contradict what they show: of " +
                         std::to_string(worst.shared) + " points that " + worst.one + " and " + worst.other +
                         " share, " + std::to_string(worst.fitting) + " fit where these were placed, and " +
                         std::to_string(worst.own) +
                         " fit another place. So the circle of photos is bent, and the tree is wrong. Take "
                         "more photos around these two.");
    }
    size_t named = 0;
    for (const PhotoJoint& joint : run.joints.weak)
        // A wider one is open, which is said above.
        if (joint.degrees <= kWideGap && named++ < kJointsNamed)
            advice.push_back("Only " + std::to_string(joint.points) +
                             " points hold the circle together between " + joint.from + " and " + joint.to +
                             ": take a photo between these two.");
    if (further && (bent || named > 0))
        advice.push_back("To compare the photos by both (--matcher both) finds more such points.");
    return advice;
}

}  // namespace treerec
