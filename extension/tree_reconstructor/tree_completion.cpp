// Branches that the skeletonizer missed, found from where a user points:
// TreeReconstruction::complete_branch() and its preview, in the editor alone.
#include <cmath>
#include <cstring>
#include <utility>

#include "completion/complete.h"
#include "convert.h"
#include "edit/commands/script.h"
#include "error.h"
#include "tree_edit.h"
#include "tree_reconstruction/tree_reconstruction.h"

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

namespace {

// A branch that was found: the commands that grow it, and the tree that has it.
struct Found {
    treerec::Tree grown;
    treerec::Completion completion;

    std::string script() const { return treerec::completion_script(grown, completion); }
    std::string message() const {
        return "Found " + std::to_string(completion.added.size()) + " nodes in " +
               std::to_string(completion.points) + " points.";
    }
};

Found find_branch(const treerec::Tree& p_tree, const PackedVector3Array& p_points, int64_t p_id,
                  const Vector3& p_direction, const Dictionary& p_options) {
    treerec::PointCloud cloud;
    cloud.frame = p_tree.frame();
    cloud.positions.resize(size_t(p_points.size()));
    static_assert(sizeof(treerec::Vec3) == sizeof(Vector3));
    if (!p_points.is_empty()) {
        std::memcpy(static_cast<void*>(cloud.positions.data()), p_points.ptr(),
                    cloud.positions.size() * sizeof(Vector3));
    }
    Found found{p_tree, {}};
    const treerec::DVec3 direction(p_direction.x, p_direction.y, p_direction.z);
    found.completion = treerec::complete_branch(found.grown, cloud, node_of(p_tree, p_id), direction,
                                                parse_options(p_options));
    return found;
}

}  // namespace

Dictionary TreeReconstruction::preview_completion(const PackedVector3Array& p_points, int64_t p_id,
                                                  const Vector3& p_direction,
                                                  const Dictionary& p_options) const {
    std::string script, message, refusal;
    PackedVector3Array added;
    try {
        const Found found = find_branch(*_editable_tree(), p_points, p_id, p_direction, p_options);
        script = found.script();
        message = found.message();
        for (const treerec::NodeId id : found.completion.added) {
            const treerec::Node& node = found.grown.node(id);
            for (const treerec::DVec3& place : {found.grown.node(node.parent).position, node.position}) {
                added.push_back(Vector3(real_t(place.x), real_t(place.y), real_t(place.z)));
            }
        }
    } catch (const std::exception& error) {
        refusal = error.what();
    }
    Dictionary result;
    result["script"] = to_godot(script);
    result["added"] = added;
    result["message"] = to_godot(message);
    result["error"] = to_godot(refusal);
    return result;
}

Ref<TreeEdit> TreeReconstruction::complete_branch(const PackedVector3Array& p_points, int64_t p_id,
                                                  const Vector3& p_direction, const Dictionary& p_options) {
    return guarded(Ref<TreeEdit>(), [&] {
        const std::shared_ptr<const treerec::Tree> tree = _editable_tree();
        const Found found = find_branch(*tree, p_points, p_id, p_direction, p_options);
        treerec::Tree result = *tree;
        treerec::ScriptResult done = treerec::run_script(result, found.script());
        treerec::EditOutcome outcome;
        outcome.nodes = found.completion.added;
        outcome.said = found.message();
        Ref<TreeEdit> edit;
        edit.instantiate();
        edit->set_edit(std::move(done.delta), std::move(outcome), done.log.entries());
        edit->set_leaf_setting(get_leaf_setting());
        edit_history_.add(edit->get_log_entries());
        set_tree(std::move(result));
        return edit;
    });
}
