// Bark that TreeReconstructor grows on trees (src/growth).
#include <exception>
#include <memory>
#include <string>

#include "convert.h"
#include "error.h"
#include "growth/grow_bark.h"
#include "growth/lumps.h"
#include "pipeline/report.h"
#include "scan_points.h"
#include "tree_reconstructor.h"
#include "tree_reconstructor_job.h"

using namespace godot;

Ref<TreeReconstruction> TreeReconstructor::grow_bark(const Ref<TreeReconstruction>& p_tree,
                                                     const String& p_recipe) {
    ERR_FAIL_COND_V_MSG(p_tree.is_null(), Ref<TreeReconstruction>(),
                        "There is no tree that bark could grow on.");
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), Ref<TreeReconstruction>(), BUSY);
    try {
        Listener listener(this);
        listener.check();
        // The tree may change meanwhile: what grew is for the wood as it is now.
        Ref<TreeReconstruction> made;
        made.instantiate();
        made->take_tree_of(p_tree);
        made->set_leaf_setting(p_tree->get_leaf_setting());
        const std::shared_ptr<const treerec::Tree> tree = made->get_tree();
        const treerec::GrowthRecipe recipe = treerec::read_growth_recipe(*tree, to_std(p_recipe));
        const treerec::GrownTree grown = treerec::grow_bark(*tree, recipe, {}, &listener);
        listener.check();
        made->set_bark(grown.bark, to_godot(recipe.text));
        const std::lock_guard lock(mutex_);
        report_json_ = treerec::growth_report_json(grown);
        fraction_ = 1.0;
        return made;
    } catch (const std::exception& error) {
        _fail(error.what());
        return Ref<TreeReconstruction>();
    }
}

String TreeReconstructor::propose_growth(const Ref<TreeReconstruction>& p_tree,
                                         const PackedVector3Array& p_points, const String& p_recipe) {
    ERR_FAIL_COND_V_MSG(p_tree.is_null(), String(), "There is no tree whose scan could show lumps.");
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), String(), BUSY);
    try {
        Listener listener(this);
        listener.check();
        const std::shared_ptr<const treerec::Tree> tree = p_tree->get_tree();
        const treerec::GrowthRecipe recipe = treerec::read_growth_recipe(*tree, to_std(p_recipe));
        const treerec::GrowthProposal proposal =
            treerec::propose_growth(*tree, to_cloud(tree->frame(), p_points), recipe, &listener);
        listener.check();
        const std::lock_guard lock(mutex_);
        report_json_ = treerec::growth_proposal_json(proposal);
        fraction_ = 1.0;
        return to_godot(proposal.recipe);
    } catch (const std::exception& error) {
        _fail(error.what());
        return String();
    }
}

TypedArray<Dictionary> TreeReconstructor::get_growth_commands() {
    TypedArray<Dictionary> list;
    for (const treerec::GrowthCommand& command : treerec::growth_commands()) {
        Dictionary entry;
        entry["name"] = to_godot(command.name);
        entry["description"] = to_godot(command.summary);
        entry["parameters"] = to_godot(command.parameters);
        list.push_back(entry);
    }
    return list;
}
