#include "pipeline/show_fidelity.h"

#include "error.h"
#include "fidelity/fidelity.h"
#include "pipeline/sheets.h"

namespace treerec {

ShownFidelity show_fidelity(const Reconstruction& result, const ShowOptions& options, Progress* progress) {
    SubProgress own(progress, 0.0, 1.0), judging(progress, 0.1, 0.6);
    own.update(0.0, "Comparing");
    const std::vector<OutlinePart> parts =
        outline_parts(result.tree, options.leaves, options.textures, options.seed, result.foliage, &own);
    ShownFidelity shown;
    std::optional<PhotoJudge> judge;
    SheetPhotos photos;
    if (options.photos) {
        photos = {read_photo_model(options.photos->model), options.photos->photos};
        try {
            judge = photo_judge(*options.photos, options.hold_out, result.cloud, &judging);
            shown.outline = {options.hold_out, judge->source(), judge->cloud(),
                             judge->judge(parts, result.tree.frame(), &own)};
        } catch (const Cancelled&) {
            throw;
        } catch (const Error& error) {
            judge.reset();
            shown.lacks = error.what();
        }
    }
    own.update(0.6, "Drawing");
    SheetSubject subject{options.name, result.tree, parts,
                         result.cloud, &result.raw, options.photos ? &photos : nullptr};
    if (options.stages) shown.stages = stages_sheet(subject, &own);
    own.update(0.8, "Drawing");
    const PointCloud wood = wood_of(result);
    const Fidelity fidelity = measure_fidelity(result.tree, wood, {}, &own);
    shown.skeleton = fidelity.skeleton;
    if (options.fidelity)
        shown.fidelity = fidelity_sheet(
            subject,
            {fidelity, wood, judge ? &*judge : nullptr, shown.outline ? &shown.outline->shapes : nullptr},
            &own);
    own.update(1.0, "Drawing");
    return shown;
}

Image show_tree(const Reconstruction& result, const ShowOptions& options, Progress* progress) {
    return tree_picture(
        result.tree,
        outline_parts(result.tree, options.leaves, options.textures, options.seed, result.foliage, progress),
        progress);
}

}  // namespace treerec
