// New individuals of a TreeReconstruction's kind: see src/edit/vary/vary.h.
#include <algorithm>
#include <utility>

#include "convert.h"
#include "edit/vary/vary.h"
#include "error.h"
#include "geometry/random.h"
#include "tree_reconstruction/tree_reconstruction.h"

using namespace godot;

// What passes a limit by a rounding, as 1.2000000000000002 does, is the limit. What is no number stays one.
static double within(double p_value, double p_least, double p_most) {
    constexpr double kRounding = 1e-6;
    if (p_value < p_least && p_value > p_least - kRounding) {
        return p_least;
    }
    return p_value > p_most && p_value < p_most + kRounding ? p_most : p_value;
}

Ref<TreeReconstruction> TreeReconstruction::make_variant(int64_t p_seed, double p_amount,
                                                         double p_age) const {
    constexpr double kLeafSize = 0.08;
    return guarded(Ref<TreeReconstruction>(), [&] {
        if (!newer_skeleton_.is_empty()) {
            throw treerec::Error(
                "This tree was saved by a newer version of the addon, so it can't be varied here. Update the "
                "addon.");
        }
        const double amount = within(p_amount, 0.0, 1.0);
        const double age = within(p_age, treerec::VariantMaker::kLeastAge, treerec::VariantMaker::kMostAge);
        treerec::TreeVariant variant =
            variant_source_.take(parts_.get())->make(uint64_t(p_seed), amount, age);
        Ref<TreeReconstruction> made;
        made.instantiate();
        LeafSetting leaves = get_leaf_setting();
        if (amount > 0.0) {
            treerec::Random random(uint64_t(p_seed), 11);
            leaves.rules.leaf_size *= 1.0 + kLeafSize * amount * random.uniform(-1.0, 1.0);
            // A number that the inspector and a file hold whole.
            leaves.seed = int64_t(treerec::hash_seed(uint64_t(leaves.seed), uint64_t(p_seed)) >> 33);
        }
        made->set_leaf_setting(leaves);
        made->parts_.replace([&](SharedParts::Parts& r_parts) {
            r_parts.tree = std::make_shared<const treerec::Tree>(std::move(variant.tree));
            r_parts.foliage = std::make_shared<const treerec::Foliage>(std::move(variant.foliage));
        });
        Dictionary how;
        how["seed"] = p_seed;
        how["amount"] = amount;
        if (age != 1.0) {
            how["age"] = age;
        }
        made->provenance_["variant"] = how;
        return made;
    });
}

void TreeReconstruction::_bind_variants() {
    ClassDB::bind_method(D_METHOD("make_variant", "seed", "amount", "age"), &TreeReconstruction::make_variant,
                         DEFVAL(0.5), DEFVAL(1.0));
}
