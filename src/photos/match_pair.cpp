#include "photos/match_pair.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/quantile.h"

namespace treerec {

namespace {

constexpr size_t kEnoughCoarse = 40;   // matched patches: the pair is as upright as it seems
constexpr size_t kAsked = 400;         // corners that tell how a pair is turned
constexpr size_t kLeastCoarse = 8;     // matched patches whose motion is believed
constexpr size_t kNearest = 8;         // of them tell the motion of a corner
constexpr size_t kBetweenChecks = 64;  // corners
constexpr double kSameThing = 10.0;    // pixels: two ends that are nearer show the same thing
constexpr double kGrain = 0.02;        // what of a similarity may be the pictures' noise
constexpr double kOften = 0.9;         // similarity: no other beginning is tried

// Beyond upright photos of the same distance.
constexpr PairTurn kTurns[] = {{-15, 1}, {15, 1},    {-30, 1},  {30, 1},     {-45, 1},
                               {45, 1},  {0, 1.3},   {0, 0.77}, {90, 1},     {-90, 1},
                               {180, 1}, {-20, 1.3}, {20, 1.3}, {-20, 0.77}, {20, 0.77}};

// The motion of a pair, as the patches tell it.
struct CoarseMotion {
    std::vector<CoarseMatch> matches;
    PairTurn turn;
    double spacing = 0.0;  // pixels: how near two matches usually are
};

CoarseMotion coarse_motion(const PhotoFeatures& one, const PhotoFeatures& other) {
    CoarseMotion coarse;
    coarse.matches = match_patches(one.patches, other.patches);
    if (coarse.matches.size() < kEnoughCoarse) {
        // Few corners tell which turn it is.
        const CornerPatches few = strongest_of(one.patches, kAsked);
        size_t most = match_patches(few, strongest_of(other.patches, kAsked)).size() + kLeastCoarse;
        for (const PairTurn& turn : kTurns) {
            const size_t count =
                match_patches(few, patches_of(other.pyramid, other.corners, kAsked, turn), turn).size();
            if (count <= most) continue;
            most = count;
            coarse.turn = turn;
        }
        if (coarse.turn.degrees != 0.0 || coarse.turn.scale != 1.0)
            coarse.matches = match_patches(
                one.patches, patches_of(other.pyramid, other.corners, other.corners.size(), coarse.turn),
                coarse.turn);
    }
    if (coarse.matches.size() < kLeastCoarse) coarse.matches.clear();
    const GreyPicture& picture = one.pyramid.levels[0];
    if (!coarse.matches.empty())
        coarse.spacing = std::sqrt(static_cast<double>(picture.width) * picture.height /
                                   static_cast<double>(coarse.matches.size()));
    return coarse;
}

// Where to begin, the likeliest first: where the corner's own patch is, where the patches around it lead on
// the whole, and where the nearest ones lead.
std::vector<AffineMotion> guesses_for(const CoarseMotion& coarse, uint32_t corner, const DVec2& place) {
    if (coarse.matches.empty()) return {{place, DMat2(1.0)}};
    std::vector<std::pair<double, size_t>> near;
    near.reserve(coarse.matches.size());
    for (size_t i = 0; i < coarse.matches.size(); i++) {
        const DVec2 way = coarse.matches[i].from - place;
        near.emplace_back(glm::dot(way, way), i);
    }
    const size_t count = std::min(kNearest, near.size());
    std::partial_sort(near.begin(), near.begin() + static_cast<ptrdiff_t>(count), near.end());
    const DMat2 turn = coarse.turn.matrix();
    const double soft = coarse.spacing * coarse.spacing;
    // An affine motion by weighted least squares, held at the pair's turn where the matches lie in a heap.
    double weights = 0.0;
    DVec2 from(0.0), to(0.0);
    for (size_t k = 0; k < count; k++) {
        const CoarseMatch& match = coarse.matches[near[k].second];
        const double weight = 1.0 / (near[k].first + 0.1 * soft);
        weights += weight;
        from += weight * match.from;
        to += weight * match.to;
    }
    from /= weights;
    to /= weights;
    DMat2 spread(soft), moved(0.0);
    for (size_t k = 0; k < count; k++) {
        const CoarseMatch& match = coarse.matches[near[k].second];
        const double share = 1.0 / (near[k].first + 0.1 * soft) / weights;
        const DVec2 way = match.from - from, miss = match.to - to - turn * way;
        spread += share * glm::outerProduct(way, way);
        moved += share * glm::outerProduct(miss, way);
    }
    const DMat2 local = turn + moved * glm::inverse(spread);
    std::vector<AffineMotion> guesses;
    const CoarseMatch& nearest = coarse.matches[near[0].second];
    if (nearest.one == corner) guesses.push_back({nearest.to, local});
    guesses.push_back({to + local * (place - from), local});
    for (size_t k = nearest.one == corner ? 1 : 0; k < std::min<size_t>(2, count); k++) {
        const CoarseMatch& match = coarse.matches[near[k].second];
        guesses.push_back({match.to + local * (place - match.from), local});
    }
    return guesses;
}

// How far from the corner the way back ends, pixels; infinite where it does not end. It begins as far beside
// the corner as the way there began beside its end.
double back_error_of(const PhotoFeatures& one, const PhotoFeatures& other, const DVec2& place,
                     const AffineMotion& guess, const AffineTrack& found, const AffineTrackOptions& options) {
    if (!(std::abs(glm::determinant(guess.turn)) > 1e-3)) return INFINITY;
    const DMat2 back = glm::inverse(guess.turn);
    const AffineMotion start{place + back * (found.motion.place - guess.place), back};
    const auto end = track_affine(other.pyramid, one.pyramid, found.motion.place, start, options);
    return end ? glm::distance(end->motion.place, place) : INFINITY;
}

// Whether something elsewhere is nearly as similar to the corner as what was found.
bool has_rival(const PhotoFeatures& one, const PhotoFeatures& other, const PointMatch& match,
               const DMat2& turn, const MatchOptions& options, const AffineTrackOptions& track) {
    const DVec2 place = one.corners[match.corner].place;
    const double least = 1.0 - std::max(1.0 - match.similarity, kGrain) / options.clearly;
    for (const size_t rival :
         rivals_of(one.patches, match.corner, other.patches, match.place, options.rivals)) {
        const auto found =
            track_affine(one.pyramid, other.pyramid, place, {other.patches.places[rival], turn}, track);
        if (found && found->similarity > least &&
            glm::distance(found->motion.place, match.place) > kSameThing)
            return true;
    }
    return false;
}

// Drops what does not agree with the rest on how the two cameras stood.
void filter_by_geometry(const PhotoFeatures& one, std::vector<PointMatch>& matches,
                        const PairGeometryOptions& options, const Progress* progress) {
    std::vector<PlacePair> places;
    for (const PointMatch& match : matches)
        if (match.kept) places.push_back({one.corners[match.corner].place, match.place});
    const std::vector<uint8_t> agreeing = agreeing_on_geometry(places, options, progress);
    size_t next = 0;
    for (PointMatch& match : matches)
        if (match.kept) match.kept = agreeing[next++] != 0;
}

}  // namespace

size_t PairMatches::kept() const {
    return static_cast<size_t>(
        std::count_if(matches.begin(), matches.end(), [](const PointMatch& match) { return match.kept; }));
}

PhotoFeatures features_of(const Image& photo, const FeatureOptions& options) {
    PhotoFeatures features;
    features.pyramid = pyramid_of(photo, options.most_pixels);
    features.corners = harris_corners(features.pyramid.levels[0], options.harris);
    features.patches = patches_of(features.pyramid, features.corners, features.corners.size());
    return features;
}

PairMatches match_pair(const PhotoFeatures& one, const PhotoFeatures& other, const MatchOptions& options,
                       const Progress* progress) {
    PairMatches result;
    const CoarseMotion coarse = coarse_motion(one, other);
    result.coarse = coarse.matches.size();
    AffineTrackOptions track = options.track;
    if (coarse.matches.empty()) track.levels = one.pyramid.levels.size();
    for (size_t i = 0; i < one.corners.size(); i++) {
        if (progress && i % kBetweenChecks == 0) progress->check();
        const DVec2 place = one.corners[i].place;
        std::optional<AffineTrack> best;
        AffineMotion begun;
        for (const AffineMotion& guess : guesses_for(coarse, static_cast<uint32_t>(i), place)) {
            const auto found = track_affine(one.pyramid, other.pyramid, place, guess, track);
            if (!found || (best && found->similarity <= best->similarity)) continue;
            best = found;
            begun = guess;
            if (best->similarity >= kOften) break;
        }
        if (!best) continue;
        PointMatch match;
        match.corner = static_cast<uint32_t>(i);
        match.place = best->motion.place;
        match.similarity = best->similarity;
        match.kept = match.similarity >= options.least_similarity;
        match.back_error = INFINITY;
        if (match.kept) {
            match.back_error = back_error_of(one, other, place, begun, *best, track);
            match.kept = match.back_error <= options.back_tolerance &&
                         !has_rival(one, other, match, begun.turn, options, track);
        }
        result.matches.push_back(match);
    }
    if (options.geometry) filter_by_geometry(one, result.matches, *options.geometry, progress);
    filter_by_medians(result.matches, options.medians);
    return result;
}

PairMatches match_pair_plain(const PhotoFeatures& one, const PhotoFeatures& other,
                             const LucasKanadeOptions& options) {
    PairMatches result;
    for (size_t i = 0; i < one.corners.size(); i++) {
        const DVec2 place = one.corners[i].place;
        if (const auto found = track_lucas_kanade(one.pyramid, other.pyramid, place, place, options)) {
            PointMatch match;
            match.corner = static_cast<uint32_t>(i);
            match.place = *found;
            result.matches.push_back(match);
        }
    }
    return result;
}

void filter_by_medians(std::vector<PointMatch>& matches, MedianFilter filter) {
    std::vector<double> similarities, errors;
    for (const PointMatch& match : matches)
        if (match.kept) {
            similarities.push_back(match.similarity);
            errors.push_back(match.back_error);
        }
    if (similarities.empty() || filter == MedianFilter::kNone) return;
    // Copies: algorithm 1 sorts the arrays that it then asks by pair.
    const double similarity = quantile(similarities, 0.5), error = quantile(errors, 0.5);
    for (PointMatch& match : matches) {
        if (!match.kept) continue;
        const bool alike = match.similarity > similarity, returns = match.back_error < error;
        match.kept = filter == MedianFilter::kEither ? alike && returns : alike || returns;
    }
}

}  // namespace treerec
