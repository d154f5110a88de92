// Branches that the skeletonizer missed, found from where a user points:
// TreeReconstruction::complete_branch(), in the editor alone.
#include <cmath>
#include <cstring>
#include <utility>

#include "convert.h"
#include "edit/script.h"
#include "error.h"
#include "skeleton/complete.h"
#include "tree_edit.h"
#include "tree_reconstruction.h"

using namespace godot;

static treerec::CompleteOptions parse_options(const Dictionary& p_options) {
    treerec::CompleteOptions options;
    const std::pair<const char*, double*> members[] = {{"tolerance", &options.tolerance},
                                                       {"voxel", &options.voxel},
                                                       {"reach", &options.reach},
                                                       {"angle", &options.angle}};
    const Array names = p_options.keys();
    for (int64_t i = 0; i < names.size(); i++) {
        double* member = nullptr;
        for (const auto& [name, place] : members) {
            if (String(names[i]) == String(name)) {
                member = place;
            }
        }
        if (member == nullptr) {
            throw treerec::Error("There is no option \"" + to_std(String(names[i])) +
                                 "\"; a completion knows tolerance, voxel, reach and angle.");
        }
        const Variant value = p_options[names[i]];
        if (value.get_type() != Variant::FLOAT && value.get_type() != Variant::INT) {
            throw treerec::Error("The option \"" + to_std(String(names[i])) + "\" must be a number.");
        }
        *member = value;
    }
    return options;
}

Ref<TreeEdit> TreeReconstruction::complete_branch(const PackedVector3Array& p_points, int p_id,
                                                  const Vector3& p_direction, const Dictionary& p_options) {
    return guarded(Ref<TreeEdit>(), [&] {
        const std::shared_ptr<const treerec::Tree> tree = _editable_tree();
        treerec::PointCloud cloud;
        cloud.frame = tree->frame();
        cloud.positions.resize(size_t(p_points.size()));
        static_assert(sizeof(treerec::Vec3) == sizeof(Vector3));
        if (!p_points.is_empty()) {
            std::memcpy(static_cast<void*>(cloud.positions.data()), p_points.ptr(),
                        cloud.positions.size() * sizeof(Vector3));
        }
        treerec::Tree grown = *tree;
        const treerec::Completion completion = treerec::complete_branch(
            grown, cloud, p_id, treerec::DVec3(p_direction.x, p_direction.y, p_direction.z),
            parse_options(p_options));
        treerec::Tree result = *tree;
        treerec::ScriptResult done =
            treerec::run_script(result, treerec::completion_script(grown, completion));
        treerec::EditOutcome outcome;
        outcome.nodes = completion.added;
        outcome.said = "Found " + std::to_string(completion.added.size()) + " nodes in " +
                       std::to_string(completion.points) + " points.";
        Ref<TreeEdit> edit;
        edit.instantiate();
        edit->set_edit(std::move(done.delta), std::move(outcome), done.log.entries());
        _log(edit);
        set_tree(std::move(result));
        return edit;
    });
}
