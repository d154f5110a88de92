// What is kept of a TreeReconstruction's parts for as long as they are the same. Any thread may ask.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "tree_reconstruction/shared_parts.h"

namespace treerec {
class VariantMaker;
}  // namespace treerec

// Whether grown bark fits the wood that was asked about last: to tell, the whole tree is looked at.
class BarkFit {
  public:
    // The bark, where there is some and the tree is the one that it was grown on; else null.
    std::shared_ptr<const treerec::GrownBark> take(const std::shared_ptr<const treerec::GrownBark>& p_bark,
                                                   const std::shared_ptr<const treerec::Tree>& p_tree);

  private:
    std::mutex mutex_;
    std::weak_ptr<const treerec::GrownBark> bark_;
    std::weak_ptr<const treerec::Tree> tree_;
    bool fits_ = false;
};

// Counts how often what the bark's mesh is built of has become another.
class BarkRevision {
  public:
    // followed: by kind of leaves, whether it stands where the scan saw leaves.
    int64_t count(const SharedParts::Parts& p_parts, std::vector<bool> p_followed);

  private:
    std::mutex mutex_;
    std::weak_ptr<const treerec::Tree> tree_;
    std::weak_ptr<const treerec::Foliage> foliage_;
    std::weak_ptr<const treerec::GrownBark> bark_;
    std::vector<bool> followed_;
    int64_t revision_ = 0;
};

// What is known of the tree for all its variants.
class VariantSource {
  public:
    std::shared_ptr<const treerec::VariantMaker> take(const SharedParts::Parts& p_parts);

  private:
    std::mutex mutex_;
    std::shared_ptr<const treerec::VariantMaker> maker_;
    std::weak_ptr<const treerec::Tree> tree_;
    std::weak_ptr<const treerec::Foliage> foliage_;
};
