// What the builders of a TreeReconstruction read, on any thread.
#pragma once

#include <memory>
#include <mutex>
#include <utility>

#include "foliage/foliage.h"
#include "mesh/grown_bark.h"
#include "tree/tree.h"

// The parts are never changed, only replaced: whoever has taken them sees them as they were then, and two
// trees may hold the same ones. None is null.
class SharedParts {
  public:
    struct Parts {
        std::shared_ptr<const treerec::Tree> tree = std::make_shared<treerec::Tree>();
        std::shared_ptr<const treerec::Foliage> foliage = std::make_shared<treerec::Foliage>();
        std::shared_ptr<const treerec::GrownBark> bark = std::make_shared<treerec::GrownBark>();
    };

    Parts get() const {
        const std::lock_guard lock(mutex_);
        return parts_;
    }
    // change(parts) replaces some of them at once.
    template <typename Change>
    void replace(const Change& p_change) {
        const std::lock_guard lock(mutex_);
        p_change(parts_);
    }

  private:
    mutable std::mutex mutex_;
    Parts parts_;
};
