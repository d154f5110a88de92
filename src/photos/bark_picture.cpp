#include "photos/bark_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "photos/bark_maps.h"
#include "photos/quilt.h"
#include "photos/trunk_chart.h"

namespace treerec {

namespace {

constexpr int kSize = 512;             // pixels
constexpr int kFineSize = 1024;        // pixels
constexpr double kFinePixel = 0.0012;  // metres on the bark
constexpr double kMostTexels = 8e6;    // of the chart
constexpr double kLongest = 3.0;       // metres of trunk that are looked at
constexpr double kShading = 0.12;      // metres: what changes more slowly is light, not bark
constexpr double kEvenColour = 0.6;    // of the colour's slow changes
constexpr double kPatch = 0.04;        // metres: of what is compared to be bark
constexpr double kSurveyEnd = 0.1, kGatherEnd = 0.75;

std::string metric(const char* format, double value) {
    char text[160];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

std::string coarse(double pixel, double coarsest) {
    return metric("The photos show the bark with pixels of %.1f mm", 1000.0 * pixel) +
           metric(", and a picture of it needs %.1f mm or less: take some from nearer by, or larger ones.",
                  1000.0 * coarsest);
}

}  // namespace

PhotoBark bark_of_photos(const Tree& tree, const PhotoModel& model, const std::string& folder,
                         const SeenThings& things, const BarkOptions& options, Progress* progress) {
    PhotoBark bark;
    const TrunkChart chart = chart_trunk(tree, kLongest);
    if (!(chart.length() > 0.0)) {
        bark.why_not = "The tree has no piece of trunk below its first branch that bark could be taken from.";
        return bark;
    }
    const BarkSurvey survey = survey_bark(tree, chart, model, things, progress);
    if (progress) progress->update(kSurveyEnd, "Bark");
    bark.pixel = bark.detail = survey.usual_pixel();
    if (!(bark.pixel > 0.0)) {
        bark.why_not = "No photo shows the trunk below its first branch from the front.";
        return bark;
    }
    if (bark.pixel > options.coarsest) {
        bark.why_not = coarse(bark.pixel, options.coarsest);
        return bark;
    }
    int size = options.size;
    if (size == 0) size = bark.pixel <= kFinePixel ? kFineSize : kSize;
    const auto texel_of = [&] {
        return DVec2(options.repeat_width, options.repeat_length) / static_cast<double>(size);
    };
    const auto texels_of = [&] { return chart.width() * chart.length() / (texel_of().x * texel_of().y); };
    // The pictures of a huge trunk's whole chart would be too large.
    if (options.size == 0 && texels_of() > kMostTexels) size = kSize;
    const TrunkChart shorter =
        texels_of() > kMostTexels ? chart_trunk(tree, chart.length() * kMostTexels / texels_of()) : chart;
    const DVec2 texel = texel_of();
    SubProgress gathering(progress, kSurveyEnd, kGatherEnd);
    SeenBark seen = gather_bark(
        shorter,
        shorter.length() < chart.length() ? survey_bark(tree, shorter, model, things, progress) : survey,
        texel, tree.frame(), model, folder, &gathering);
    bark.photos = seen.photos;
    bark.area = seen.area;
    if (seen.photos == 0) {
        bark.why_not = "None of the photos that show the trunk can be read.";
        return bark;
    }
    bark.pixel = seen.pixel;
    bark.detail = seen.detail;
    if (bark.pixel > options.coarsest) {
        bark.why_not = coarse(bark.pixel, options.coarsest);
        return bark;
    }
    if (bark.detail > options.coarsest) {
        bark.why_not = metric("The photos show the bark out of focus or shaken: no detail finer than %.1f mm",
                              1000.0 * bark.detail) +
                       metric(", and a picture of it needs %.1f mm.", 1000.0 * options.coarsest);
        return bark;
    }
    if (progress) progress->update(kGatherEnd, "Bark");
    take_light_off(seen.colours, seen.seen, kShading / texel, 0.0, false);
    const std::vector<float> faults = faults_of(seen.colours, seen.seen, kPatch / texel);
    const QuiltOptions quilting{size, size};
    const std::optional<int> pieces = pieces_of(seen.colours, faults, quilting);
    if (!pieces) {
        char text[300];
        std::snprintf(text, sizeof text,
                      "Too little of the trunk is seen: %.2f square metres of its clear part, in no piece of "
                      "%.0f x %.0f cm and some more around it. Take more photos of it, all around.",
                      bark.area, 100.0 * options.repeat_width * 1.3 / 8.0,
                      100.0 * options.repeat_length * 1.3 / 8.0);
        bark.why_not = text;
        return bark;
    }
    bark.pieces = *pieces;
    if (progress) progress->check();
    Image albedo = quilt(seen.colours, faults, *pieces, quilting, progress);
    // What is left of slow changes would show as a pattern where the picture repeats.
    const std::vector<uint8_t> all(static_cast<size_t>(size) * static_cast<size_t>(size), 1);
    take_light_off(albedo, all, kShading / texel, kEvenColour, true);
    bark.textures = maps_of(std::move(albedo), texel, bark.detail);
    return bark;
}

}  // namespace treerec
