#include "fidelity/photo_overlap.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "error.h"
#include "fidelity/photo_fidelity.h"
#include "foliage/leaf_rule_text.h"
#include "geometry/parallel.h"
#include "mesh/above_ground.h"
#include "mesh/leaf_cards.h"
#include "mesh/levels.h"
#include "textures/textures.h"

namespace treerec {

namespace {

constexpr int kCutOut = 256;  // pixels of a leaf's picture

void draw(const OutlinePart& part, const PinholeView& view, SampleMask& mask, const Progress* progress) {
    const Mesh& mesh = part.mesh;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        if (progress && i % 65536 == 0) progress->check();
        DVec2 corners[3];
        bool seen = true;
        for (int k = 0; k < 3 && seen; k++) {
            const auto at = view.project(DVec3(mesh.positions[mesh.indices[i + k]]));
            seen = at && std::isfinite(at->x) && std::isfinite(at->y);
            if (seen) corners[k] = *at * static_cast<double>(SampleMask::kSamples);
        }
        if (!seen) continue;
        if (part.cut_out.pixels.empty()) {
            mask.fill(corners);
            continue;
        }
        Vec2 uvs[3];
        for (int k = 0; k < 3; k++)
            uvs[k] = mesh.uvs[mesh.indices[i + k]];
        mask.fill(corners, uvs, part.cut_out);
    }
}

// Nothing for a black mask.
std::optional<Overlap> compare(const SampleMask& drawn, const Image& mask, const Image& shown) {
    double wanted = 0.0, made = 0.0, both = 0.0, either = 0.0;
    for (int y = 0; y < mask.height; y++)
        for (int x = 0; x < mask.width; x++) {
            if (*shown.at(x, y) == 0) continue;  // the lens doesn't show it
            const double should = *mask.at(x, y) / 255.0;
            const double is =
                static_cast<double>(drawn.covered(x, y)) / (SampleMask::kSamples * SampleMask::kSamples);
            wanted += should;
            made += is;
            both += std::min(should, is);
            either += std::max(should, is);
        }
    if (!(wanted > 0.0)) return std::nullopt;
    return Overlap{both / wanted, made > 0.0 ? both / made : 0.0, both / either};
}

std::optional<Overlap> overlap_in(std::span<const OutlinePart> parts, const ScanFrame& frame,
                                  const OutlineMask& mask, const Progress* progress) {
    const PinholeView view = fitted(pinhole_view(mask.photo, mask.camera, frame), mask.longest);
    return compare(drawn_outline(parts, view, progress), mask.mask, mask.shown);
}

OutlineOverlap mean_of(const std::vector<std::string>& names,
                       const std::vector<std::optional<Overlap>>& found) {
    OutlineOverlap result;
    for (size_t i = 0; i < found.size(); i++)
        if (found[i]) result.photos.push_back({names[i], *found[i]});
    if (result.photos.empty()) throw Error("All of the photos' masks are black: none shows a tree.");
    for (const PhotoOverlap& photo : result.photos) {
        const double share = 1.0 / static_cast<double>(result.photos.size());
        result.mean.recall += share * photo.overlap.recall;
        result.mean.precision += share * photo.overlap.precision;
        result.mean.iou += share * photo.overlap.iou;
    }
    return result;
}

}  // namespace

std::vector<OutlinePart> outline_parts(const Tree& tree, const LeafRules& rules, const std::string& textures,
                                       uint64_t seed, const Foliage& foliage, const Progress* progress) {
    return outline_parts(tree, leaf_kinds(tree, rules), textures, seed, foliage, progress);
}

std::vector<OutlinePart> outline_parts(const Tree& tree, const std::vector<LeafKind>& kinds,
                                       const std::string& textures, uint64_t seed, const Foliage& foliage,
                                       const Progress* progress) {
    const LevelBuilder builder(tree, kinds, seed, foliage, progress);
    TreeLevel level = builder.build(0, SIZE_MAX, progress);  // all that it has
    std::vector<OutlinePart> parts;
    parts.push_back({above_ground(level.bark, tree), {}});
    for (size_t kind = 0; kind < level.foliage.size(); kind++) {
        const LevelLeaves& leaves = level.foliage[kind];
        if (leaves.leaves.empty()) continue;
        std::string look = kinds[kind].look.empty() ? textures : kinds[kind].look;
        if (look == "none") look = "generic";  // which has leaf rules, but no look
        const LeafTextures pictures = uses_blade_picture(kinds[kind].rules)
                                          ? make_blade_textures(look, kCutOut, seed)
                                          : make_leaf_textures(look, kCutOut, seed);
        parts.push_back({bake_leaves(leaves.leaves, leaves.card, progress), pictures.albedo});
    }
    return parts;
}

SampleMask drawn_outline(std::span<const OutlinePart> parts, const PinholeView& view,
                         const Progress* progress) {
    SampleMask drawn(view.width, view.height);
    for (const OutlinePart& part : parts)
        draw(part, view, drawn, progress);
    return drawn;
}

OutlineMask outline_mask(const Photo& photo, const Camera& camera, const Image& mask, int longest) {
    // Where it was taken from makes no difference to what the lens does.
    const PinholeView view = fitted(pinhole_view(photo, camera, {}), longest);
    Image all(camera.width, camera.height, 1);
    std::fill(all.pixels.begin(), all.pixels.end(), uint8_t{255});
    return {photo, camera, longest, undistorted(mask, camera, view), undistorted(all, camera, view)};
}

OutlineOverlap measure_overlap(std::span<const OutlinePart> parts, const ScanFrame& frame,
                               std::span<const OutlineMask> masks, const Progress* progress) {
    std::vector<std::optional<Overlap>> found(masks.size());
    parallel_for(masks.size(), 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++)
            found[i] = overlap_in(parts, frame, masks[i], progress);
    });
    std::vector<std::string> names;
    for (const OutlineMask& mask : masks)
        names.push_back(mask.photo.name);
    return mean_of(names, found);
}

OutlineOverlap measure_overlap(std::span<const OutlinePart> parts, const ScanFrame& frame,
                               const PhotoModel& model, const std::vector<Image>& masks, int longest,
                               const Progress* progress) {
    check_masks(model, masks);
    std::vector<std::optional<Overlap>> found(masks.size());
    std::vector<std::string> names;
    for (const Photo& photo : model.photos)
        names.push_back(photo.name);
    parallel_for(masks.size(), 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) {
            const Photo& photo = model.photos[i];
            const Camera& camera = model.cameras[static_cast<size_t>(photo.camera)];
            found[i] = overlap_in(parts, frame, outline_mask(photo, camera, masks[i], longest), progress);
        }
    });
    return mean_of(names, found);
}

}  // namespace treerec
