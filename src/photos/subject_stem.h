// The stem that photos were taken around, where they show no crown.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/vec.h"
#include "progress.h"

namespace treerec {

// A section, seen along the sky.
struct SubjectRing {
    double height = 0.0;  // along the sky from the subject
    DVec2 centre{0.0};    // from the subject, in the plane across the sky
    double radius = 0.0;
};

struct SubjectStem {
    DVec3 subject{0.0}, sky{0.0};
    DVec3 side{0.0}, other{0.0};     // the axes of that plane
    std::vector<SubjectRing> rings;  // from below
    double low = 0.0, high = 0.0;    // heights between which it was looked for

    // Whether a point lies in the stem or on it, or up to `slack` of its radius beside or beyond its ends.
    bool has(const DVec3& p, double slack) const;
};

// What stands upright and round at the place that the photos were taken of, from the lowest of the points to
// the highest: a trunk that the pictures' upper edges cut off. Nothing where the subject ends otherwise, as a
// crown does. points: about the subject, in the model's axes and unit; subject, sky: as cameras tell
// (photos/cameras_tell.h).
std::optional<SubjectStem> find_subject_stem(std::span<const DVec3> points, const DVec3& subject,
                                             const DVec3& sky, Progress* progress = nullptr);

}  // namespace treerec
