#include "tree_reconstruction/part_caches.h"

#include <utility>

#include "edit/vary/vary.h"

std::shared_ptr<const treerec::GrownBark> BarkFit::take(
    const std::shared_ptr<const treerec::GrownBark>& p_bark,
    const std::shared_ptr<const treerec::Tree>& p_tree) {
    if (p_bark->empty()) {
        return nullptr;
    }
    {
        const std::lock_guard lock(mutex_);
        if (bark_.lock() == p_bark && tree_.lock() == p_tree) {
            return fits_ ? p_bark : nullptr;
        }
    }
    // Without the lock: two threads that come at once both look, and see the same.
    const bool fits = treerec::fits(*p_bark, *p_tree);
    const std::lock_guard lock(mutex_);
    bark_ = p_bark;
    tree_ = p_tree;
    fits_ = fits;
    return fits ? p_bark : nullptr;
}

int64_t BarkRevision::count(const SharedParts::Parts& p_parts, std::vector<bool> p_followed) {
    const std::lock_guard lock(mutex_);
    if (revision_ == 0 || tree_.lock() != p_parts.tree || foliage_.lock() != p_parts.foliage ||
        bark_.lock() != p_parts.bark || followed_ != p_followed) {
        tree_ = p_parts.tree;
        foliage_ = p_parts.foliage;
        bark_ = p_parts.bark;
        followed_ = std::move(p_followed);
        revision_++;
    }
    return revision_;
}

std::shared_ptr<const treerec::VariantMaker> VariantSource::take(const SharedParts::Parts& p_parts) {
    {
        const std::lock_guard lock(mutex_);
        if (maker_ && tree_.lock() == p_parts.tree && foliage_.lock() == p_parts.foliage) {
            return maker_;
        }
    }
    // Without the lock: two threads that come at once both do it, and get the same.
    const auto maker = std::make_shared<const treerec::VariantMaker>(*p_parts.tree, *p_parts.foliage);
    const std::lock_guard lock(mutex_);
    maker_ = maker;
    tree_ = p_parts.tree;
    foliage_ = p_parts.foliage;
    return maker;
}
